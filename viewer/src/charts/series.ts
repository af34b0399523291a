// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { dashes, hues } from "../colours.ts";
import type { History } from "../data/history.ts";
import type { Abscissa, ChartDefinition } from "./definitions.ts";

/** One line of a chart, in the units of its axes. */
export interface Line {
  label: string;
  x: Float64Array;
  y: Float64Array;
  colour: string;
  dash: number[];
}

export interface NamedHistory {
  name: string;
  history: History;
  /** The stage whose rows are drawn, counted from 1; 0 for all. */
  stage: number;
}

/**
 * The lines of a chart. With one curve per run the runs differ by colour; with several curves these
 * differ by colour and the runs by dashes.
 */
export function linesOf(
  chart: ChartDefinition,
  abscissa: Abscissa,
  runs: readonly NamedHistory[],
): Line[] {
  const lines: Line[] = [];
  runs.forEach(({ name, history, stage }, run) => {
    chart.curves.forEach((curve, c) => {
      if (!curve.needs.every((column) => history.has(column))) return;
      const columns = curve.needs.map((column) => history.column(column));
      const along = abscissa.value.needs.map((column) => history.column(column));
      const [first, end] = history.stageRows(stage);
      const x = new Float64Array(end - first);
      const y = new Float64Array(end - first);
      for (let row = first; row < end; ++row) {
        x[row - first] = abscissa.value.value(along, row);
        y[row - first] = curve.value(columns, row);
      }
      const single = chart.curves.length === 1;
      lines.push({
        label: runs.length === 1 ? curve.label : single ? name : `${curve.label}, ${name}`,
        x,
        y,
        colour: hues[(single ? run : c) % hues.length],
        dash: single ? dashes[Math.floor(run / hues.length) % dashes.length] : dashes[run % dashes.length],
      });
    });
  });
  return lines;
}

export interface Range {
  low: number;
  high: number;
}

/** Min and max of the finite numbers of `values(line)`; null where there is none. */
export function extent(
  lines: readonly Line[],
  within: Range | null,
  pick: "x" | "y",
  positive = false,
): Range | null {
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (const line of lines) {
    for (let n = 0; n < line.x.length; ++n) {
      if (within && (line.x[n] < within.low || line.x[n] > within.high)) continue;
      const value = line[pick][n];
      if (!Number.isFinite(value) || (positive && value <= 0)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? { low, high } : null;
}

/** A margin around the curves, and zero where it belongs. */
export function padded(range: Range | null, fromZero: boolean): Range {
  if (!range) return { low: 0, high: 1 };
  let { low, high } = range;
  if (fromZero) {
    low = Math.min(low, 0);
    high = Math.max(high, 0);
    if (low === high) return { low: 0, high: 1 };
  }
  const room = high > low ? 0.05 * (high - low) : Math.max(Math.abs(high), 1e-12) * 0.1;
  return {
    low: fromZero && low === 0 ? 0 : low - room,
    high: fromZero && high === 0 ? 0 : high + room,
  };
}

/** Whole powers of ten around a range. */
export function decades(range: Range | null): Range {
  if (!range) return { low: 0.1, high: 1 };
  const low = 10 ** Math.floor(Math.log10(range.low) + 1e-9);
  const high = 10 ** Math.ceil(Math.log10(range.high) - 1e-9);
  return { low, high: high > low ? high : 10 * low };
}

/** The sample of a line nearest to a value of x, and among equals nearest to `y`; -1 without any. */
export function nearest(line: Line, x: number, y: number | null): number {
  let best = -1;
  let distance = Number.POSITIVE_INFINITY;
  let height = Number.POSITIVE_INFINITY;
  for (let n = 0; n < line.x.length; ++n) {
    if (!Number.isFinite(line.y[n])) continue;
    const away = Math.abs(line.x[n] - x);
    const above = y === null ? 0 : Math.abs(line.y[n] - y);
    if (away < distance || (away === distance && above < height)) {
      best = n;
      distance = away;
      height = above;
    }
  }
  return best;
}
