// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Piece } from "./piece.ts";

export interface FrameText {
  step: number;
  time: number; // [s]
  has_contacts: boolean;
  pairs: number;
}

/** The grains and contacts at one saved time. Rows of grains are in the order of their ids. */
export class Frame {
  readonly step: number;
  readonly time: number;
  readonly hasContacts: boolean;
  /** Contacts from here on are with walls. */
  readonly pairs: number;
  readonly id: Uint32Array;
  readonly shape: Uint32Array;
  readonly position: Float32Array;
  readonly orientation: Float32Array; // w, x, y, z
  readonly radius: Float32Array;
  readonly equivalentRadius: Float32Array;
  readonly cellShift: Float32Array; // from the image of a grain in the periodic cell to its unwrapped position; empty without
  readonly ends: Uint32Array;
  readonly force: Float32Array; // on the first end
  readonly branch: Float32Array; // from the first end's centre to the other's, or to the wall
  readonly deepest: Float32Array;
  readonly nodes: Uint16Array;
  readonly wallDisplacement: Float32Array;
  readonly membranePosition: Float32Array; // empty where there is none
  readonly membraneCorners: Uint32Array; // three nodes for each triangle
  readonly cellCorners: Float32Array; // eight, of the periodic cell; empty where there is none
  private stresses: GrainStress | null = null;

  constructor(private readonly piece: Piece<FrameText>) {
    this.step = piece.text.step;
    this.time = piece.text.time;
    this.hasContacts = piece.text.has_contacts;
    this.pairs = piece.text.pairs;
    this.id = piece.array("id") as Uint32Array;
    this.shape = piece.array("shape") as Uint32Array;
    this.position = piece.array("position") as Float32Array;
    this.orientation = piece.array("orientation") as Float32Array;
    this.radius = piece.array("radius") as Float32Array;
    this.equivalentRadius = piece.array("equivalent_radius") as Float32Array;
    this.cellShift = piece.array("cell_shift") as Float32Array;
    this.ends = piece.array("ends") as Uint32Array;
    this.force = piece.array("force") as Float32Array;
    this.branch = piece.array("branch") as Float32Array;
    this.deepest = piece.array("deepest") as Float32Array;
    this.nodes = piece.array("nodes") as Uint16Array;
    this.wallDisplacement = piece.array("wall_displacement") as Float32Array;
    this.membranePosition = piece.array("membrane_position") as Float32Array;
    this.membraneCorners = piece.array("membrane_corners") as Uint32Array;
    this.cellCorners = piece.array("cell_corners") as Float32Array;
  }

  get grains(): number {
    return this.id.length;
  }
  get contacts(): number {
    return this.deepest.length;
  }

  /** A saved field, grain by grain; null where this frame does not have it. */
  field(name: string): Float32Array | null {
    return this.piece.has(name) ? (this.piece.array(name) as Float32Array) : null;
  }

  /** The row of a grain, or -1. */
  rowOf(id: number): number {
    let low = 0;
    let high = this.id.length - 1;
    while (low <= high) {
      const middle = (low + high) >> 1;
      if (this.id[middle] === id) return middle;
      if (this.id[middle] < id) low = middle + 1;
      else high = middle - 1;
    }
    return -1;
  }

  forceOf(contact: number): number {
    return Math.hypot(
      this.force[3 * contact],
      this.force[3 * contact + 1],
      this.force[3 * contact + 2],
    );
  }

  stress(): GrainStress {
    this.stresses ??= grainStress(this);
    return this.stresses;
  }
}

/** By grain, compression positive [Pa]. */
export interface GrainStress {
  mean: Float32Array; // p, a third of the trace
  deviator: Float32Array; // q = sqrt(3/2 s:s)
}

/**
 * Mean stress in each grain from the forces at its contacts, sigma = -(1/V) sum f (x) c with f the
 * force on the grain and c from its centre to the contact (Love 1927; Weber 1966). A contact of two
 * grains is taken half-way between their centres, one with a wall at the foot of the centre.
 */
export function grainStress(frame: Frame): GrainStress {
  const grains = frame.grains;
  const sums = new Float64Array(9 * grains);
  const add = (row: number, contact: number, share: number) => {
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) {
        sums[9 * row + 3 * i + j] -=
          share * frame.force[3 * contact + i] * frame.branch[3 * contact + j];
      }
    }
  };
  for (let c = 0; c < frame.contacts; ++c) {
    if (c < frame.pairs) {
      add(frame.ends[2 * c], c, 0.5);
      add(frame.ends[2 * c + 1], c, 0.5);
    } else {
      add(frame.ends[2 * c], c, 1);
    }
  }
  const mean = new Float32Array(grains);
  const deviator = new Float32Array(grains);
  for (let g = 0; g < grains; ++g) {
    const volume = (4 / 3) * Math.PI * frame.equivalentRadius[g] ** 3;
    const p = (sums[9 * g] + sums[9 * g + 4] + sums[9 * g + 8]) / 3;
    let square = 0;
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) {
        const symmetric = (sums[9 * g + 3 * i + j] + sums[9 * g + 3 * j + i]) / 2;
        square += (symmetric - (i === j ? p : 0)) ** 2;
      }
    }
    mean[g] = p / volume;
    deviator[g] = Math.sqrt(1.5 * square) / volume;
  }
  return { mean, deviator };
}
