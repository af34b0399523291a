// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { boundsOf, clipped, wallLines } from "../src/grains/outlines.ts";
import { cellLines } from "../src/grains/cell.ts";
import { merged } from "../src/grains/merged.ts";
import { Detail, Pace } from "../src/grains/pace.ts";
import { firstHit, pickGrain, turned } from "../src/grains/pick.ts";
import { colourRange, displacement, quantitiesOf, rotation } from "../src/grains/quantities.ts";
import { ball, type Surface } from "../src/grains/surfaces.ts";
import type { Wall } from "../src/data/run.ts";
import { frameOf, near } from "./frames.ts";

const quarterAboutZ: [number, number, number, number] = [Math.SQRT1_2, 0, 0, Math.SQRT1_2];
const everywhere = () => true;

function volumeOf(surface: Surface): number {
  let six = 0;
  const { position, index } = surface;
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => position.subarray(3 * index[t + k], 3 * index[t + k] + 3));
    six +=
      a[0] * (b[1] * c[2] - b[2] * c[1]) -
      a[1] * (b[0] * c[2] - b[2] * c[0]) +
      a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

test("a ball is closed, faces outward and comes close to a sphere", () => {
  const { position, index } = ball(4);
  const edges = new Map<string, number>();
  for (let t = 0; t < index.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const edge = `${index[t + k]},${index[t + ((k + 1) % 3)]}`;
      edges.set(edge, (edges.get(edge) ?? 0) + 1);
    }
  }
  for (const [edge, count] of edges) {
    assert.equal(count, 1);
    assert.ok(edges.has(edge.split(",").reverse().join()));
  }
  for (let n = 0; n < position.length; n += 3) {
    near(Math.hypot(position[n], position[n + 1], position[n + 2]), 1);
  }
  near(volumeOf(ball(4)), (4 / 3) * Math.PI, 0.02);
  assert.ok(volumeOf(ball(4)) < (4 / 3) * Math.PI);
});

test("vectors are turned by a quaternion and back", () => {
  const there = turned([1, 2, 3], quarterAboutZ, 0);
  [-2, 1, 3].forEach((value, k) => near(there[k], value));
  const back = turned(there, quarterAboutZ, 0, true);
  [1, 2, 3].forEach((value, k) => near(back[k], value));
});

test("a ray meets a ball where a sphere would be met", () => {
  const ray = { origin: [-5, 0.3, 0.2] as const, direction: [1, 0, 0] as const };
  near(firstHit(ball(5), ray, everywhere), 5 - Math.sqrt(1 - 0.09 - 0.04), 2e-3);
  const past = { origin: [-5, 1.01, 0] as const, direction: [1, 0, 0] as const };
  assert.equal(firstHit(ball(5), past, everywhere), Number.POSITIVE_INFINITY);
});

test("the nearer of two grains is picked, or the one that is not cut away", () => {
  const frame = frameOf([
    { id: 10, position: [4, 0, 0] },
    { id: 20, position: [0, 0, 0] },
    { id: 30, position: [0, 9, 0] },
  ]);
  const surfaceOf = () => ({ surface: ball(3), scale: 1 });
  const ray = { origin: [-9, 0.2, 0.1] as const, direction: [1, 0, 0] as const };
  assert.equal(pickGrain(frame, surfaceOf, ray, everywhere), 1);
  assert.equal(pickGrain(frame, surfaceOf, ray, ([x]) => x > 2), 0);
  const miss = { origin: [-9, 4.5, 0] as const, direction: [1, 0, 0] as const };
  assert.equal(pickGrain(frame, surfaceOf, miss, everywhere), -1);
});

test("a long grain is picked where it lies when it is turned", () => {
  const long = ball(3);
  const position = long.position.map((value, n) => (n % 3 === 0 ? 4 * value : 0.5 * value));
  const surfaceOf = () => ({ surface: { ...long, position }, scale: 1 });
  const ray = { origin: [0, 3, -9] as const, direction: [0, 0, 1] as const };
  const lying = frameOf([{ id: 1, position: [0, 0, 0], radius: 4 }]);
  const turnedGrain = frameOf([{ id: 1, position: [0, 0, 0], radius: 4, orientation: quarterAboutZ }]);
  assert.equal(pickGrain(lying, surfaceOf, ray, everywhere), -1);
  assert.equal(pickGrain(turnedGrain, surfaceOf, ray, everywhere), 0);
});

test("displacement and rotation count from the frame given, by the grain's number", () => {
  const angle = 0.7;
  const start = frameOf([
    { id: 3, position: [1, 1, 1] },
    { id: 5, position: [0, 0, 0], orientation: [0, 1, 0, 0] },
  ]);
  const now = frameOf([
    { id: 5, position: [3, 4, 0], orientation: [0, Math.cos(angle / 2), Math.sin(angle / 2), 0] },
    { id: 7, position: [0, 0, 0] },
  ]);
  near(displacement(now, start, 0), 5);
  near(rotation(now, start, 0), (angle * 180) / Math.PI, 1e-5);
  assert.ok(Number.isNaN(displacement(now, start, 1)));
});

test("opposite quaternions are the same orientation", () => {
  const start = frameOf([{ id: 0, position: [0, 0, 0], orientation: [0.6, 0.8, 0, 0] }]);
  const now = frameOf([{ id: 0, position: [0, 0, 0], orientation: [-0.6, -0.8, 0, 0] }]);
  near(rotation(now, start, 0), 0, 1e-4);
});

test("a single outlier does not set the range of colours", () => {
  const values = Float32Array.from({ length: 1000 }, (_, n) => n);
  values[999] = 1e9;
  const [low, high] = colourRange(values);
  assert.ok(low >= 0 && low < 30 && high > 970 && high < 1000);
  assert.deepEqual(colourRange(new Float32Array(3).fill(2)), [2, 4]);
  assert.deepEqual(colourRange(Float32Array.of(Number.NaN)), [0, 1]);
});

test("six planes show as the twelve edges of their box, where they have moved to", () => {
  const frame = frameOf(
    [{ id: 0, position: [1, 1, 1], radius: 1 }],
    [],
    [],
    [0.25, 0, 0, ...new Array(15).fill(0)],
  );
  const walls = (["x", "y", "z"] as const).flatMap((_, axis) =>
    [0, 1].map((side) => {
      const point: [number, number, number] = [1, 1, 1];
      const normal: [number, number, number] = [0, 0, 0];
      point[axis] = 2 * side;
      normal[axis] = side === 0 ? 1 : -1;
      return { name: "box", point, normal };
    }),
  );
  const lines = wallLines(walls, frame);
  assert.equal(lines.length, 6 * 4 * 2);
  for (const corner of lines) {
    near(Math.min(Math.abs(corner[0] - 0.25), Math.abs(corner[0] - 2)), 0);
    for (const axis of [1, 2]) near(Math.min(Math.abs(corner[axis]), Math.abs(corner[axis] - 2)), 0);
  }
});

test("a polygon is cut where it crosses a plane", () => {
  const square: [number, number, number][] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
  ];
  const half = clipped(square, [0.5, 0, 0], [1, 0, 0]);
  assert.equal(half.length, 4);
  for (const corner of half) assert.ok(corner[0] >= 0.5);
  assert.equal(clipped(square, [2, 0, 0], [1, 0, 0]).length, 0);
});

test("bounds hold the grains' bounding spheres", () => {
  const { low, high } = boundsOf(frameOf([{ id: 0, position: [1, 2, 3], radius: 0.5 }]));
  assert.deepEqual([low, high], [[0.5, 1.5, 2.5], [1.5, 2.5, 3.5]]);
});

test("grains merged into one surface stand where they are, in their colours", () => {
  const frame = frameOf([
    { id: 0, position: [5, 0, 0] },
    { id: 1, position: [0, 5, 0], orientation: quarterAboutZ },
  ]);
  const small = ball(1);
  const scales = [1, 2];
  const all = merged(frame, (row) => ({ surface: small, scale: scales[row] }), Float32Array.of(1, 0, 0, 0, 0, 1));
  const vertices = small.position.length / 3;
  assert.equal(all.position.length, 2 * small.position.length);
  for (let n = 0; n < 2 * vertices; ++n) {
    const row = n < vertices ? 0 : 1;
    const offset = [0, 1, 2].map((k) => all.position[3 * n + k] - frame.position[3 * row + k]);
    near(Math.hypot(...offset), scales[row], 1e-5);
    for (const k of [0, 1, 2]) near(all.normal[3 * n + k], offset[k] / scales[row], 1e-5);
    assert.deepEqual([...all.colour.subarray(3 * n, 3 * n + 3)], row === 0 ? [1, 0, 0] : [0, 0, 1]);
  }
  assert.equal(all.index[small.index.length], vertices + small.index[0]);
});

test("slow machines draw less and less of each grain while the view moves, until it keeps pace", () => {
  const pace = new Pace();
  pace.learn(Detail.fine, 20);
  assert.equal(pace.moving, Detail.fine);
  pace.learn(Detail.fine, 900);
  assert.equal(pace.moving, Detail.coarse);
  pace.learn(Detail.coarse, 30); // quick enough
  assert.equal(pace.moving, Detail.coarse);
  pace.learn(Detail.coarse, 80);
  assert.equal(pace.moving, Detail.balls);
  pace.learn(Detail.balls, 80); // perhaps only the first
  pace.learn(Detail.balls, 30);
  pace.learn(Detail.balls, 80);
  assert.equal(pace.moving, Detail.balls);
  pace.learn(Detail.balls, 80);
  assert.equal(pace.moving, Detail.blurred);
  pace.learn(Detail.blurred, 80); // there is nothing less
  assert.equal(pace.moving, Detail.blurred);
  pace.learn(Detail.fine, 15); // only the first pictures were slow
  assert.equal(pace.moving, Detail.fine);
});

test("a mould is not drawn where the membrane has taken its place", () => {
  const walls: Wall[] = [{ name: "mould", mould: true, point: [0, 0, 0], axis: [0, 0, 1], radius: 2 }];
  const grains = [{ id: 0, position: [0, 0, 0] as [number, number, number] }];
  assert.ok(wallLines(walls, frameOf(grains)).length > 100);
  const triangle = { position: [0, 0, 0, 1, 0, 0, 0, 1, 0], corners: [0, 1, 2] };
  assert.equal(wallLines(walls, frameOf(grains, [], [], [], triangle)).length, 0);
});

test("a leaning cell shows as twelve edges, four along each of its own", () => {
  const edges = [[2, 0, 0], [0.8, 3, 0], [0.1, 0.2, 4]];
  const corners = Array.from({ length: 8 }, (_, n) =>
    [0, 1, 2].map((axis) => edges.reduce((sum, edge, k) => sum + (n & (1 << k) ? edge[axis] : 0), -1)),
  );
  const frame = frameOf([], [], [], [], undefined, { shift: [], corners: corners.flat() });
  const lines = cellLines(frame);
  assert.equal(lines.length, 12 * 6);
  const found = edges.map(() => 0);
  const along = (line: number, axis: number) => lines[6 * line + 3 + axis] - lines[6 * line + axis];
  for (let line = 0; line < 12; ++line) {
    const edge = edges.findIndex((e) => e.every((value, axis) => Math.abs(along(line, axis) - value) < 1e-5));
    assert.ok(edge >= 0);
    ++found[edge];
  }
  assert.deepEqual(found, [4, 4, 4]);
  assert.equal(cellLines(frameOf([])).length, 0);
});

test("a grain that is drawn across the border has come no farther than its own way", () => {
  const grain = (x: number) => [{ id: 0, position: [x, 0, 0] as [number, number, number] }];
  const start = frameOf(grain(0.9), [], [], [], undefined, { shift: [0, 0, 0], corners: [] });
  const now = frameOf(grain(-0.9), [], [], [], undefined, { shift: [2, 0, 0], corners: [] });
  near(displacement(now, start, 0), 0.2);
});

test("a field of the run can colour the grains without more code", () => {
  const frame = frameOf([{ id: 0, position: [0, 0, 0] }, { id: 1, position: [1, 0, 0] }], [], [], [], undefined, undefined, {
    flux: Float32Array.from([3, 4, 12, 0, 0, -2]),
    charge: Float32Array.from([-1, 5]),
  });
  const given = { unit: "C", whole: false, needs_contacts: false };
  const list = quantitiesOf([
    { name: "flux", label: "Flux", components: 3, ...given },
    { name: "charge", label: "Charge", components: 1, ...given },
    { name: "absent", label: "Absent", components: 1, ...given },
  ]);
  const values = (id: string) => [...list.find((quantity) => quantity.id === id)!.of(frame, frame)];
  assert.deepEqual(values("flux"), [13, 2]);
  assert.deepEqual(values("charge"), [-1, 5]);
  assert.deepEqual(values("absent"), [Number.NaN, Number.NaN]);
});
