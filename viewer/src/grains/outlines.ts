// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Frame } from "../data/frame.ts";
import type { Vector, Wall } from "../data/run.ts";

type Point = [number, number, number];

export interface Bounds {
  low: Point;
  high: Point;
}

/** The box around all grains' bounding spheres. */
export function boundsOf(frame: Frame): Bounds {
  const low: Point = [Infinity, Infinity, Infinity];
  const high: Point = [-Infinity, -Infinity, -Infinity];
  for (let row = 0; row < frame.grains; ++row) {
    for (let axis = 0; axis < 3; ++axis) {
      const at = frame.position[3 * row + axis];
      low[axis] = Math.min(low[axis], at - frame.radius[row]);
      high[axis] = Math.max(high[axis], at + frame.radius[row]);
    }
  }
  return frame.grains > 0 ? { low, high } : { low: [0, 0, 0], high: [1, 1, 1] };
}

const dot = (a: Point | Vector, b: Point | Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Point, b: Point): Point => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const moved = (a: Point | Vector, b: Point | Vector, factor: number): Point => [
  a[0] + factor * b[0],
  a[1] + factor * b[1],
  a[2] + factor * b[2],
];
function unit(a: Point): Point {
  const length = Math.hypot(...a);
  return [a[0] / length, a[1] / length, a[2] / length];
}
/** Two directions at right angles to `axis` and each other. */
function across(axis: Point): [Point, Point] {
  const other: Point = Math.abs(axis[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0];
  const first = unit(cross(axis, other));
  return [first, cross(axis, first)];
}

/** The part of a convex polygon on the side of a plane that its normal points to (Sutherland and Hodgman 1974). */
export function clipped(polygon: Point[], point: Point | Vector, normal: Point | Vector): Point[] {
  const height = polygon.map((corner) => dot(moved(corner, point, -1), normal));
  const result: Point[] = [];
  for (let n = 0; n < polygon.length; ++n) {
    const next = (n + 1) % polygon.length;
    if (height[n] >= 0) result.push(polygon[n]);
    if (height[n] >= 0 !== height[next] >= 0) {
      const share = height[n] / (height[n] - height[next]);
      result.push(moved(polygon[n], moved(polygon[next], polygon[n], -1), share));
    }
  }
  return result;
}

/**
 * Lines (pairs of points) that show where walls stand: planes as far as other planes and the grains
 * reach, cylinders as rings and staves.
 */
export function wallLines(walls: readonly Wall[], frame: Frame): Point[] {
  const bounds = boundsOf(frame);
  const size = Math.hypot(...moved(bounds.high, bounds.low, -1));
  const shift = (n: number): Point =>
    frame.wallDisplacement.length >= 3 * (n + 1)
      ? [
          frame.wallDisplacement[3 * n],
          frame.wallDisplacement[3 * n + 1],
          frame.wallDisplacement[3 * n + 2],
        ]
      : [0, 0, 0];
  const standing = walls.map((wall, n) => ({ ...wall, point: moved(wall.point, shift(n), 1) }));
  // Walls are cut a little outside the box of the grains; a wall behind this box keeps its place.
  const limits: { point: Point; normal: Point }[] = [];
  for (let axis = 0; axis < 3; ++axis) {
    const normal: Point = [0, 0, 0];
    normal[axis] = 1;
    limits.push({ point: moved(bounds.low, normal, -0.06 * size), normal });
    limits.push({ point: moved(bounds.high, normal, 0.06 * size), normal: moved([0, 0, 0], normal, -1) });
  }
  const lines: Point[] = [];
  for (const wall of standing) {
    if (wall.mould && frame.membraneCorners.length > 0) continue; // the membrane is in its place
    if (wall.normal) {
      const normal: Point = [...wall.normal];
      const [u, v] = across(normal);
      const center = moved(bounds.low, moved(bounds.high, bounds.low, -1), 0.5);
      const foot = moved(center, normal, -dot(moved(center, wall.point, -1), normal));
      let polygon = [
        moved(moved(foot, u, -2 * size), v, -2 * size),
        moved(moved(foot, u, 2 * size), v, -2 * size),
        moved(moved(foot, u, 2 * size), v, 2 * size),
        moved(moved(foot, u, -2 * size), v, 2 * size),
      ];
      for (const other of standing) {
        if (other !== wall && other.normal && Math.abs(dot(other.normal, normal)) < 0.999) {
          polygon = clipped(polygon, other.point, other.normal);
        }
      }
      for (const limit of limits) {
        // A limit parallel to the wall would take the whole of it away.
        if (Math.abs(dot(limit.normal, normal)) < 0.999) {
          polygon = clipped(polygon, limit.point, limit.normal);
        }
      }
      polygon.forEach((corner, n) => lines.push(corner, polygon[(n + 1) % polygon.length]));
    } else if (wall.axis && wall.radius) {
      const axis: Point = [...wall.axis];
      const [u, v] = across(axis);
      const heights = [bounds.low, bounds.high].flatMap((corner) =>
        [0, 1, 2].map((k) => {
          const mixed: Point = [...bounds.low];
          mixed[k] = corner[k];
          return dot(moved(mixed, wall.point, -1), axis);
        }),
      );
      const radius = wall.radius;
      const at = (angle: number, height: number): Point =>
        moved(
          moved(moved(wall.point, axis, height), u, radius * Math.cos(angle)),
          v,
          radius * Math.sin(angle),
        );
      const [low, high] = [Math.min(...heights), Math.max(...heights)];
      const parts = 72;
      for (let n = 0; n < parts; ++n) {
        const [a, b] = [(2 * Math.PI * n) / parts, (2 * Math.PI * (n + 1)) / parts];
        lines.push(at(a, low), at(b, low), at(a, high), at(b, high));
        if (n % 9 === 0) lines.push(at(a, low), at(a, high));
      }
    }
  }
  return lines;
}
