// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { Run } from "../data/run.ts";
import { h } from "../dom.ts";

/** The scene, what ran it, and the log. */
export function textSection(runs: readonly Run[]): HTMLElement {
  return h(
    "section",
    { id: "scene" },
    h("h2", {}, "Scene and versions"),
    ...runs.map((run) => {
      const { session = {}, program = {} } = run.record;
      const facts: [string, string | number | undefined][] = [
        ["Program", `reckon ${program.version ?? "?"}, revision ${program.revision ?? "?"}`],
        ["Compiler", program.compiler],
        ["Flags", program.flags],
        ["Host", session.host],
        ["Ranks, threads of each", session.ranks ? `${session.ranks}, ${session.threads}` : undefined],
        ["Latest session began", session.started],
      ];
      return h(
        "div",
        { class: "texts" },
        runs.length > 1 && h("h3", {}, run.text.name),
        h(
          "dl",
          { class: "facts" },
          ...facts
            .filter(([, value]) => value !== undefined && value !== "")
            .flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, String(value))]),
        ),
        folded("scene.toml, as given", run.text.scene),
        folded("scene_resolved.toml, with every default", run.text.resolved),
        folded("run.log", run.text.log),
      );
    }),
  );
}

function folded(title: string, text: string): HTMLElement | null {
  if (!text) return null;
  return h("details", {}, h("summary", {}, title), h("pre", {}, text));
}
