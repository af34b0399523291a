// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import uPlot from "uplot";
import { h, replace } from "../dom.ts";
import { number, scaled } from "../format.ts";
import type { ChartDefinition } from "./definitions.ts";
import { decades, extent, type Line, nearest, padded, type Range } from "./series.ts";

const ink = "#3c4349";
const faint = "#e7e5df";
const font = '12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif';

/** The messages of a chart to the other charts. */
export interface ChartEvents {
  /** The pointer or the arrow keys are at this value of x; null: gone. */
  hovered(x: number | null): void;
  /** A part of the horizontal axis was chosen; null: all of it. */
  zoomed(range: Range | null): void;
}

/** One chart with axes, legend, and a box of values at the pointer. */
export class Chart {
  readonly element: HTMLElement;
  private readonly plotBox = h("div", { class: "plot" });
  private readonly legend = h("ul", { class: "legend" });
  private readonly values = h("div", { class: "values", hidden: true });
  private plot: uPlot | null = null;
  private lines: Line[] = [];
  private zoom: Range | null = null;
  private marker: number | null = null;
  private at: number | null = null;
  private xLabel = "";
  private yUnit = "";

  constructor(
    private definition: ChartDefinition,
    private readonly events: ChartEvents,
  ) {
    this.plotBox.append(this.values);
    this.plotBox.tabIndex = 0;
    this.plotBox.setAttribute("role", "img");
    this.element = h("figure", { class: "chart", id: `chart-${definition.id}` });
    this.element.append(h("figcaption", {}, definition.title), this.plotBox, this.legend);
    this.plotBox.addEventListener("keydown", (event) => this.key(event));
    this.plotBox.addEventListener("blur", () => this.events.hovered(null));
    new ResizeObserver(() => this.resize()).observe(this.plotBox);
  }

  show(definition: ChartDefinition, lines: Line[], xLabel: string): void {
    this.definition = definition;
    const largest = extent(lines, null, "y");
    const size = largest ? Math.max(Math.abs(largest.low), Math.abs(largest.high)) : 0;
    const scale = scaled(size, definition.unit);
    this.yUnit = scale.unit;
    this.lines = lines.map((line) => ({ ...line, y: line.y.map((value) => value * scale.factor) }));
    this.xLabel = xLabel;
    const caption = this.element.querySelector("figcaption");
    if (caption) replace(caption, definition.title, scale.unit ? h("span", {}, ` [${scale.unit}]`) : null);
    this.plotBox.setAttribute(
      "aria-label",
      `${definition.title} over ${xLabel}. Arrow keys read values, Escape shows all.`,
    );
    replace(
      this.legend,
      ...(lines.length > 1 ? lines.map((line) => h("li", {}, swatch(line), line.label)) : []),
    );
    this.draw();
  }

  setZoom(zoom: Range | null): void {
    this.zoom = zoom;
    if (!this.plot) return;
    this.applyRanges();
  }

  /** The place of the three-dimensional view. */
  setMarker(x: number | null): void {
    this.marker = x;
    this.plot?.redraw(false, false);
  }

  /** Shows the values at x. */
  setHover(x: number | null): void {
    this.at = x;
    const plot = this.plot;
    if (!plot || x === null || this.lines.length === 0) {
      this.values.hidden = true;
      return;
    }
    const rows = this.lines
      .map((line) => ({ line, n: nearest(line, x, null) }))
      .filter(({ n }) => n >= 0);
    if (rows.length === 0) return;
    const place = plot.valToPos(rows[0].line.x[rows[0].n], "x");
    const [, xUnit] = this.xParts();
    replace(
      this.values,
      h(
        "div",
        { class: "box" },
        h("div", {}, `${number(rows[0].line.x[rows[0].n], 4)}${xUnit ? ` ${xUnit}` : ""}`),
        ...rows.map(({ line, n }) =>
          h(
            "div",
            { class: "row" },
            swatch(line),
            h("span", {}, line.label),
            h("b", {}, `${number(line.y[n], 4)}${this.yUnit ? ` ${this.yUnit}` : ""}`),
          ),
        ),
      ),
      h("i", { class: "cross" }),
      ...rows.map(({ line, n }) =>
        h("i", {
          class: "dot",
          style: `background:${line.colour};--x:${plot.valToPos(line.x[n], "x") - place}px;--y:${plot.valToPos(line.y[n], "y")}px`,
        }),
      ),
    );
    const over = plot.over;
    this.values.style.setProperty("--left", `${over.offsetLeft + place}px`);
    this.values.style.setProperty("--top", `${over.offsetTop}px`);
    this.values.style.setProperty("--height", `${over.clientHeight}px`);
    this.values.classList.toggle("flip", place > over.clientWidth / 2);
    this.values.hidden = place < -1 || place > over.clientWidth + 1;
  }

  destroy(): void {
    this.plot?.destroy();
    this.plot = null;
  }

  private xParts(): [string, string] {
    const match = /^(.*) \[(.*)\]$/.exec(this.xLabel);
    return match ? [match[1], match[2]] : [this.xLabel, ""];
  }

  private ranges(): { x: Range; y: Range } {
    const all = extent(this.lines, null, "x");
    const x = this.zoom ?? (all && all.high > all.low ? all : padded(all, false));
    const log = this.definition.logarithmic === true;
    const seen = extent(this.lines, x, "y", log);
    return { x, y: log ? decades(seen) : padded(seen, this.definition.fromZero === true) };
  }

  private applyRanges(): void {
    const plot = this.plot;
    if (!plot) return;
    const { x, y } = this.ranges();
    plot.batch(() => {
      plot.setScale("x", { min: x.low, max: x.high });
      plot.setScale("y", { min: y.low, max: y.high });
    });
    plot.redraw(true, true);
    this.setHover(null);
  }

  private resize(): void {
    const width = this.plotBox.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) {
      this.plot.setSize({ width, height: this.height(width) });
    } else if (!this.plot && width > 0 && this.lines.length > 0) {
      this.draw();
    }
  }
  private height(width: number): number {
    return Math.round(Math.min(Math.max(0.48 * width, 180), 260));
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = null;
    const width = this.plotBox.clientWidth;
    if (width === 0 || this.lines.length === 0) return;
    const ranges = this.ranges();
    const axis = {
      stroke: ink,
      font,
      grid: { stroke: faint, width: 1 },
      ticks: { stroke: faint, width: 1, size: 5 },
    };
    const label = (_: uPlot, splits: number[]) =>
      splits.map((value) => (value === null ? "" : number(value, 6)));
    const options: uPlot.Options = {
      mode: 2,
      width,
      height: this.height(width),
      padding: [8, 12, 0, 0],
      legend: { show: false },
      cursor: {
        points: { show: false },
        x: false,
        y: false,
        dataIdx: () => null as unknown as number,
        drag: { x: true, y: false, setScale: false },
      },
      scales: {
        x: { time: false, auto: false, range: (_, low, high) => [low, high] },
        y: {
          auto: false,
          distr: this.definition.logarithmic ? 3 : 1,
          range: (_, low, high) => [low, high],
        },
      },
      axes: [
        { ...axis, scale: "x", values: label, label: this.xLabel, labelFont: font, labelSize: 22, size: 30 },
        {
          ...axis,
          scale: "y",
          size: 58,
          values: this.definition.logarithmic
            ? (_, splits) =>
                splits.map((value) =>
                  value && Math.abs(Math.log10(value) % 1) < 1e-6 ? number(value, 1) : "",
                )
            : label,
        },
      ],
      series: [
        {},
        ...this.lines.map((line) => ({
          label: line.label,
          facets: [
            { scale: "x", auto: false },
            { scale: "y", auto: false },
          ],
          stroke: line.colour,
          width: 1.75,
          dash: line.dash,
          points: { show: false },
          paths: polyline,
        })),
      ] as unknown as uPlot.Series[],
      hooks: {
        setSelect: [(plot) => this.selected(plot)],
        draw: [(plot) => this.drawMarker(plot)],
      },
    };
    const data = [null, ...this.lines.map((line) => [line.x, line.y])] as unknown as uPlot.AlignedData;
    const plot = new uPlot(options, data, this.plotBox);
    plot.batch(() => {
      plot.setScale("x", { min: ranges.x.low, max: ranges.x.high });
      plot.setScale("y", { min: ranges.y.low, max: ranges.y.high });
    });
    this.plot = plot;
    plot.over.addEventListener("mousemove", (event) => {
      const left = event.clientX - plot.over.getBoundingClientRect().left;
      this.events.hovered(plot.posToVal(left, "x"));
    });
    plot.over.addEventListener("mouseleave", () => this.events.hovered(null));
    plot.over.addEventListener("dblclick", () => this.events.zoomed(null));
  }

  private selected(plot: uPlot): void {
    const { left, width } = plot.select;
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    if (width < 4) return;
    this.events.zoomed({ low: plot.posToVal(left, "x"), high: plot.posToVal(left + width, "x") });
  }

  private drawMarker(plot: uPlot): void {
    if (this.marker === null) return;
    const x = Math.round(plot.valToPos(this.marker, "x", true));
    const { left, top, width, height } = plot.bbox;
    if (!(x >= left - 1 && x <= left + width + 1)) return;
    const context = plot.ctx;
    context.save();
    context.strokeStyle = "#8a8f94";
    context.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
    context.lineWidth = devicePixelRatio;
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    context.restore();
  }

  private key(event: KeyboardEvent): void {
    if (event.key === "Escape") {
      this.events.zoomed(null);
      this.events.hovered(null);
      return;
    }
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0 || !this.plot) return;
    event.preventDefault();
    const { x } = this.ranges();
    const from = this.at ?? (step > 0 ? x.low : x.high);
    const moved = from + (step * (x.high - x.low)) / (event.shiftKey ? 10 : 100);
    this.events.hovered(Math.min(Math.max(moved, x.low), x.high));
  }
}

function swatch(line: Line): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("class", "swatch");
  svg.setAttribute("viewBox", "0 0 22 8");
  const stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
  stroke.setAttribute("d", "M0 4H22");
  stroke.setAttribute("stroke", line.colour);
  stroke.setAttribute("stroke-width", "2.5");
  if (line.dash.length > 0) stroke.setAttribute("stroke-dasharray", line.dash.join(" "));
  svg.append(stroke);
  return svg;
}

/** Samples in their own order, so that loops of loading and unloading are drawn as they went. */
function polyline(plot: uPlot, seriesIndex: number): uPlot.Series.Paths | null {
  const [x, y] = (plot.data as unknown as Float64Array[][])[seriesIndex];
  const stroke = new Path2D();
  let pen = false;
  for (let n = 0; n < x.length; ++n) {
    const log = plot.scales.y.distr === 3;
    if (!Number.isFinite(x[n]) || !Number.isFinite(y[n]) || (log && y[n] <= 0)) {
      pen = false;
      continue;
    }
    const across = plot.valToPos(x[n], "x", true);
    const down = plot.valToPos(y[n], "y", true);
    if (pen) stroke.lineTo(across, down);
    else stroke.moveTo(across, down);
    pen = true;
  }
  return { stroke, fill: null, clip: null, flags: 0 } as unknown as uPlot.Series.Paths;
}
