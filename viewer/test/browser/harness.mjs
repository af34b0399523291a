// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the tests in a browser share: small runs, a headless Chromium, and eyes for pictures.
import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { chromium } from "playwright-core";

export const program = process.env.RECKON_PROGRAM ?? "reckon";
/** Pictures for the documents go here. */
export const pictures = process.env.RECKON_PICTURES ?? "";

const browsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
export const browserPath = process.env.CHROMIUM ?? browsers.find((file) => existsSync(file)) ?? "";

export function reckon(folder, ...args) {
  return execFileSync(program, args, {
    cwd: folder,
    encoding: "utf8",
    env: { ...process.env, OMP_WAIT_POLICY: "passive" },
  });
}

/** Sixty grains are brought together from all sides and then pressed from two. */
export function pressedScene({ friction = 0.5, grains = 60, title = "Sixty grains are pressed" } = {}) {
  return `title = "${title}"
seed = 3
[material]
friction = ${friction}
[contact]
law = "area"
normal_stiffness = "2e12 N/m^3"
restitution = 0.3
[body]
damping = 200
[[grains]]
library = "sand.h5"
[grains.fill]
count = ${grains}
box = { low = [0, 0, 0], high = ["10 mm", "10 mm", "12 mm"] }
[[wall]]
name = "box"
box = { low = [0, 0, 0], high = ["10 mm", "10 mm", "12 mm"] }
friction = 0
[[stage]]
name = "gather"
steps = 3500
control = [{ wall = "box", strain_rate = 530 }]
[[stage]]
name = "press"
steps = 3500
control = [{ wall = "box.x", stress = "100 kPa" }, { wall = "box.y", stress = "100 kPa" }, { wall = "box.z", strain_rate = 150 }]
[time]
step_fraction = 0.3
[output]
history_interval = 50
fields_interval = 500
sample = true
`;
}

/** A folder with a library and runs of these scenes, by name; removed by `remove`. */
export function makeRuns(scenes) {
  const folder = mkdtempSync(path.join(tmpdir(), "viewer-runs-"));
  reckon(folder, "grains", "generate", "--count", "8", "--seed", "7", "--d50", "1mm", "-o", "sand.h5");
  for (const [name, { scene, steps }] of Object.entries(scenes)) {
    writeFileSync(path.join(folder, `${name}.toml`), scene);
    reckon(folder, "run", `${name}.toml`, "--threads", "1", ...(steps ? ["--steps", String(steps)] : []));
  }
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/** Chromium without a screen, which draws by software where there is no graphics card. */
export function launch() {
  return chromium.launch({
    executablePath: browserPath,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

/** Opens a page and records its errors and its network requests. */
export async function open(browser, url, { width = 1280, height = 900 } = {}) {
  const page = await browser.newPage({ viewport: { width, height }, acceptDownloads: true });
  page.setDefaultTimeout(120000); // pictures without a graphics card take seconds
  const faults = [];
  const requests = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") faults.push(message.text());
  });
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(url);
  await page.waitForSelector("html[data-ready]");
  await page.addStyleTag({ content: ":root { scroll-behavior: auto !important }" });
  await settled(page);
  return { page, faults, requests };
}

/** Waits until the three-dimensional view has drawn its last update. */
export async function settled(page) {
  let before = "";
  for (let tries = 0; tries < 100; ++tries) {
    const { drawn = null, busy } = await page
      .locator("#view canvas")
      .evaluate((canvas) => ({ drawn: canvas.dataset.drawn, busy: canvas.dataset.busy === "true" }));
    if (drawn !== null && drawn === before && !busy) return;
    before = drawn ?? "";
    await page.waitForTimeout(400);
  }
}

/** The pixels of an element, as the browser decodes its own picture of it. */
export async function pixels(page, selector) {
  const picture = await page.locator(selector).screenshot();
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const background = [data[0], data[1], data[2]];
    const colours = new Set();
    let covered = 0;
    let hash = 0;
    for (let n = 0; n < data.length; n += 4) {
      const away = Math.max(...[0, 1, 2].map((k) => Math.abs(data[n + k] - background[k])));
      if (away > 12) ++covered;
      colours.add(((data[n] >> 4) << 8) | ((data[n + 1] >> 4) << 4) | (data[n + 2] >> 4));
      hash = (Math.imul(hash, 31) + data[n] + 256 * data[n + 1] + 65536 * data[n + 2]) | 0;
    }
    return { share: (4 * covered) / data.length, colours: colours.size, hash };
  }, picture.toString("base64"));
}
