// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { hues } from "../colours.ts";
import type { Performance, RankPerformance, Run } from "../data/run.ts";
import { h } from "../dom.ts";
import { bytes, duration, number, whole } from "../format.ts";

/** Tan and Sitar's phases (2024), with the finer parts of each that the program counts. */
const phases: { name: string; meaning: string; seconds(rank: RankPerformance): number; parts: string[] }[] = [
  {
    name: "force",
    meaning: "pairs, touching nodes and their forces",
    seconds: (rank) => rank.force_s,
    parts: ["lists", "grain_contacts", "wall_contacts"],
  },
  {
    name: "border",
    meaning: "listing ghosts and waiting for their states",
    seconds: (rank) => rank.border_s,
    parts: ["border"],
  },
  {
    name: "migrate",
    meaning: "bringing grains to their owners",
    seconds: (rank) => rank.migrate_s,
    parts: ["migration"],
  },
  {
    name: "update",
    meaning: "sums, motion, and waiting for all ranks to agree",
    seconds: (rank) => rank.update_s,
    parts: ["frames", "loads", "motion", "agreement"],
  },
];

const mean = (values: number[]) => values.reduce((sum, value) => sum + value, 0) / values.length;

export function performanceSection(runs: readonly Run[]): HTMLElement | null {
  const measured = runs.filter((run) => run.performance && run.performance.rank.length > 0);
  if (measured.length === 0) return null;
  return h(
    "section",
    { id: "performance" },
    h("h2", {}, "Performance"),
    ...measured.map((run) => tableOf(run, run.performance as Performance, runs.length > 1)),
  );
}

function tableOf(run: Run, told: Performance, named: boolean): HTMLElement {
  const several = told.rank.length > 1;
  const row = (name: string, meaning: string, times: number[], fine: boolean) => {
    const share = told.wall_s > 0 ? mean(times) / told.wall_s : 0;
    return h(
      "tr",
      { class: fine ? "fine" : "" },
      h("th", { scope: "row" }, name.replaceAll("_", " ")),
      h("td", {}, duration(mean(times))),
      several && h("td", {}, duration(Math.max(...times))),
      h(
        "td",
        { class: "share" },
        h("span", { class: "amount", style: `width:${(100 * share).toFixed(2)}%;background:${fine ? "#a9c7de" : hues[0]}` }),
        h("span", {}, `${number(100 * share, 3)} %`),
      ),
      h("td", { class: "words" }, meaning),
    );
  };
  const memory = Math.max(...told.rank.map((rank) => rank.peak_memory_bytes));
  return h(
    "div",
    { class: "scroll" },
    h(
      "table",
      { class: "performance" },
      h(
        "caption",
        {},
        `${named ? `${run.text.name}: ` : ""}${duration(told.wall_s)} for ${whole(told.steps)} steps of ${whole(told.grains)} grains, ` +
          `${number(told.ns_per_grain_step, 3)} ns per grain and step, ${told.ranks} rank${several ? "s" : ""} of ` +
          `${told.rank[0].threads} thread${told.rank[0].threads === 1 ? "" : "s"}, ${bytes(memory)} per rank at most` +
          (several
            ? `; the busiest rank has ${number(told.work_imbalance, 3)} times the mean work, ${number(told.ghosts_per_grain, 3)} ghosts per grain`
            : ""),
      ),
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", { scope: "col" }, "phase"),
          h("th", { scope: "col" }, several ? "mean of ranks" : "time"),
          several && h("th", { scope: "col" }, "slowest rank"),
          h("th", { scope: "col" }, "share of the wall time"),
          h("th", {}),
        ),
      ),
      h(
        "tbody",
        {},
        ...phases.flatMap((phase) => [
          row(phase.name, phase.meaning, told.rank.map(phase.seconds), false),
          ...(phase.parts.length > 1 ? phase.parts : []).map((part) =>
            row(part, "", told.rank.map((rank) => rank.phase_s[part] ?? 0), true),
          ),
        ]),
        row("output", `waiting for files; ${duration(told.background_output_s)} more were written meanwhile`, [told.output_s], false),
      ),
    ),
  );
}
