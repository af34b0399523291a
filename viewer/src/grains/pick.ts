// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Frame } from "../data/frame.ts";
import type { Surface } from "./surfaces.ts";

export type Triple = readonly [number, number, number];

export interface Ray {
  origin: Triple;
  direction: Triple; // of length one
}

/** The surface of a grain and the factor by which it is enlarged. */
export type SurfaceOf = (row: number) => { surface: Surface; scale: number };

/** `v` turned by the quaternion (w, x, y, z), or back. */
export function turned(v: Triple, q: ArrayLike<number>, at: number, back = false): [number, number, number] {
  const sign = back ? -1 : 1;
  const [w, x, y, z] = [q[at], sign * q[at + 1], sign * q[at + 2], sign * q[at + 3]];
  // v + 2 w (u x v) + 2 u x (u x v)
  const cx = y * v[2] - z * v[1];
  const cy = z * v[0] - x * v[2];
  const cz = x * v[1] - y * v[0];
  return [
    v[0] + 2 * (w * cx + y * cz - z * cy),
    v[1] + 2 * (w * cy + z * cx - x * cz),
    v[2] + 2 * (w * cz + x * cy - y * cx),
  ];
}

/**
 * Where a ray first meets a triangle of the surface at a distance that `keep` takes (Möller and
 * Trumbore 1997); infinity where nowhere.
 */
export function firstHit(surface: Surface, ray: Ray, keep: (distance: number) => boolean): number {
  const { position, index } = surface;
  const [ox, oy, oz] = ray.origin;
  const [dx, dy, dz] = ray.direction;
  let best = Number.POSITIVE_INFINITY;
  for (let t = 0; t < index.length; t += 3) {
    const a = 3 * index[t];
    const b = 3 * index[t + 1];
    const c = 3 * index[t + 2];
    const e1x = position[b] - position[a];
    const e1y = position[b + 1] - position[a + 1];
    const e1z = position[b + 2] - position[a + 2];
    const e2x = position[c] - position[a];
    const e2y = position[c + 1] - position[a + 1];
    const e2z = position[c + 2] - position[a + 2];
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const determinant = e1x * px + e1y * py + e1z * pz;
    if (determinant === 0) continue;
    const sx = ox - position[a];
    const sy = oy - position[a + 1];
    const sz = oz - position[a + 2];
    const u = (sx * px + sy * py + sz * pz) / determinant;
    if (u < 0 || u > 1) continue;
    const qx = sy * e1z - sz * e1y;
    const qy = sz * e1x - sx * e1z;
    const qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / determinant;
    if (v < 0 || u + v > 1) continue;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / determinant;
    if (distance > 0 && distance < best && keep(distance)) best = distance;
  }
  return best;
}

/**
 * The row of the grain that a ray meets first, or -1. Points that `visible` refuses (cut away by the
 * slicing plane) do not count.
 */
export function pickGrain(
  frame: Frame,
  surfaceOf: SurfaceOf,
  ray: Ray,
  visible: (point: Triple) => boolean,
): number {
  let best = -1;
  let distance = Number.POSITIVE_INFINITY;
  for (let row = 0; row < frame.grains; ++row) {
    const from: Triple = [
      ray.origin[0] - frame.position[3 * row],
      ray.origin[1] - frame.position[3 * row + 1],
      ray.origin[2] - frame.position[3 * row + 2],
    ];
    const along = -(from[0] * ray.direction[0] + from[1] * ray.direction[1] + from[2] * ray.direction[2]);
    const square = from[0] ** 2 + from[1] ** 2 + from[2] ** 2 - along ** 2;
    const radius = frame.radius[row];
    if (square > radius ** 2 || along - radius > distance) continue;
    const { surface, scale } = surfaceOf(row);
    const body: Ray = {
      origin: turned(from, frame.orientation, 4 * row, true).map((x) => x / scale) as [number, number, number],
      direction: turned(ray.direction, frame.orientation, 4 * row, true),
    };
    const hit =
      scale *
      firstHit(surface, body, (reached) => {
        const far = reached * scale;
        return visible([
          ray.origin[0] + far * ray.direction[0],
          ray.origin[1] + far * ray.direction[1],
          ray.origin[2] + far * ray.direction[2],
        ]);
      });
    if (hit < distance) {
      distance = hit;
      best = row;
    }
  }
  return best;
}
