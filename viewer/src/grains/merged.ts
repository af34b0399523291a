// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Frame } from "../data/frame.ts";
import { type SurfaceOf, turned } from "./pick.ts";

/** Surfaces of many grains as one, where the grains are. */
export interface Merged {
  position: Float32Array;
  normal: Float32Array;
  colour: Float32Array;
  index: Uint32Array;
}

/**
 * All grains of a frame as a single surface. Software that draws in place of a graphics card is slow
 * for many small things and quick for one large thing. `colours` has three numbers per row.
 */
export function merged(frame: Frame, surfaceOf: SurfaceOf, colours: Float32Array): Merged {
  let vertices = 0;
  let corners = 0;
  for (let row = 0; row < frame.grains; ++row) {
    const { surface } = surfaceOf(row);
    vertices += surface.position.length / 3;
    corners += surface.index.length;
  }
  const result: Merged = {
    position: new Float32Array(3 * vertices),
    normal: new Float32Array(3 * vertices),
    colour: new Float32Array(3 * vertices),
    index: new Uint32Array(corners),
  };
  let vertex = 0;
  let corner = 0;
  for (let row = 0; row < frame.grains; ++row) {
    const { surface, scale } = surfaceOf(row);
    const first = vertex;
    for (let n = 0; n < surface.position.length; n += 3, ++vertex) {
      const { position, normal } = surface;
      const place = turned([position[n], position[n + 1], position[n + 2]], frame.orientation, 4 * row);
      const outward = turned([normal[n], normal[n + 1], normal[n + 2]], frame.orientation, 4 * row);
      for (let axis = 0; axis < 3; ++axis) {
        result.position[3 * vertex + axis] = frame.position[3 * row + axis] + scale * place[axis];
        result.normal[3 * vertex + axis] = outward[axis];
        result.colour[3 * vertex + axis] = colours[3 * row + axis];
      }
    }
    for (const n of surface.index) result.index[corner++] = first + n;
  }
  return result;
}
