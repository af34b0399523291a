// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Run } from "../data/run.ts";
import { h } from "../dom.ts";
import { duration, number, quantity, whole } from "../format.ts";

interface Row {
  label: string;
  value(run: Run): string;
}

const last = (name: string, unit: string, factor = 1) => (run: Run) =>
  run.history.has(name) ? quantity(factor * run.history.last(name), unit) : "";

const rows: Row[] = [
  { label: "Status", value: (run) => run.record.status ?? "" },
  { label: "Grains", value: (run) => whole(run.history.last("grains") || run.record.grains || Number.NaN) },
  { label: "Shapes", value: (run) => (run.record.shapes ? whole(run.record.shapes) : "") },
  {
    label: "Steps",
    value: (run) => {
      const { step, steps, status } = run.record;
      if (step === undefined) return "";
      return status === "running" && steps ? `${whole(step)} of at most ${whole(steps)}` : whole(step);
    },
  },
  { label: "Simulated", value: (run) => (run.record.time_s ? quantity(run.record.time_s, "s") : "") },
  { label: "Time step", value: (run) => (run.record.time_step_s ? quantity(run.record.time_step_s, "s") : "") },
  {
    label: "Wall time, last session",
    value: (run) => (run.record.session ? duration(Number(run.record.session.wall_s)) : ""),
  },
  { label: "Void ratio", value: last("void_ratio", "") },
  { label: "Mean stress", value: last("mean_stress_Pa", "Pa") },
  { label: "Coordination", value: last("coordination", "") },
  { label: "Unbalanced ratio", value: last("unbalanced_ratio", "") },
  {
    label: "Energy unaccounted for",
    value: (run) => {
      const { history } = run;
      if (!history.has("balance_error_J")) return "";
      const work = Math.max(
        ...["wall_work_J", "friction_J", "dashpot_J", "damping_J", "elastic_J"].map((name) =>
          Math.abs(history.last(name) || 0),
        ),
      );
      const error = Math.abs(history.last("balance_error_J"));
      return work > 0 ? `${number((100 * error) / work, 2)} % of the largest` : "";
    },
  },
];

/** The most important figures, a column per run. */
export function summary(runs: readonly Run[]): HTMLElement {
  const shown = rows.filter((row) => runs.some((run) => row.value(run) !== ""));
  if (runs.length === 1) {
    return h(
      "section",
      { id: "summary" },
      verdict(runs[0]),
      h(
        "dl",
        { class: "figures" },
        ...shown.map((row) =>
          h("div", {}, h("dt", {}, row.label), h("dd", {}, row.value(runs[0]))),
        ),
      ),
      findings(runs[0]),
    );
  }
  return h(
    "section",
    { id: "summary" },
    ...runs.map((run) => {
      const found = verdict(run);
      return found && h("div", {}, h("h3", {}, run.text.name), found);
    }),
    h(
      "div",
      { class: "scroll" },
      h(
        "table",
        {},
        h(
          "thead",
          {},
          h("tr", {}, h("th", {}), ...runs.map((run) => h("th", { scope: "col" }, run.text.name))),
        ),
        h(
          "tbody",
          {},
          ...shown.map((row) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, row.label),
              ...runs.map((run) => h("td", {}, row.value(run))),
            ),
          ),
        ),
      ),
    ),
    ...runs.map((run) => {
      const found = findings(run);
      return found && h("div", {}, h("h3", {}, run.text.name), found);
    }),
  );
}

/** Why the figures mean nothing, before any of them. */
function verdict(run: Run): HTMLElement | null {
  const text = run.text.verdict ?? "";
  return text ? h("pre", { class: "failure verdict" }, text.trimEnd()) : null;
}

function findings(run: Run): HTMLElement | null {
  const { text } = run;
  if (run.record.message) return h("pre", { class: "failure" }, run.record.message);
  if (!text.findings.trim()) return null;
  return h("pre", { class: "findings" }, text.findings.replace(/\s+$/, "").replaceAll(/^ {2}/gm, ""));
}
