// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { ChartSection } from "./charts/section.ts";
import { Run } from "./data/run.ts";
import { pageSource, type Source } from "./data/source.ts";
import { h, replace } from "./dom.ts";
import { GrainSection } from "./grains/section.ts";
import { performanceSection } from "./tables/performance.ts";
import { shapeSection } from "./tables/shapes.ts";
import { summary } from "./tables/summary.ts";
import { textSection } from "./tables/texts.ts";

const pollInterval = 2000; // [ms]

/** The page of some runs. */
class Page {
  private readonly main = document.getElementById("page") as HTMLElement;
  private readonly summary = h("div");
  private readonly tables = h("div");
  private charts: ChartSection | null = null;
  private grains: GrainSection | null = null;

  constructor(private runs: Run[]) {}

  async show(live: boolean): Promise<void> {
    const [first] = this.runs;
    const title =
      this.runs.length > 1
        ? this.runs.map((run) => run.text.name).join(" and ")
        : first.text.title || first.text.name;
    document.title = `${title} – Sand Reckoner`;
    if (first.history.rows > 0) this.charts = new ChartSection(this.runs);
    const links: [string, string][] = [
      ["view", "Grains"],
      ["curves", "Curves"],
      ["shapes", "Shapes"],
      ["performance", "Performance"],
      ["scene", "Scene"],
    ];
    replace(
      this.main,
      h(
        "header",
        {},
        h("p", { class: "brand" }, "Sand Reckoner", live && h("span", { class: "live", id: "live" }, "live")),
        h("h1", {}, title),
        this.runs.length === 1 && first.text.title && h("p", { class: "folder" }, first.text.name),
        h("nav", { "aria-label": "Parts of the page" }, ...links.map(([id, label]) => h("a", { href: `#${id}` }, label))),
      ),
      this.summary,
      this.openGrains(),
      this.charts?.element ?? h("section", { id: "curves" }, h("h2", {}, "Curves"), h("p", {}, "This run has no history yet.")),
      this.tables,
      h("footer", {}, "Made by ", h("code", {}, live ? "reckon watch" : "reckon report"), "."),
    );
    this.fill();
    if (this.grains) {
      this.grains.shown = (run, step) => {
        if (run.number === this.runs[0].number) this.charts?.mark(step);
      };
      await this.grains.open();
    }
  }

  /** The same runs, further on. */
  async update(runs: Run[]): Promise<void> {
    this.runs = runs;
    this.fill();
    this.charts?.update(runs);
    await this.grains?.update(runs);
  }

  private openGrains(): HTMLElement {
    try {
      this.grains = new GrainSection(this.runs);
      return this.grains.element;
    } catch (error) {
      return h(
        "section",
        { id: "view" },
        h("h2", {}, "Grains"),
        h("p", { class: "failure" }, `This browser cannot draw in three dimensions (${reason(error)}).`),
      );
    }
  }

  private fill(): void {
    replace(this.summary, summary(this.runs));
    replace(this.tables, shapeSection(this.runs), performanceSection(this.runs), textSection(this.runs));
  }
}

function reason(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

async function versionOfRun(): Promise<string> {
  const answer = await fetch("version", { cache: "no-store" });
  if (!answer.ok) throw new Error(answer.statusText);
  return answer.text();
}

/** Tests at intervals whether the run has changed since `version`. */
async function follow(source: Source, page: Page, version: string): Promise<void> {
  const light = document.getElementById("live");
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve, pollInterval));
    try {
      const now = await versionOfRun();
      if (now !== version) await page.update([await Run.load(source, 0)]);
      version = now;
      light?.classList.remove("lost");
      document.documentElement.dataset.version = version;
    } catch {
      light?.classList.add("lost"); // the server has ended; it may come back
    }
  }
}

async function start(): Promise<void> {
  const source = pageSource();
  const version = source.live ? await versionOfRun() : "";
  const runs: Run[] = [];
  for (let n = 0; n < source.runs; ++n) runs.push(await Run.load(source, n));
  if (runs.length === 0) throw new Error("this page holds no run");
  const page = new Page(runs);
  await page.show(source.live);
  document.documentElement.dataset.ready = "true";
  if (source.live) void follow(source, page, version);
}

start().catch((error: unknown) => {
  const main = document.getElementById("page");
  if (main) replace(main, h("p", { class: "failure" }, `The run cannot be shown: ${reason(error)}`));
  throw error;
});
