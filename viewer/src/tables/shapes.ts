// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { hues } from "../colours.ts";
import { splitUnit } from "../data/history.ts";
import type { Run, ShapeText } from "../data/run.ts";
import { h } from "../dom.ts";
import { number, scaled, whole } from "../format.ts";

/** Values with how many grains have each. */
export interface Sample {
  value: number;
  weight: number;
}

export interface Spread {
  mean: number;
  deviation: number; // of the grains, with n - 1
  low: number;
  tenth: number;
  median: number;
  ninetieth: number;
  high: number;
}

/** How a measure is spread over grains. A percentile is the value of the grain at that place. */
export function spreadOf(samples: readonly Sample[]): Spread {
  const sorted = samples.filter(({ weight }) => weight > 0).sort((a, b) => a.value - b.value);
  const count = sorted.reduce((sum, { weight }) => sum + weight, 0);
  const mean = sorted.reduce((sum, { value, weight }) => sum + value * weight, 0) / count;
  const square = sorted.reduce((sum, { value, weight }) => sum + weight * (value - mean) ** 2, 0);
  const at = (share: number) => {
    let seen = 0;
    for (const { value, weight } of sorted) {
      seen += weight;
      if (seen >= share * count) return value;
    }
    return sorted.length > 0 ? sorted[sorted.length - 1].value : Number.NaN;
  };
  return {
    mean,
    deviation: count > 1 ? Math.sqrt(square / (count - 1)) : 0,
    low: at(0),
    tenth: at(0.1),
    median: at(0.5),
    ninetieth: at(0.9),
    high: at(1),
  };
}

const words: Record<string, string> = {
  diameter: "Diameter of equal volume",
  sieve_size: "Sieve size",
  length: "Length",
  width: "Width",
  thickness: "Thickness",
  elongation: "Elongation, width / length",
  flatness: "Flatness, thickness / width",
  sphericity: "Sphericity (Wadell)",
  convexity: "Convexity",
  roundness: "Roundness (Wadell)",
};

export function shapeSection(runs: readonly Run[]): HTMLElement | null {
  const known = runs.filter((run) => run.text.shapes.some(({ grains }) => grains > 0));
  if (known.length === 0) return null;
  return h(
    "section",
    { id: "shapes" },
    h("h2", {}, "Shapes"),
    ...known.map((run) =>
      h(
        "div",
        {},
        runs.length > 1 && h("h3", {}, run.text.name),
        h("div", { class: "scroll" }, table(run)),
        h("div", { class: "pair" }, gradingCurve(run), formDiagram(run)),
      ),
    ),
  );
}

function samplesOf(run: Run, measure: number): Sample[] {
  return run.text.shapes.map((shape) => ({ value: shape.measures[measure], weight: shape.grains }));
}

function table(run: Run): HTMLElement {
  const heads = ["", "mean", "deviation", "least", "10 %", "median", "90 %", "most"];
  return h(
    "table",
    {},
    h(
      "caption",
      {},
      `${run.text.shapes.filter(({ grains }) => grains > 0).length} shapes, counted by grains`,
    ),
    h("thead", {}, h("tr", {}, ...heads.map((head) => h("th", { scope: "col" }, head)))),
    h(
      "tbody",
      {},
      ...run.text.measures.map((name, n) => {
        const spread = spreadOf(samplesOf(run, n));
        const [label, unit] = splitUnit(name);
        const scale = scaled(spread.high, unit);
        const cells = [
          spread.mean,
          spread.deviation,
          spread.low,
          spread.tenth,
          spread.median,
          spread.ninetieth,
          spread.high,
        ];
        return h(
          "tr",
          {},
          h("th", { scope: "row" }, (words[label] ?? label) + (scale.unit ? ` [${scale.unit}]` : "")),
          ...cells.map((value) => h("td", {}, number(value * scale.factor, 3))),
        );
      }),
    ),
  );
}

const space = "http://www.w3.org/2000/svg";
function svg(tag: string, attributes: Record<string, string | number>, text?: string): SVGElement {
  const element = document.createElementNS(space, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  if (text !== undefined) element.textContent = text;
  return element;
}

interface Frame {
  x: [number, number];
  y: [number, number];
  xLabel: string;
  yLabel: string;
  ticksX: number[];
  ticksY: number[];
}

/** A small plot; `draw` gets the places of values. */
function smallPlot(
  title: string,
  frame: Frame,
  draw: (x: (value: number) => number, y: (value: number) => number) => SVGElement[],
): HTMLElement {
  const [left, top, width, height] = [46, 10, 240, 190];
  const x = (value: number) => left + ((value - frame.x[0]) / (frame.x[1] - frame.x[0])) * width;
  const y = (value: number) => top + height - ((value - frame.y[0]) / (frame.y[1] - frame.y[0])) * height;
  const picture = svg("svg", { viewBox: "0 0 300 250", role: "img", "aria-label": title, class: "small" });
  for (const tick of frame.ticksX) {
    picture.append(svg("path", { d: `M${x(tick)} ${top}V${top + height}`, class: "grid" }));
    picture.append(
      svg("text", { x: x(tick), y: top + height + 16, "text-anchor": "middle" }, number(tick, 3)),
    );
  }
  for (const tick of frame.ticksY) {
    picture.append(svg("path", { d: `M${left} ${y(tick)}H${left + width}`, class: "grid" }));
    picture.append(svg("text", { x: left - 6, y: y(tick) + 4, "text-anchor": "end" }, number(tick, 3)));
  }
  picture.append(
    svg("text", { x: left + width / 2, y: 246, "text-anchor": "middle" }, frame.xLabel),
    svg(
      "text",
      { transform: `translate(11 ${top + height / 2}) rotate(-90)`, "text-anchor": "middle" },
      frame.yLabel,
    ),
    ...draw(x, y),
  );
  return h("figure", {}, h("figcaption", {}, title), picture as unknown as HTMLElement);
}

/** Round numbers across a range, about `count` of them. */
export function roundTicks(low: number, high: number, count: number): number[] {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough) ?? rough;
  const ticks: number[] = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; ++n) {
    ticks.push(Number((n * step).toPrecision(12)));
  }
  return ticks;
}

/** Passing by mass over sieve size, as laboratories draw it. */
function gradingCurve(run: Run): HTMLElement {
  const measure = run.text.measures.indexOf("sieve_size_m");
  const grains = run.text.shapes
    .filter((shape) => shape.grains > 0)
    .map((shape) => ({ size: shape.measures[measure], mass: shape.grains * shape.volume }))
    .sort((a, b) => a.size - b.size);
  const total = grains.reduce((sum, { mass }) => sum + mass, 0);
  const scale = scaled(grains[grains.length - 1].size, "m");
  const sizes = grains.map(({ size }) => size * scale.factor);
  const room = 0.06 * (sizes[sizes.length - 1] - sizes[0]) || 0.1 * sizes[0];
  const range: [number, number] = [sizes[0] - room, sizes[sizes.length - 1] + room];
  return smallPlot(
    "Grading",
    {
      x: range,
      y: [0, 100],
      xLabel: `sieve size [${scale.unit}]`,
      yLabel: "passing by mass [%]",
      ticksX: roundTicks(range[0], range[1], 5),
      ticksY: [0, 20, 40, 60, 80, 100],
    },
    (x, y) => {
      let passing = 0;
      let path = `M${x(range[0])} ${y(0)}H${x(sizes[0])}`;
      grains.forEach(({ mass }, n) => {
        passing += (100 * mass) / total;
        path += `H${x(sizes[n])}V${y(passing)}`;
      });
      path += `H${x(range[1])}`;
      return [svg("path", { d: path, fill: "none", stroke: hues[0], "stroke-width": 1.8 })];
    },
  );
}

/** Flatness over elongation (Zingg 1935): a point per shape, as large as it is frequent. */
function formDiagram(run: Run): HTMLElement {
  const elongation = run.text.measures.indexOf("elongation");
  const flatness = run.text.measures.indexOf("flatness");
  const shapes = run.text.shapes.filter((shape: ShapeText) => shape.grains > 0);
  const most = Math.max(...shapes.map(({ grains }) => grains));
  return smallPlot(
    "Form (Zingg)",
    {
      x: [0.3, 1],
      y: [0.3, 1],
      xLabel: "flatness, thickness / width",
      yLabel: "elongation, width / length",
      ticksX: [0.4, 0.6, 0.8, 1],
      ticksY: [0.4, 0.6, 0.8, 1],
    },
    (x, y) => [
      svg("path", { d: `M${x(2 / 3)} ${y(0.3)}V${y(1)}M${x(0.3)} ${y(2 / 3)}H${x(1)}`, class: "mark" }),
      ...shapes.map((shape) => {
        const point = svg("circle", {
          cx: x(Math.max(shape.measures[flatness], 0.3)),
          cy: y(Math.max(shape.measures[elongation], 0.3)),
          r: 1.6 + 2.4 * Math.sqrt(shape.grains / most),
          fill: hues[0],
          "fill-opacity": 0.55,
        });
        point.append(svg("title", {}, `${shape.name}: ${whole(shape.grains)} grains`));
        return point;
      }),
    ],
  );
}
