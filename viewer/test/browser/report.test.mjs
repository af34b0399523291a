// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// `reckon report` as a reader meets it: opened from disk in a browser.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, renameSync } from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch, makeRuns, open, pictures, pixels, pressedScene, reckon, settled } from "./harness.mjs";

const canvas = "#view canvas";
let browser;
let runs;
let report;

const url = (name) => pathToFileURL(path.join(runs.folder, name)).href;
const field = (page, label, kind) => page.locator(`label:has-text("${label}") ${kind}`).first();

before(async () => {
  runs = makeRuns({
    rough: { scene: pressedScene() },
    smooth: { scene: pressedScene({ friction: 0.1 }) },
    many: {
      scene: pressedScene({ grains: 5000, title: "Five thousand grains" })
        .replaceAll('"10 mm", "10 mm", "12 mm"', '"42 mm", "42 mm", "48 mm"'),
      steps: 20,
    },
    wrapped: {
      scene: readFileSync(new URL("../../../tests/paraview/scene.toml", import.meta.url), "utf8")
        .replace("grains.h5", "sand.h5").replaceAll('"75 mm"', '"90 mm"').replace("surfaces = true, ranks = true, ", ""),
    },
    cell: {
      scene: readFileSync(new URL("../../../tests/paraview/cell.toml", import.meta.url), "utf8").replace("grains.h5", "sand.h5"),
    },
  });
  reckon(runs.folder, "report", "rough.run");
  report = url("rough.run/report.html");
  browser = await launch();
});
after(async () => {
  await browser?.close();
  runs?.remove();
});

test("a report opens from disk without an error and asks nobody for anything", async () => {
  const { page, faults, requests } = await open(browser, report);
  assert.deepEqual(faults, []);
  const outside = requests.filter((request) => !/^(file|data|blob):/.test(request));
  assert.deepEqual(outside, []);
  assert.match(await page.title(), /^Sixty grains are pressed/);
  assert.match(await page.locator("#summary").innerText(), /Status\s+complete/);
  assert.match(await page.locator("#performance").innerText(), /force/);
  assert.match(await page.locator("#scene").innerText(), /Program\s+reckon \d/);
  assert.equal(await page.locator("#shapes tbody tr").count(), 10);
  await page.close();
});

test("grains are drawn, and turning, slicing, colours and contact forces change the picture", async () => {
  const { page, faults } = await open(browser, report);
  const first = await pixels(page, canvas);
  assert.ok(first.share > 0.05, `only ${first.share} of the picture is covered`);
  assert.ok(first.colours > 40, `only ${first.colours} colours`);
  let last = first.hash;
  const changed = async (what) => {
    await settled(page);
    const { hash } = await pixels(page, canvas);
    assert.notEqual(hash, last, `${what} changed nothing`);
    last = hash;
  };
  for (const quantity of ["rotation", "stress", "deviator", "size", "mass", "velocity", "angular_velocity", "contacts", "contact_force"]) {
    await field(page, "Colour by", "select").selectOption(quantity);
    await changed(`colouring by ${quantity}`);
  }
  await field(page, "Colours", "select").selectOption("cividis");
  await changed("another map");
  await field(page, "Slice", "select").selectOption("y");
  await changed("a slice");
  await field(page, "other side", "input").check();
  await changed("the other side of the slice");
  await field(page, "Slice", "select").selectOption("none");
  await field(page, "Contact forces", "input").check();
  await changed("contact forces");
  await field(page, "Grains", "select").selectOption("hidden");
  await changed("hiding the grains");
  assert.deepEqual(faults, []);
  await page.close();
});

test("the slider goes through the saved times", async () => {
  const { page, faults } = await open(browser, report);
  const slider = page.locator('input[aria-label="Saved time"]');
  const last = await slider.getAttribute("max");
  assert.equal(last, "14"); // steps 0 to 7000 by 500
  assert.equal(await page.locator("#view").getAttribute("data-step"), "7000");
  const end = await pixels(page, canvas);
  await slider.focus();
  await page.keyboard.press("Home");
  await page.waitForSelector('#view[data-step="0"]');
  await settled(page);
  assert.notEqual((await pixels(page, canvas)).hash, end.hash);
  await page.keyboard.press("ArrowRight");
  await page.waitForSelector('#view[data-step="500"]');
  await page.locator("button.play").click();
  await page.waitForSelector('#view[data-step="2000"]');
  await page.locator("button.play").click();
  assert.deepEqual(faults, []);
  await page.close();
});

test("a grain is picked by the mouse, by the keyboard and by its number", async () => {
  const { page, faults } = await open(browser, report);
  const picked = page.locator(".picked");
  assert.equal(await picked.getAttribute("data-grain"), "");
  await page.locator(canvas).click();
  const grain = await picked.getAttribute("data-grain");
  assert.match(grain, /^\d+$/);
  const numbers = await picked.innerText();
  for (const word of ["Diameter", "Displacement", "Rotation", "Contacts", "Mean stress"]) {
    assert.ok(numbers.includes(word), word);
  }
  await page.keyboard.press("Escape");
  assert.equal(await picked.getAttribute("data-grain"), "");
  await page.keyboard.press("Enter");
  assert.equal(await picked.getAttribute("data-grain"), grain);
  const before = await pixels(page, canvas);
  for (let n = 0; n < 6; ++n) await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("+");
  await settled(page);
  assert.notEqual((await pixels(page, canvas)).hash, before.hash);
  await page.locator('input[aria-label="Number of a grain"]').fill("17");
  await page.keyboard.press("Enter");
  assert.equal(await picked.getAttribute("data-grain"), "17");
  assert.deepEqual(faults, []);
  await page.close();
});

test("curves show values under the pointer, zoom together, and are read by the keyboard", async () => {
  const { page, faults } = await open(browser, report);
  const charts = await page.locator(".chart").evaluateAll((all) => all.map(({ id }) => id));
  for (const id of ["stress-ratio", "volumetric-strain", "void-ratio", "energy", "coordination", "unbalanced"]) {
    assert.ok(charts.includes(`chart-${id}`), id);
  }
  const plot = page.locator("#chart-stress-ratio .u-over");
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  const values = page.locator("#chart-void-ratio .values");
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 40);
  assert.match(await values.innerText(), /void ratio\s+[\d.]+/);
  const all = (await pixels(page, "#chart-void-ratio .plot")).hash;
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 60, { steps: 5 });
  await page.mouse.up();
  await page.mouse.move(0, 0);
  await page.locator("button", { hasText: "Show all" }).waitFor();
  assert.notEqual((await pixels(page, "#chart-void-ratio .plot")).hash, all);
  await page.locator("button", { hasText: "Show all" }).click();
  await page.locator("#chart-void-ratio .plot").focus();
  for (let n = 0; n < 10; ++n) await page.keyboard.press("ArrowRight");
  const there = await values.innerText();
  await page.keyboard.press("ArrowRight");
  assert.notEqual(await values.innerText(), there);
  await field(page, "Any column", "select").selectOption("touching_nodes");
  await field(page, "Over", "select").selectOption("time");
  await field(page, "Stage", "select").selectOption("0");
  assert.deepEqual(faults, []);
  await page.close();
});

test("the table downloaded as CSV has the numbers of history.csv", async () => {
  const { page } = await open(browser, report);
  const waiting = page.waitForEvent("download");
  await page.locator("button.csv").click();
  const saved = readFileSync(await (await waiting).path(), "utf8");
  const original = readFileSync(path.join(runs.folder, "rough.run", "history.csv"), "utf8");
  const cells = (text) => text.trim().split("\n").map((line) => line.split(","));
  const number = (cell) => (cell === "inf" ? Infinity : Number(cell));
  const [got, wanted] = [cells(saved), cells(original)];
  assert.deepEqual(got[0], wanted[0]);
  assert.deepEqual(got.slice(1).map((row) => row.map(number)), wanted.slice(1).map((row) => row.map(number)));
  await page.close();
});

test("a phone shows all of it without scrolling sideways", async () => {
  const { page, faults } = await open(browser, report, { width: 390, height: 844 });
  const { width, small } = await page.evaluate(() => ({
    width: document.documentElement.scrollWidth,
    small: [...document.querySelectorAll("p, td, th, dd, dt, li, label, button, select")].filter(
      (element) => element.checkVisibility() && Number.parseFloat(getComputedStyle(element).fontSize) < 11.5,
    ).length,
  }));
  assert.ok(width <= 390, `the page is ${width} wide`);
  assert.equal(small, 0, "some text is too small");
  const seen = await pixels(page, canvas);
  assert.ok(seen.share > 0.04);
  await page.locator("#chart-stress-ratio").scrollIntoViewIfNeeded();
  assert.ok((await pixels(page, "#chart-stress-ratio .plot")).colours > 5);
  assert.deepEqual(faults, []);
  await page.close();
});

test("two runs stand on one page", async () => {
  reckon(runs.folder, "report", "rough.run", "smooth.run", "-o", "both.html");
  const { page, faults } = await open(browser, url("both.html"));
  assert.equal(await page.locator("h1").innerText(), "rough.run and smooth.run");
  assert.deepEqual(await page.locator("#chart-stress-ratio .legend li").allInnerTexts(), ["rough.run", "smooth.run"]);
  const first = await pixels(page, canvas);
  await field(page, "Run", "select").selectOption("1");
  await settled(page);
  assert.notEqual((await pixels(page, canvas)).hash, first.hash);
  assert.equal(await page.locator("button.csv").count(), 2);
  assert.deepEqual(faults, []);
  await page.close();
});

test("without its shape library a run is shown as spheres, and says so", async () => {
  const library = path.join(runs.folder, "sand.h5");
  renameSync(library, `${library}.away`);
  try {
    reckon(runs.folder, "report", "smooth.run", "-o", "spheres.html");
  } finally {
    renameSync(`${library}.away`, library);
  }
  const { page, faults } = await open(browser, url("spheres.html"));
  assert.match(await page.locator("#view").innerText(), /drawn as spheres of equal volume/);
  assert.ok((await pixels(page, canvas)).share > 0.05);
  await page.locator(canvas).click();
  assert.match(await page.locator(".picked").getAttribute("data-grain"), /^\d+$/);
  assert.deepEqual(faults, []);
  await page.close();
});

test("a membrane is drawn where it is at each saved time", async () => {
  reckon(runs.folder, "report", "wrapped.run");
  const { page, faults } = await open(browser, url("wrapped.run/report.html"));
  const box = field(page, "Membrane", "input");
  const look = async () => {
    await settled(page);
    const calls = Number(await page.locator(canvas).getAttribute("data-calls"));
    return { calls, ...(await pixels(page, canvas)) };
  };
  const shown = await look();
  await box.uncheck();
  const hidden = await look();
  assert.equal(shown.calls - hidden.calls, 3, "both sides of a skin, and its net");
  assert.notEqual(shown.hash, hidden.hash);
  await box.check();
  await page.locator('input[aria-label="Saved time"]').focus();
  await page.keyboard.press("Home"); // the mould still stands
  await page.waitForSelector('#view[data-step="0"]');
  assert.equal((await look()).calls, hidden.calls);
  const other = await open(browser, report);
  assert.equal(await field(other.page, "Membrane", "input").isVisible(), false);
  assert.deepEqual([...faults, ...other.faults], []);
  await Promise.all([page.close(), other.page.close()]);
});

test("a periodic cell is drawn as a box that shrinks and leans", async () => {
  reckon(runs.folder, "report", "cell.run");
  const { page, faults } = await open(browser, url("cell.run/report.html"));
  assert.match(await page.locator("#view").innerText(), /dashed box is the periodic cell/);
  await field(page, "Colour by", "select").selectOption("size"); // the same at all times, as the legend lies in the picture
  await field(page, "Grains", "select").selectOption("hidden");
  await settled(page);
  assert.equal(await page.locator(canvas).getAttribute("data-calls"), "2", "lines of the box, and of walls that are not there");
  const leaning = await pixels(page, canvas);
  await page.locator('input[aria-label="Saved time"]').focus();
  await page.keyboard.press("Home");
  await page.waitForSelector('#view[data-step="0"]');
  await settled(page);
  assert.notEqual((await pixels(page, canvas)).hash, leaning.hash, "the box has not changed");
  assert.deepEqual(faults, []);
  await page.close();
});

/** Counts the requests of a page to WebGL: draw calls, and bytes of buffers. */
function countWork() {
  const work = { draws: 0, uploads: 0 };
  window.webglWork = work;
  const prototype = WebGL2RenderingContext.prototype;
  const wrap = (name, count) => {
    const original = prototype[name];
    prototype[name] = function (...given) {
      count(given);
      return original.apply(this, given);
    };
  };
  for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"]) {
    wrap(name, () => ++work.draws);
  }
  wrap("bufferData", ([, data]) => (work.uploads += data.byteLength ?? data));
  wrap("bufferSubData", ([, , data]) => (work.uploads += data.byteLength));
}

test("a picture of five thousand grains takes a few calls, and turning hands nothing over", async () => {
  reckon(runs.folder, "report", "many.run");
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  await page.addInitScript(countWork);
  await page.goto(url("many.run/report.html"));
  const atRest = () =>
    page.waitForFunction(
      (selector) => {
        const { detail, triangles } = document.querySelector(selector).dataset;
        return detail === "fine" && Number(triangles) > 1e5;
      },
      canvas,
      { timeout: 120000 },
    );
  await atRest();
  const state = () => page.evaluate((selector) => ({
    ...document.querySelector(selector).dataset,
    ...window.webglWork,
  }), canvas);
  const rest = await state();
  assert.ok(Number(rest.calls) <= 8 + 3, `${rest.calls} draw calls for eight shapes`);
  const box = await page.locator(canvas).boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  const turn = async (from) => {
    for (let n = 0; n < 12; ++n) {
      await page.mouse.move(box.x + from + 5 * n, box.y + 200 + n);
      await page.waitForTimeout(60);
    }
  };
  await turn(200); // finds the detail that keeps pace
  await turn(260);
  const before = await state();
  await turn(320);
  const after = await state();
  const pictures = Number(after.drawn) - Number(before.drawn);
  assert.ok(pictures > 0);
  if (before.detail === after.detail) {
    assert.equal(after.uploads, before.uploads, "buffers were handed over again");
    assert.ok((after.draws - before.draws) / (pictures + 1) <= 8 + 3);
  }
  if (["balls", "blurred"].includes(after.detail)) {
    assert.equal(after.points, "5000");
    assert.equal(after.triangles, "0");
  }
  await page.mouse.up();
  await atRest();
  console.log(`note: 5000 grains: drawn as ${after.detail} in ${after.calls} calls while turning, as ${rest.triangles} triangles in ${rest.calls} calls at rest`);
  await page.close();
});

test("after slow pictures a turning view has half the pixels each way, and all of them at rest", async () => {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  await page.addInitScript(() => {
    const now = performance.now.bind(performance);
    performance.now = () => 1000 * now(); // so that every picture is a slow one
  });
  await page.goto(report);
  await page.waitForSelector("html[data-ready]");
  await settled(page);
  const look = () => page.locator(canvas).evaluate(({ width, height, clientWidth, clientHeight, dataset }) => ({
    width, height, clientWidth, clientHeight, detail: dataset.detail,
  }));
  const rest = await look();
  assert.deepEqual([rest.width, rest.height], [rest.clientWidth, rest.clientHeight]);
  const box = await page.locator(canvas).boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  for (let n = 1; n < 100 && (await look()).detail !== "blurred"; ++n) {
    await page.mouse.move(box.x + 200 + n, box.y + 200);
    await page.waitForTimeout(50);
  }
  await settled(page);
  const turning = await look(); // for as long as the button is held
  assert.equal(turning.detail, "blurred");
  assert.deepEqual([turning.width, turning.height], [rest.width, rest.height].map((size) => Math.floor(size / 2)));
  const blurred = await pixels(page, canvas);
  await page.mouse.up();
  await page.waitForFunction((selector) => document.querySelector(selector).dataset.detail === "fine", canvas);
  await settled(page);
  assert.deepEqual(await look(), rest);
  const sharp = await pixels(page, canvas);
  assert.notEqual(blurred.hash, sharp.hash);
  assert.ok(Math.abs(blurred.share / sharp.share - 1) < 0.25, `grains cover ${blurred.share} and then ${sharp.share} of the picture`);
  await page.close();
});

test("five thousand grains load, draw, turn and are picked", async () => {
  const began = Date.now();
  const { page, faults } = await open(browser, url("many.run/report.html"));
  const ready = Date.now() - began;
  assert.ok((await pixels(page, canvas)).share > 0.1);
  const drawn = async () => Number(await page.locator(canvas).getAttribute("data-drawn"));
  const box = await page.locator(canvas).boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  for (let n = 0; n < 12; ++n) await page.mouse.move(box.x + 200 + 10 * n, box.y + 200);
  const [from, start] = [await drawn(), Date.now()];
  for (let n = 0; n < 40; ++n) {
    await page.mouse.move(box.x + 320 - 5 * n, box.y + 200 + n);
    await page.waitForTimeout(25);
  }
  const rate = (1000 * ((await drawn()) - from)) / (Date.now() - start);
  await page.mouse.up();
  assert.ok(rate > 0);
  await settled(page);
  await page.locator(canvas).click();
  assert.match(await page.locator(".picked").getAttribute("data-grain"), /^\d+$/);
  console.log(`note: 5000 grains: ready after ${ready} ms, ${rate.toFixed(1)} pictures a second by software`);
  assert.deepEqual(faults, []);
  await page.close();
});

test("pictures for the documents", { skip: pictures === "" }, async () => {
  mkdirSync(pictures, { recursive: true });
  const shown = process.env.RECKON_REPORT ? pathToFileURL(process.env.RECKON_REPORT).href : report;
  const { page } = await open(browser, shown, { width: 1280, height: 860 });
  const save = (name) => page.screenshot({ path: path.join(pictures, name) });
  const to = (id) => page.locator(`#${id}`).evaluate((element) => element.scrollIntoView());
  await save("report.png");
  await to("view");
  await field(page, "Contact forces", "input").check();
  await settled(page);
  await save("report-forces.png");
  await field(page, "Contact forces", "input").uncheck();
  await field(page, "Grains", "select").selectOption("solid");
  await field(page, "Colour by", "select").selectOption("rotation");
  await field(page, "Slice", "select").selectOption("y");
  await page.locator(canvas).click();
  await settled(page);
  await save("report-slice.png");
  await to("curves");
  const box = await page.locator("#chart-stress-ratio .u-over").boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  await page.waitForTimeout(200);
  await save("report-curves.png");
  await page.close();
  const cell = process.env.RECKON_CELL_REPORT;
  const boxed = await open(browser, cell ? pathToFileURL(cell).href : url("cell.run/report.html"), { width: 1280, height: 860 });
  await boxed.page.locator("#view").evaluate((element) => element.scrollIntoView());
  await settled(boxed.page);
  await boxed.page.screenshot({ path: path.join(pictures, "report-cell.png") });
  await boxed.page.close();
});
