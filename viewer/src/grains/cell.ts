// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { BufferAttribute, BufferGeometry, LineDashedMaterial, LineSegments } from "three";
import type { Frame } from "../data/frame.ts";

/**
 * The twelve edges of the periodic cell, as pairs of points behind each other; nothing without a
 * cell. A corner's bits say along which edges it is ahead (output/fields.hpp), so an edge leads from a
 * corner to the one with a bit more.
 */
export function cellLines(frame: Frame): number[] {
  const lines: number[] = [];
  if (frame.cellCorners.length === 0) return lines;
  const corner = (n: number) => frame.cellCorners.subarray(3 * n, 3 * n + 3);
  for (let n = 0; n < 8; ++n) {
    for (const bit of [1, 2, 4]) {
      if ((n & bit) === 0) lines.push(...corner(n), ...corner(n + bit));
    }
  }
  return lines;
}

/** The periodic cell of a frame. Dashed, because it is not a wall. */
export class CellView {
  readonly lines = new LineSegments(new BufferGeometry(), new LineDashedMaterial({ color: 0x1f5f8b }));

  constructor() {
    this.lines.frustumCulled = false;
  }

  setFrame(frame: Frame): void {
    const places = Float32Array.from(cellLines(frame));
    this.lines.visible = places.length > 0;
    if (!this.lines.visible) return;
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute("position", new BufferAttribute(places, 3));
    this.lines.computeLineDistances();
    const edge = Math.hypot(...[0, 1, 2].map((axis) => places[3 + axis] - places[axis]));
    this.lines.material.dashSize = edge / 40;
    this.lines.material.gapSize = edge / 80;
  }
}
