// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

export interface Column {
  name: string;
  meaning: string;
}

/** history.csv, by columns. */
export class History {
  readonly rows: number;
  private readonly byName = new Map<string, Float64Array>();

  constructor(
    readonly columns: readonly Column[],
    numbers: Float64Array,
  ) {
    this.rows = columns.length > 0 ? numbers.length / columns.length : 0;
    columns.forEach((column, n) => {
      this.byName.set(column.name, numbers.subarray(n * this.rows, (n + 1) * this.rows));
    });
  }

  has(name: string): boolean {
    return this.byName.has(name);
  }
  column(name: string): Float64Array {
    const found = this.byName.get(name);
    if (!found) throw new Error(`history.csv has no column "${name}"`);
    return found;
  }
  meaning(name: string): string {
    return this.columns.find((column) => column.name === name)?.meaning ?? "";
  }
  last(name: string): number {
    return this.has(name) && this.rows > 0 ? this.column(name)[this.rows - 1] : Number.NaN;
  }

  /** Rows of one stage, counted from 1, as [first, end); all rows for stage 0. */
  stageRows(stage: number): [number, number] {
    if (stage === 0 || !this.has("stage")) return [0, this.rows];
    const stages = this.column("stage");
    let first = 0;
    while (first < this.rows && stages[first] < stage) ++first;
    let end = first;
    while (end < this.rows && stages[end] === stage) ++end;
    return [first, end];
  }

  /** The table as text, with numbers that read back as the same bits. */
  csv(): string {
    const lines = [this.columns.map((column) => column.name).join(",")];
    const columns = this.columns.map((column) => this.column(column.name));
    for (let row = 0; row < this.rows; ++row) {
      lines.push(columns.map((column) => cell(column[row])).join(","));
    }
    return lines.join("\n") + "\n";
  }
}

/** As the run writes it. String(-0) is "0". */
function cell(value: number): string {
  if (Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  return Object.is(value, -0) ? "-0" : String(value);
}

/** The unit at the end of a column's name, e.g. "time_s" -> ["time", "s"]. */
export function splitUnit(name: string): [string, string] {
  const units: [RegExp, string][] = [
    [/_kg_m_per_s$/, "kg m/s"],
    [/_m_per_s$/, "m/s"],
    [/_m3$/, "m³"],
    [/_m$/, "m"],
    [/_s$/, "s"],
    [/_J$/, "J"],
    [/_N$/, "N"],
    [/_Pa$/, "Pa"],
    [/_deg$/, "°"],
  ];
  for (const [pattern, unit] of units) {
    if (pattern.test(name)) return [name.replace(pattern, ""), unit];
  }
  return [name, ""];
}

/** The axis along which a stage has shortened or lengthened most: x, y or z. */
export function strainAxis(history: History, stage: number): "x" | "y" | "z" {
  const [first, end] = history.stageRows(stage);
  let best: "x" | "y" | "z" = "z";
  let most = 0;
  for (const axis of ["x", "y", "z"] as const) {
    const strain = history.column(`strain_${axis}`);
    for (let row = first; row < end; ++row) {
      if (Math.abs(strain[row]) > most) {
        most = Math.abs(strain[row]);
        best = axis;
      }
    }
  }
  return best;
}
