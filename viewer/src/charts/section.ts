// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { strainAxis } from "../data/history.ts";
import type { Run } from "../data/run.ts";
import { type Choice, chooser, download, h, replace } from "../dom.ts";
import { scaled } from "../format.ts";
import { Chart } from "./chart.ts";
import {
  type Abscissa,
  abscissasOf,
  type ChartDefinition,
  chartOfColumn,
  chartsOf,
} from "./definitions.ts";
import { extent, linesOf, type Range } from "./series.ts";

/** All curves of the runs over one horizontal axis, hovered and zoomed together. */
export class ChartSection {
  readonly element = h("section", { id: "curves" });
  private readonly grid = h("div", { class: "charts" });
  private readonly controls = h("div", { class: "controls" });
  private charts: { chart: Chart; definition: ChartDefinition }[] = [];
  private stage = 0;
  private along = "time";
  private column = "contacts";
  private zoom: Range | null = null;
  private readonly stageNames: string[];
  private readonly showReset = h(
    "button",
    { type: "button", hidden: true, onclick: () => this.setZoom(null) },
    "Show all",
  );

  constructor(private runs: Run[]) {
    this.stageNames = runs[0].text.stages;
    this.chooseDefaults();
    this.element.append(
      h("h2", {}, "Curves"),
      h(
        "p",
        { class: "hint" },
        "Drag across a chart to zoom all of them, double-click to go back. With the keyboard: Tab to a chart, arrows to read values.",
      ),
      this.controls,
      this.grid,
    );
    this.build();
  }

  /** New rows of the same runs. */
  update(runs: Run[]): void {
    this.runs = runs;
    const wanted = this.definitions().map(({ id }) => id).join();
    if (wanted !== this.charts.map(({ definition }) => definition.id).join()) this.build();
    else this.draw();
  }

  /** The place of the three-dimensional view: in the first run at this step. */
  mark(step: number): void {
    const history = this.runs[0].history;
    if (!history.has("step") || history.rows === 0) return;
    const steps = history.column("step");
    let row = 0;
    while (row + 1 < history.rows && steps[row + 1] <= step) ++row;
    const abscissa = this.abscissa();
    const [first, end] = history.stageRows(this.stage);
    const columns = abscissa.value.needs.map((name) => history.column(name));
    const x = row >= first && row < end ? abscissa.value.value(columns, row) : null;
    for (const { chart } of this.charts) chart.setMarker(x === null ? null : x * this.xScale().factor);
  }

  /** A sheared sample is read over the strain of its last stage; all else over time. */
  private chooseDefaults(): void {
    const { history } = this.runs[0];
    if (!history.has("stage") || !history.has("strain_z") || history.rows === 0) return;
    const last = history.last("stage");
    const axis = strainAxis(history, last);
    const [first, end] = history.stageRows(last);
    const strain = history.column(`strain_${axis}`).subarray(first, end);
    if (!strain.some((value) => Math.abs(value) > 0.01)) return;
    this.stage = last;
    this.along = `strain_${axis}`;
  }

  private histories() {
    return this.runs.map((run) => run.history);
  }
  private abscissa(): Abscissa {
    const all = abscissasOf(this.histories());
    return all.find(({ id }) => id === this.along) ?? all[0];
  }
  private definitions(): ChartDefinition[] {
    return [...chartsOf(this.histories()), chartOfColumn(this.column)];
  }

  private build(): void {
    for (const { chart } of this.charts) chart.destroy();
    const columns = this.runs[0].history.columns;
    const anyChooser = chooser(
      "Any column",
      columns.map(({ name }) => ({ value: name, label: name })),
      this.column,
      (value) => {
        this.column = value;
        this.charts[this.charts.length - 1].definition = chartOfColumn(value);
        this.draw();
      },
    );
    const stages: Choice[] = [
      { value: "0", label: "all" },
      ...this.stageNames.map((name, n) => ({ value: String(n + 1), label: `${n + 1} ${name}` })),
    ];
    replace(
      this.controls,
      this.stageNames.length > 0 &&
        chooser("Stage", stages, String(this.stage), (value) => {
          this.stage = Number(value);
          this.setZoom(null);
          this.draw();
        }),
      chooser(
        "Over",
        abscissasOf(this.histories()).map(({ id, label }) => ({ value: id, label })),
        this.along,
        (value) => {
          this.along = value;
          this.setZoom(null);
          this.draw();
        },
      ),
      this.showReset,
      ...this.runs.map((run) =>
        h(
          "button",
          {
            type: "button",
            class: "csv",
            onclick: () => download(`${run.text.name}-history.csv`, run.history.csv()),
          },
          this.runs.length > 1 ? `CSV of ${run.text.name}` : "Download CSV",
        ),
      ),
    );
    const events = {
      hovered: (x: number | null) => {
        for (const { chart } of this.charts) chart.setHover(x);
      },
      zoomed: (range: Range | null) => this.setZoom(range),
    };
    this.charts = this.definitions().map((definition) => ({
      definition,
      chart: new Chart(definition, events),
    }));
    replace(this.grid, ...this.charts.map(({ chart }) => chart.element));
    this.charts[this.charts.length - 1].chart.element.prepend(anyChooser);
    this.draw();
  }

  private setZoom(range: Range | null): void {
    this.zoom = range;
    this.showReset.hidden = range === null;
    for (const { chart } of this.charts) chart.setZoom(range);
  }

  private xScale(): { factor: number; unit: string } {
    const abscissa = this.abscissa();
    const lines = linesOf(chartOfColumn("step"), abscissa, this.named());
    const range = extent(lines, null, "x");
    return scaled(range ? Math.max(Math.abs(range.low), Math.abs(range.high)) : 1, abscissa.unit);
  }
  private named() {
    return this.runs.map((run) => ({
      name: run.text.name,
      history: run.history,
      stage: this.stage,
    }));
  }

  private draw(): void {
    const abscissa = this.abscissa();
    const scale = this.xScale();
    const label = scale.unit ? `${abscissa.label} [${scale.unit}]` : abscissa.label;
    for (const { chart, definition } of this.charts) {
      const lines = linesOf(definition, abscissa, this.named()).map((line) => ({
        ...line,
        x: scale.factor === 1 ? line.x : line.x.map((value) => value * scale.factor),
      }));
      chart.show(definition, lines, label);
      if (this.zoom) chart.setZoom(this.zoom);
    }
  }
}
