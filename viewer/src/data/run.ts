// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { Frame, type FrameText } from "./frame.ts";
import { History } from "./history.ts";
import type { Piece } from "./piece.ts";
import type { Source } from "./source.ts";

export type Vector = [number, number, number];

export interface Wall {
  name: string;
  mould?: boolean; // a membrane takes its place
  point: Vector;
  normal?: Vector; // of a plane, to the side of the grains
  axis?: Vector; // of a cylinder
  radius?: number; // [m]
}

export interface ShapeText {
  name: string;
  grains: number;
  volume: number; // [m^3]
  extent: number; // largest coordinate of the surface [m]
  vertices: number;
  triangles: number;
  coarse_vertices: number;
  coarse_triangles: number;
  measures: number[];
}

/** What run.json holds; a run that has just begun may lack parts. */
export interface RunRecord {
  status?: string;
  message?: string;
  grains?: number;
  shapes?: number;
  time_step_s?: number;
  step?: number;
  steps?: number;
  time_s?: number;
  session?: Record<string, string | number>;
  program?: Record<string, string>;
}

export interface RankPerformance {
  force_s: number;
  border_s: number;
  migrate_s: number;
  update_s: number;
  phase_s: Record<string, number>;
  list_rebuilds: number;
  peak_memory_bytes: number;
  threads: number;
}

export interface Performance {
  ranks: number;
  machines: number;
  grains: number;
  steps: number;
  wall_s: number;
  output_s: number;
  background_output_s: number;
  ns_per_grain_step: number;
  listed_pairs_per_grain: number;
  ghosts_per_grain: number;
  work_imbalance: number;
  rank: RankPerformance[];
}

/** A saved field of grains, by whose magnitude they can be coloured. */
export interface FieldText {
  name: string;
  label: string;
  unit: string;
  components: number;
  whole: boolean;
  needs_contacts: boolean;
}

export interface HeadText {
  name: string;
  title: string;
  density: number;
  stages: string[];
  record: string;
  performance: string;
  scene: string;
  resolved: string;
  log: string;
  history_rows: number;
  columns: { name: string; meaning: string }[];
  verdict: string; // why the figures mean nothing; empty where they mean something
  findings: string;
  walls: Wall[];
  cell: boolean; // periodic
  saved_frames: number;
  frames: number[];
  fields: FieldText[];
  shapes_missing: string;
  measures: string[];
  shapes: ShapeText[];
}

function parsed<T>(text: string): T | null {
  try {
    return text ? (JSON.parse(text) as T) : null;
  } catch {
    return null; // a file of a run in progress, or of a later version
  }
}

/** One run: its head, and its frames when they are requested. */
export class Run {
  readonly text: HeadText;
  readonly history: History;
  readonly record: RunRecord;
  readonly performance: Performance | null;
  private readonly frames = new Map<number, Promise<Frame>>();

  constructor(
    private readonly source: Source,
    readonly number: number,
    readonly head: Piece<HeadText>,
  ) {
    this.text = head.text;
    this.history = new History(head.text.columns, head.array("history") as Float64Array);
    this.record = parsed<RunRecord>(head.text.record) ?? {};
    this.performance = parsed<Performance>(head.text.performance);
  }

  static async load(source: Source, number: number): Promise<Run> {
    return new Run(source, number, await source.piece<HeadText>(`${number}/head`));
  }

  /** The grains at the n-th saved time. Kept, since sliders go back and forth. */
  frame(n: number): Promise<Frame> {
    const step = this.text.frames[n];
    let frame = this.frames.get(step);
    if (!frame) {
      frame = this.source
        .piece<FrameText>(`${this.number}/frame/${step}`)
        .then((piece) => new Frame(piece));
      this.frames.set(step, frame);
    }
    return frame;
  }
}
