// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { Frame, type FrameText } from "../src/data/frame.ts";
import { type Numbers, Piece } from "../src/data/piece.ts";

export interface GrainGiven {
  id: number;
  position: [number, number, number];
  orientation?: [number, number, number, number];
  radius?: number;
}
export interface ContactGiven {
  ends: [number, number];
  force: [number, number, number];
  branch: [number, number, number];
}

/** A frame of these grains, with contacts of pairs and then with walls. */
export function frameOf(
  grains: GrainGiven[],
  pairs: ContactGiven[] = [],
  walls: ContactGiven[] = [],
  wallDisplacement: number[] = [],
  membrane: { position: number[]; corners: number[] } = { position: [], corners: [] },
  cell: { shift: number[]; corners: number[] } = { shift: [], corners: [] },
  fields: Record<string, Float32Array> = {},
): Frame {
  const contacts = [...pairs, ...walls];
  const radii = Float32Array.from(grains, ({ radius }) => radius ?? 1);
  const arrays: Record<string, Numbers> = {
    id: Uint32Array.from(grains, ({ id }) => id),
    shape: new Uint32Array(grains.length),
    position: Float32Array.from(grains.flatMap(({ position }) => position)),
    orientation: Float32Array.from(grains.flatMap(({ orientation }) => orientation ?? [1, 0, 0, 0])),
    radius: radii,
    equivalent_radius: radii,
    ends: Uint32Array.from(contacts.flatMap(({ ends }) => ends)),
    force: Float32Array.from(contacts.flatMap(({ force }) => force)),
    branch: Float32Array.from(contacts.flatMap(({ branch }) => branch)),
    deepest: new Float32Array(contacts.length),
    nodes: new Uint16Array(contacts.length),
    wall_displacement: Float32Array.from(wallDisplacement),
    membrane_position: Float32Array.from(membrane.position),
    membrane_corners: Uint32Array.from(membrane.corners),
    cell_shift: Float32Array.from(cell.shift),
    cell_corners: Float32Array.from(cell.corners),
    ...fields,
  };
  const text: FrameText = { step: 1, time: 0.5, has_contacts: true, pairs: pairs.length };
  return new Frame(new Piece(text, new Map(Object.entries(arrays))));
}

export function near(actual: number, expected: number, tolerance = 1e-6): void {
  const allowed = tolerance * Math.max(1, Math.abs(expected));
  if (!(Math.abs(actual - expected) <= allowed)) {
    throw new Error(`${actual} is not ${expected} to ${tolerance}`);
  }
}
