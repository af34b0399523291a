// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { colourMap, hues, maps } from "../src/colours.ts";
import { abscissasOf, chartsOf } from "../src/charts/definitions.ts";
import { decades, extent, linesOf, nearest, padded } from "../src/charts/series.ts";
import { History } from "../src/data/history.ts";
import { bytes, duration, number, quantity, scaled, whole } from "../src/format.ts";
import { roundTicks, spreadOf } from "../src/tables/shapes.ts";
import { near } from "./frames.ts";

/** Relative luminance of an sRGB colour (WCAG 2). */
function luminance([r, g, b]: number[]): number {
  const linear = (c: number) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
}

test("every map grows lighter from end to end, so that it reads without colour", () => {
  for (const name of Object.keys(maps)) {
    const map = colourMap(name);
    for (let n = 1; n <= 64; ++n) {
      assert.ok(luminance(map(n / 64)) > luminance(map((n - 1) / 64)), `${name} at ${n}`);
    }
  }
  assert.deepEqual(colourMap("viridis")(-1), colourMap("viridis")(0));
  assert.deepEqual(colourMap("viridis")(Number.NaN), [0.8, 0.8, 0.8]);
});

test("no two hues of curves are alike", () => {
  assert.equal(new Set(hues).size, hues.length);
});

test("numbers are written short, with their unit in a fitting prefix", () => {
  assert.equal(number(0.1 + 0.2), "0.3");
  assert.equal(number(-1234567), "−1.235×10⁶");
  assert.equal(number(12345, 5), "12\u202f345");
  assert.equal(number(1.2e-7, 2), "1.2×10⁻⁷");
  assert.equal(number(Number.NaN), "–");
  assert.equal(whole(99000), "99\u202f000");
  assert.equal(quantity(1.25e-3, "m"), "1.25\u00a0mm");
  assert.equal(quantity(1e5, "Pa"), "100\u00a0kPa");
  assert.equal(quantity(1.36e-6, "kg"), "1.36\u00a0mg");
  assert.equal(quantity(34.4, "°"), "34.4°");
  assert.deepEqual(scaled(0, "Pa"), { factor: 1, unit: "Pa" });
  assert.equal(duration(104), "1 min 44 s");
  assert.equal(bytes(46_700_000), "46.7\u00a0MB");
});

const history = new History(
  ["time_s", "contacts", "mean_stress_Pa", "deviator_Pa", "elastic_J", "friction_J", "dashpot_J"].map(
    (name) => ({ name, meaning: "" }),
  ),
  Float64Array.from([
    ...[0, 1, 2],
    ...[5, 6, 7],
    ...[100, 100, 0],
    ...[0, 50, 50],
    ...[1, 2, 3],
    ...[0, 1, 2],
    ...[0, 0, 0],
  ]),
);

test("charts are those that the columns allow, without curves that stay zero", () => {
  const charts = chartsOf([history]);
  assert.deepEqual(
    charts.map(({ id }) => id),
    ["stress-ratio", "stresses", "energy"],
  );
  assert.deepEqual(
    charts[2].curves.map(({ label }) => label),
    ["friction", "elastic"],
  );
  assert.deepEqual(
    abscissasOf([history]).map(({ id }) => id),
    ["time", "mean_stress"],
  );
});

test("a ratio over nothing is left out, and runs differ by colour", () => {
  const [ratio] = chartsOf([history]);
  const [time] = abscissasOf([history]);
  const runs = ["one", "two"].map((name) => ({ name, history, stage: 0 }));
  const lines = linesOf(ratio, time, runs);
  assert.deepEqual(lines.map(({ label }) => label), ["one", "two"]);
  assert.notEqual(lines[0].colour, lines[1].colour);
  assert.deepEqual([...lines[0].y], [0, 0.5, Number.NaN]);
  assert.deepEqual(extent(lines, null, "y"), { low: 0, high: 0.5 });
  assert.equal(nearest(lines[0], 1.9, null), 1);
  assert.equal(nearest(lines[0], -5, null), 0);
});

test("several curves of several runs differ by colour and dashes", () => {
  const energy = chartsOf([history])[2];
  const runs = ["one", "two"].map((name) => ({ name, history, stage: 0 }));
  const lines = linesOf(energy, abscissasOf([history])[0], runs);
  assert.deepEqual(lines.map(({ label }) => label), [
    "friction, one",
    "elastic, one",
    "friction, two",
    "elastic, two",
  ]);
  assert.equal(lines[0].colour, lines[2].colour);
  assert.notDeepEqual(lines[0].dash, lines[2].dash);
});

test("axes leave room, start at zero where it belongs, and hold whole decades", () => {
  const open = padded({ low: 10, high: 20 }, false);
  near(open.low, 9.5);
  near(open.high, 20.5);
  assert.equal(padded({ low: 1, high: 2 }, true).low, 0);
  assert.deepEqual(padded({ low: 0, high: 0 }, true), { low: 0, high: 1 }); // a run without contacts
  assert.deepEqual(decades({ low: 0.002, high: 0.5 }), { low: 0.001, high: 1 });
  assert.deepEqual(decades({ low: 0.01, high: 0.01 }), { low: 0.01, high: 0.1 });
  const flat = padded({ low: 3, high: 3 }, false);
  assert.ok(flat.low < 3 && flat.high > 3);
});

test("the spread of shapes counts grains as if they stood in a row", () => {
  const weighted = spreadOf([
    { value: 2, weight: 3 },
    { value: 1, weight: 1 },
    { value: 5, weight: 0 },
    { value: 10, weight: 1 },
  ]);
  const row = [1, 2, 2, 2, 10];
  const mean = row.reduce((a, b) => a + b) / row.length;
  near(weighted.mean, mean);
  near(weighted.deviation, Math.sqrt(row.reduce((a, b) => a + (b - mean) ** 2, 0) / (row.length - 1)));
  assert.deepEqual(
    [weighted.low, weighted.tenth, weighted.median, weighted.ninetieth, weighted.high],
    [1, 1, 2, 10, 10],
  );
});

test("ticks are round numbers within the range", () => {
  assert.deepEqual(roundTicks(0.57, 1.38, 5), [0.6, 0.8, 1, 1.2]);
  assert.deepEqual(roundTicks(0, 100, 5), [0, 20, 40, 60, 80, 100]);
});
