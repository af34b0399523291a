// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Frame } from "../data/frame.ts";
import type { FieldText } from "../data/run.ts";

/** What grains can be coloured by. `start` is the frame that displacements are counted from. */
export interface Quantity {
  id: string;
  label: string;
  short: string; // for the list of choices
  unit: string;
  needsContacts?: boolean;
  whole?: boolean; // counts: the legend shows whole numbers
  of(frame: Frame, start: Frame): Float32Array;
}

function perGrain(frame: Frame, value: (row: number) => number): Float32Array {
  const values = new Float32Array(frame.grains);
  for (let row = 0; row < values.length; ++row) values[row] = value(row);
  return values;
}

/** Of a vector; a single number keeps its sign. */
function magnitude(numbers: Float32Array, components: number, row: number): number {
  if (components === 1) return numbers[row];
  return Math.hypot(...numbers.subarray(components * row, components * (row + 1)));
}

/** The unwrapped position of a grain along an axis [m]: its image in the periodic cell is drawn. */
function way(frame: Frame, row: number, axis: number): number {
  return frame.position[3 * row + axis] + (frame.cellShift[3 * row + axis] ?? 0);
}

/** How far a grain has come since `start` [m]; NaN for one that was not there. */
export function displacement(frame: Frame, start: Frame, row: number): number {
  const before = start.rowOf(frame.id[row]);
  if (before < 0) return Number.NaN;
  return Math.hypot(...[0, 1, 2].map((axis) => way(frame, row, axis) - way(start, before, axis)));
}

/** The angle of the turn from the orientation in `start` to the one in `frame`, 0 to 180 [deg]. */
export function rotation(frame: Frame, start: Frame, row: number): number {
  const before = start.rowOf(frame.id[row]);
  if (before < 0) return Number.NaN;
  const a = frame.orientation.subarray(4 * row, 4 * row + 4);
  const b = start.orientation.subarray(4 * before, 4 * before + 4);
  const [aw, ax, ay, az] = a;
  const [bw, bx, by, bz] = b;
  // a times the conjugate of b
  const w = aw * bw + ax * bx + ay * by + az * bz;
  const x = -aw * bx + ax * bw - ay * bz + az * by;
  const y = -aw * by + ax * bz + ay * bw - az * bx;
  const z = -aw * bz - ax * by + ay * bx + az * bw;
  return (2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)) * 180) / Math.PI;
}

const computed: readonly Quantity[] = [
  {
    id: "displacement",
    label: "Displacement",
    short: "displacement",
    unit: "m",
    of: (frame, start) => perGrain(frame, (row) => displacement(frame, start, row)),
  },
  {
    id: "rotation",
    label: "Rotation",
    short: "rotation",
    unit: "°",
    of: (frame, start) => perGrain(frame, (row) => rotation(frame, start, row)),
  },
  {
    id: "stress",
    label: "Mean stress in the grain",
    short: "mean stress",
    unit: "Pa",
    needsContacts: true,
    of: (frame) => frame.stress().mean,
  },
  {
    id: "deviator",
    label: "Deviator of the grain's stress",
    short: "deviatoric stress",
    unit: "Pa",
    needsContacts: true,
    of: (frame) => frame.stress().deviator,
  },
  {
    id: "size",
    label: "Diameter of the sphere of equal volume",
    short: "size",
    unit: "m",
    of: (frame) => frame.equivalentRadius.map((radius) => 2 * radius),
  },
];

/** The quantities that can colour a run: those computed here, and its saved fields. */
export function quantitiesOf(fields: readonly FieldText[]): Quantity[] {
  return [...computed, ...fields.map(savedQuantity)];
}

function savedQuantity(field: FieldText): Quantity {
  const { name, label, unit, components, whole } = field;
  return {
    id: name,
    label,
    short: label.charAt(0).toLowerCase() + label.slice(1),
    unit,
    needsContacts: field.needs_contacts,
    whole,
    of: (frame) => {
      const saved = frame.field(name);
      return perGrain(frame, (row) => (saved ? magnitude(saved, components, row) : Number.NaN));
    },
  };
}

/** Between the 2nd and the 98th percentile, so that a single fast grain does not darken the rest. */
export function colourRange(values: Float32Array): [number, number] {
  const sorted = values.filter((value) => Number.isFinite(value)).sort();
  if (sorted.length === 0) return [0, 1];
  const at = (share: number) => sorted[Math.round(share * (sorted.length - 1))];
  const [low, high] = [at(0.02), at(0.98)];
  if (high > low) return [low, high];
  const [least, most] = [sorted[0], sorted[sorted.length - 1]];
  return most > least ? [least, most] : [least, least + (Math.abs(least) || 1)];
}
