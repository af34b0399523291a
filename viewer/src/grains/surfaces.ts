// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Piece } from "../data/piece.ts";
import type { HeadText } from "../data/run.ts";

/** A closed surface in the body frame of a shape [m]. */
export interface Surface {
  position: Float32Array;
  normal: Float32Array;
  index: Uint16Array;
}

export interface ShapeSurfaces {
  fine: Surface;
  coarse: Surface;
}

/** Takes the surfaces of all shapes apart; shapes that no grain has get null. */
export function unpackSurfaces(head: Piece<HeadText>): (ShapeSurfaces | null)[] {
  const reader = (level: "fine" | "coarse") => {
    const position = head.array(`${level}_position`) as Int16Array;
    const normal = head.array(`${level}_normal`) as Int8Array;
    const index = head.array(`${level}_index`) as Uint16Array;
    let vertex = 0;
    let triangle = 0;
    return (vertices: number, triangles: number, extent: number): Surface => {
      const from = 3 * vertex;
      vertex += vertices;
      const first = 3 * triangle;
      triangle += triangles;
      return {
        position: Float32Array.from(
          position.subarray(from, from + 3 * vertices),
          (value) => (value / 32767) * extent,
        ),
        normal: Float32Array.from(normal.subarray(from, from + 3 * vertices), (value) => value / 127),
        index: index.slice(first, first + 3 * triangles),
      };
    };
  };
  const fine = reader("fine");
  const coarse = reader("coarse");
  return head.text.shapes.map((shape) =>
    shape.extent > 0
      ? {
          fine: fine(shape.vertices, shape.triangles, shape.extent),
          coarse: coarse(shape.coarse_vertices, shape.coarse_triangles, shape.extent),
        }
      : null,
  );
}

/** A ball of radius one, for grains whose shapes are not known: an octahedron, cut finer and finer. */
export function ball(rounds: number): Surface {
  let vertices = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
  ];
  let triangles = [
    [0, 2, 4],
    [2, 1, 4],
    [1, 3, 4],
    [3, 0, 4],
    [2, 0, 5],
    [1, 2, 5],
    [3, 1, 5],
    [0, 3, 5],
  ];
  for (let round = 0; round < rounds; ++round) {
    const middles = new Map<string, number>();
    const next = [...vertices];
    const middle = (a: number, b: number): number => {
      const key = a < b ? `${a},${b}` : `${b},${a}`;
      const known = middles.get(key);
      if (known !== undefined) return known;
      const sum = [0, 1, 2].map((axis) => vertices[a][axis] + vertices[b][axis]);
      const size = Math.hypot(...sum);
      next.push(sum.map((value) => value / size));
      middles.set(key, next.length - 1);
      return next.length - 1;
    };
    triangles = triangles.flatMap(([a, b, c]) => {
      const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
      return [
        [a, ab, ca],
        [ab, b, bc],
        [ca, bc, c],
        [ab, bc, ca],
      ];
    });
    vertices = next;
  }
  const position = Float32Array.from(vertices.flat());
  return { position, normal: position, index: Uint16Array.from(triangles.flat()) };
}
