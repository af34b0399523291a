// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { colourMap, gradient } from "../colours.ts";
import type { Frame } from "../data/frame.ts";
import type { Run } from "../data/run.ts";
import { chooser, fillChoices, h, replace } from "../dom.ts";
import { number, quantity, scaled, whole } from "../format.ts";
import { colourRange, displacement, quantitiesOf, type Quantity, rotation } from "./quantities.ts";
import { type Axis, GrainView, type GrainStyle } from "./view.ts";

/** The three-dimensional view with its controls, the slider over saved times, and the picked grain. */
export class GrainSection {
  readonly element = h("section", { id: "view" });
  /** Called with the run and the step that are shown. */
  shown: (run: Run, step: number) => void = () => {};

  private run: Run;
  private frame: Frame | null = null;
  private start: Frame | null = null;
  private frameNumber = 0;
  private readonly quantities: Quantity[];
  private quantity: Quantity;
  private map = "viridis";
  private held: [number, number] | null = null;
  private selectedId: number | null = null;
  private slice: { axis: Axis | "none"; place: number; flipped: boolean } = {
    axis: "none",
    place: 0.5,
    flipped: false,
  };
  private chains = false;
  private playing = 0;
  private wanted = 0;

  private readonly canvas = h("canvas", {
    tabindex: 0,
    role: "img",
    "aria-label":
      "Grains in three dimensions. Arrow keys turn, plus and minus zoom, Enter picks the grain in the middle.",
  });
  private readonly view: GrainView;
  private readonly legend = h("div", { class: "colours" });
  private readonly slider = h("input", { type: "range", min: 0, step: 1, "aria-label": "Saved time" });
  private readonly time = h("output", { class: "time" });
  private readonly play = h("button", { type: "button", class: "play", "aria-label": "Play" }, "▶");
  private readonly since = h("select", {
    onchange: () => void this.countFrom(Number(this.since.value)),
  });
  private readonly picked = h("div", { class: "picked", "aria-live": "polite" });
  private readonly sliceSlider = h("input", {
    type: "range",
    min: 0,
    max: 1,
    step: 0.005,
    value: 0.5,
    "aria-label": "Place of the slicing plane",
    disabled: true,
  });
  private readonly membraneBox = h("input", {
    type: "checkbox",
    checked: true,
    onchange: () => this.view.showMembrane(this.membraneBox.checked),
  });
  private readonly membraneField = h("label", { class: "field" }, h("span", {}, "Membrane"), this.membraneBox);
  private readonly note = h("p", { class: "hint" });

  constructor(private runs: Run[]) {
    this.run = runs[0];
    this.quantities = quantitiesOf(this.run.text.fields);
    this.quantity = this.quantities[0];
    this.view = new GrainView(this.canvas);
    this.view.picked = (row) => this.pick(row);
    this.slider.addEventListener("input", () => void this.show(Number(this.slider.value)));
    this.play.addEventListener("click", () => this.togglePlay());
    this.sliceSlider.addEventListener("input", () => {
      this.slice.place = Number(this.sliceSlider.value);
      this.applySlice();
    });
    this.element.append(
      h("h2", {}, "Grains"),
      h(
        "div",
        { class: "stage" },
        h(
          "div",
          {},
          h("div", { class: "screen" }, this.canvas, this.legend),
          h("div", { class: "timeline" }, this.play, this.slider, this.time),
        ),
        h("div", { class: "side" }, this.controls(), this.picked),
      ),
      this.note,
    );
    this.showPicked();
  }

  async open(): Promise<void> {
    await this.setRun(this.run);
  }

  /** New frames of the same run; stays at the latest where it stood there. */
  async update(runs: Run[]): Promise<void> {
    const last = this.frameNumber >= this.run.text.frames.length - 1;
    const step = this.run.text.frames[this.frameNumber];
    this.runs = runs;
    this.run = runs[this.runs.findIndex((run) => run.number === this.run.number)] ?? runs[0];
    const frames = this.run.text.frames;
    if (frames.length === 0) return;
    this.fillOrigins(this.since.value);
    this.start = await this.run.frame(Number(this.since.value));
    this.view.setRun(this.run);
    this.slider.max = String(frames.length - 1);
    this.fillNote();
    await this.show(last ? frames.length - 1 : Math.max(frames.indexOf(step), 0));
  }

  private async setRun(run: Run): Promise<void> {
    this.run = run;
    this.selectedId = null;
    const frames = run.text.frames;
    this.fillNote();
    this.element.classList.toggle("empty", frames.length === 0);
    if (frames.length === 0) return;
    this.view.setRun(run);
    this.fillOrigins(null);
    this.start = await run.frame(Number(this.since.value));
    this.slider.max = String(frames.length - 1);
    await this.show(frames.length - 1);
    this.view.lookAt("oblique");
    this.showPicked();
  }

  /** Displacements count from the start, or from the saved time at which a stage began. */
  private fillOrigins(chosen: string | null): void {
    const { history, text } = this.run;
    const origins = [{ value: "0", label: "the start" }];
    for (let stage = 2; stage <= text.stages.length; ++stage) {
      const [first, end] = history.stageRows(stage);
      if (!history.has("stage") || first >= end || first === 0) continue;
      const begin = history.column("step")[first - 1]; // the last row of the stage before
      const frame = nearestTo(text.frames, begin);
      if (frame > 0) origins.push({ value: String(frame), label: `stage ${stage}, ${text.stages[stage - 1]}` });
    }
    const known = chosen !== null && origins.some(({ value }) => value === chosen);
    fillChoices(this.since, origins, known ? chosen : origins[origins.length - 1].value);
  }

  private async countFrom(n: number): Promise<void> {
    this.start = await this.run.frame(n);
    this.colour();
    this.showPicked();
  }

  private fillNote(): void {
    const { text } = this.run;
    const notes: string[] = [];
    if (text.frames.length === 0) notes.push("This run has saved no grains yet.");
    if (text.frames.length < text.saved_frames) {
      notes.push(`${text.frames.length} of ${text.saved_frames} saved times are shown.`);
    }
    if (text.shapes_missing) {
      notes.push(`Grains are drawn as spheres of equal volume: ${text.shapes_missing}`);
    }
    if (text.cell) notes.push("The dashed box is the periodic cell; displacements follow a grain across its border.");
    notes.push("Drag to turn, wheel to zoom, right-drag to move, click a grain for its numbers.");
    replace(this.note, notes.join(" "));
  }

  private async show(n: number): Promise<void> {
    const frames = this.run.text.frames;
    const at = Math.min(Math.max(n, 0), frames.length - 1);
    this.slider.value = String(at);
    this.wanted = at;
    const run = this.run;
    const frame = await run.frame(at);
    if (run !== this.run || at !== this.wanted) return; // a newer request came meanwhile
    this.frameNumber = at;
    this.frame = frame;
    this.membraneField.hidden = !run.text.walls.some(({ mould }) => mould);
    this.view.setFrame(frame);
    this.colour();
    this.showChains();
    this.view.select(this.selectedId === null ? -1 : frame.rowOf(this.selectedId));
    this.showPicked();
    const stamp = `t = ${quantity(frame.time, "s", 4)}`;
    replace(this.time, stamp, h("small", {}, ` step ${whole(frame.step)}`));
    this.slider.setAttribute("aria-valuetext", stamp);
    this.element.dataset.step = String(frame.step);
    this.shown(run, frame.step);
  }

  private togglePlay(): void {
    if (this.playing) {
      window.clearTimeout(this.playing);
      this.playing = 0;
    } else {
      const next = async () => {
        const count = this.run.text.frames.length;
        await this.show((this.frameNumber + 1) % count);
        const rest = this.frameNumber === count - 1 ? 1200 : 120;
        if (this.playing) this.playing = window.setTimeout(next, rest);
      };
      this.playing = window.setTimeout(next, 0);
    }
    this.play.textContent = this.playing ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  private controls(): HTMLElement {
    const styles: [GrainStyle, string][] = [
      ["solid", "solid"],
      ["faint", "faint"],
      ["hidden", "hidden"],
    ];
    const style = chooser(
      "Grains",
      styles.map(([value, label]) => ({ value, label })),
      "solid",
      (value) => this.view.setStyle(value as GrainStyle),
    );
    const chains = h("input", {
      type: "checkbox",
      onchange: () => {
        this.chains = chains.checked;
        const select = style.querySelector("select");
        // Chains lie inside of grains, so these have to give way.
        if (select && this.chains && select.value === "solid") {
          select.value = "faint";
          this.view.setStyle("faint");
        }
        this.showChains();
      },
    });
    const hold = h("input", {
      type: "checkbox",
      onchange: () => {
        this.held = hold.checked ? this.range() : null;
        this.colour();
      },
    });
    const flip = h("input", {
      type: "checkbox",
      onchange: () => {
        this.slice.flipped = flip.checked;
        this.applySlice();
      },
    });
    const find = h("input", {
      type: "number",
      min: 0,
      placeholder: "id",
      "aria-label": "Number of a grain",
      onchange: () => this.pick(this.frame?.rowOf(Number(find.value)) ?? -1),
    });
    const looks: [Axis | "oblique", string][] = [
      ["oblique", "whole"],
      ["x", "x"],
      ["y", "y"],
      ["z", "z"],
    ];
    return h(
      "div",
      { class: "controls column" },
      this.runs.length > 1 &&
        chooser(
          "Run",
          this.runs.map((run, n) => ({ value: String(n), label: run.text.name })),
          "0",
          (value) => void this.setRun(this.runs[Number(value)]),
        ),
      chooser(
        "Colour by",
        this.quantities.map(({ id, short }) => ({ value: id, label: short })),
        this.quantity.id,
        (value) => {
          this.quantity = this.quantities.find(({ id }) => id === value) ?? this.quantities[0];
          this.held = null;
          hold.checked = false;
          this.colour();
        },
      ),
      chooser(
        "Colours",
        ["viridis", "cividis", "gray"].map((value) => ({ value, label: value })),
        this.map,
        (value) => {
          this.map = value;
          this.colour();
          this.showChains();
        },
      ),
      h("label", { class: "field" }, h("span", {}, "Counted from"), this.since),
      h("label", { class: "field" }, h("span", {}, "Hold the range"), hold),
      style,
      h("label", { class: "field" }, h("span", {}, "Contact forces"), chains),
      this.membraneField,
      chooser(
        "Slice",
        ["none", "x", "y", "z"].map((value) => ({ value, label: value === "none" ? "none" : `across ${value}` })),
        "none",
        (value) => {
          this.slice.axis = value as Axis | "none";
          this.sliceSlider.disabled = value === "none";
          this.applySlice();
        },
      ),
      h("label", { class: "field" }, h("span", {}, "at"), this.sliceSlider),
      h("label", { class: "field" }, h("span", {}, "other side"), flip),
      h("label", { class: "field" }, h("span", {}, "Grain"), find),
      h(
        "div",
        { class: "field" },
        h("span", {}, "Look along"),
        h(
          "span",
          { class: "buttons" },
          ...looks.map(([value, label]) =>
            h("button", { type: "button", onclick: () => this.view.lookAt(value) }, label),
          ),
        ),
      ),
    );
  }

  private values(): Float32Array {
    if (!this.frame || !this.start) return new Float32Array();
    return this.quantity.of(this.frame, this.start);
  }
  private range(): [number, number] {
    return this.held ?? colourRange(this.values());
  }

  private colour(): void {
    const { frame, quantity } = this;
    if (!frame) return;
    const without = quantity.needsContacts && !frame.hasContacts;
    const values = this.values();
    const [low, high] = this.range();
    const map = colourMap(this.map);
    this.view.setColours((row) => (without ? map(Number.NaN) : map((values[row] - low) / (high - low))));
    const scale = scaled(Math.max(Math.abs(low), Math.abs(high)), quantity.unit);
    const tick = (share: number) => {
      const value = (low + share * (high - low)) * scale.factor;
      return h("span", {}, quantity.whole ? number(Math.round(value), 3) : number(value, 3));
    };
    replace(
      this.legend,
      h("div", { class: "title" }, quantity.label, scale.unit ? ` [${scale.unit}]` : ""),
      without
        ? h("div", {}, "This run has not saved its contacts.")
        : h("div", { class: "bar", style: `background:${gradient(this.map)}` }),
      !without && h("div", { class: "ticks" }, tick(0), tick(0.5), tick(1)),
    );
  }

  private showChains(): void {
    const frame = this.frame;
    if (!frame || !this.chains) {
      this.view.setChains(null);
      return;
    }
    let sum = 0;
    let size = 0;
    for (let c = 0; c < frame.contacts; ++c) sum += frame.forceOf(c);
    for (let row = 0; row < frame.grains; ++row) size += frame.equivalentRadius[row];
    const mean = sum / Math.max(frame.contacts, 1) || 1;
    const radius = size / Math.max(frame.grains, 1);
    const map = colourMap(this.map);
    // The area of a bar goes with the force; what carries three times the mean has the last colour.
    this.view.setChains(
      (c) => 0.13 * radius * Math.sqrt(Math.min(frame.forceOf(c) / mean, 12)),
      (c) => map(0.92 * Math.min(frame.forceOf(c) / (3 * mean), 1)),
    );
  }

  private applySlice(): void {
    const { axis, place, flipped } = this.slice;
    this.view.setSlice(axis === "none" ? null : { axis, place, flipped });
  }

  private pick(row: number): void {
    this.selectedId = this.frame && row >= 0 ? this.frame.id[row] : null;
    this.view.select(row);
    this.showPicked();
  }

  private showPicked(): void {
    const { frame, start } = this;
    const row = frame && this.selectedId !== null ? frame.rowOf(this.selectedId) : -1;
    this.picked.dataset.grain = row >= 0 ? String(this.selectedId) : "";
    if (!frame || !start || row < 0) {
      replace(this.picked, h("p", { class: "hint" }, "No grain is picked."));
      return;
    }
    const at = (vectors: Float32Array, unit: string) => {
      const size = Math.max(...[0, 1, 2].map((k) => Math.abs(vectors[3 * row + k])));
      const scale = scaled(size, unit);
      return `${[0, 1, 2].map((k) => number(vectors[3 * row + k] * scale.factor, 3)).join(", ")} ${scale.unit}`;
    };
    let largest = 0;
    for (let c = 0; c < frame.contacts; ++c) {
      const touches =
        frame.ends[2 * c] === row || (c < frame.pairs && frame.ends[2 * c + 1] === row);
      if (touches) largest = Math.max(largest, frame.forceOf(c));
    }
    const shape = this.run.text.shapes[frame.shape[row]];
    const rows: [string, string][] = [
      ["Shape", shape ? shape.name : `number ${frame.shape[row]}`],
      ["Diameter", quantity(2 * frame.equivalentRadius[row], "m")],
      ["Position", at(frame.position, "m")],
      ["Displacement", quantity(displacement(frame, start, row), "m")],
      ["Rotation", quantity(rotation(frame, start, row), "°")],
    ];
    for (const { name, unit, components } of this.run.text.fields) {
      const saved = frame.field(name);
      if (!saved) continue;
      const title = name.charAt(0).toUpperCase() + name.slice(1).replaceAll("_", " ");
      rows.push([title, components === 3 ? at(saved, unit) : quantity(saved[row], unit)]);
    }
    if (frame.hasContacts) {
      const { mean, deviator } = frame.stress();
      rows.push(
        ["Largest contact force", quantity(largest, "N")],
        ["Mean stress", quantity(mean[row], "Pa")],
        ["Deviator", quantity(deviator[row], "Pa")],
      );
    }
    replace(
      this.picked,
      h("h3", {}, `Grain ${this.selectedId}`),
      h("dl", {}, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
    );
  }
}

/** The place of the number nearest to `wanted` in an ascending list. */
function nearestTo(numbers: readonly number[], wanted: number): number {
  let best = 0;
  numbers.forEach((value, n) => {
    if (Math.abs(value - wanted) < Math.abs(numbers[best] - wanted)) best = n;
  });
  return best;
}
