// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// `reckon watch`: the page follows a run, and nothing else can be read through it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import http from "node:http";
import net from "node:net";
import { networkInterfaces } from "node:os";
import { after, before, test } from "node:test";
import { launch, makeRuns, open, pressedScene, program, reckon } from "./harness.mjs";

let browser;
let runs;
let server;
let port;
let home; // the path of the page, with the token

before(async () => {
  runs = makeRuns({ live: { scene: pressedScene(), steps: 1500 } });
  server = spawn(program, ["watch", "live.run"], { cwd: runs.folder, stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  while (!said.includes("\n")) said += await once(server.stdout, "data");
  const address = /http:\/\/127\.0\.0\.1:(\d+)(\/[0-9a-f]{32}\/)/.exec(said);
  port = Number(address[1]);
  home = address[2];
  browser = await launch();
});
after(async () => {
  await browser?.close();
  if (server && server.exitCode === null) {
    server.kill("SIGINT");
    await once(server, "exit");
  }
  runs?.remove();
});

/** The status of a request whose path goes out as it is written. */
function status(path, { method = "GET", headers = {} } = {}) {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: "127.0.0.1", port, path, method, headers }, (answer) => {
      let text = "";
      answer.on("data", (chunk) => {
        text += chunk;
      });
      answer.on("end", () => resolve({ code: answer.statusCode, text }));
    });
    request.on("error", reject);
    request.end();
  });
}

test("only the page and the run's pieces are served", async () => {
  for (const path of ["", "version", "piece/0/head", "piece/0/frame/500"]) {
    assert.equal((await status(home + path)).code, 200, path);
    assert.equal((await status(`/${path}`)).code, 403, `${path}, without the token`);
    assert.equal((await status(`/${"0".repeat(32)}/${path}`)).code, 403, `${path}, by a wrong token`);
  }
  for (const path of [
    "scene.toml",
    "live.run/history.csv",
    "../sand.h5",
    "..%2fsand.h5",
    "piece/0/frame/../../../etc/passwd",
    "piece/0/frame/..%2f..%2fscene.toml",
    "piece/0/frame/501",
    "piece/0/frame/-1",
    "piece/0/frame/99999999999999999999",
    "piece/1/head",
    "/etc/passwd",
    "%00",
  ]) {
    const answer = await status(home + path);
    assert.ok(answer.code === 404 || answer.code === 400, `${path}: ${answer.code}`);
    assert.ok(!answer.text.includes("root:") && !answer.text.includes("[material]"), path);
  }
});

test("it is read-only, and answers only to this machine's names", async () => {
  for (const method of ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"]) {
    assert.ok((await status(home, { method })).code >= 400, method);
  }
  assert.equal((await status(`${home}version`, { headers: { Host: "elsewhere.example" } })).code, 421);
  assert.equal((await status(`${home}version`, { headers: { Host: `localhost:${port}` } })).code, 200);
});

test("nobody holds it up, and what they send is bounded", async () => {
  const slow = [];
  for (let n = 0; n < 200; ++n) {
    const socket = net.connect({ host: "127.0.0.1", port });
    socket.on("error", () => {}); // it may be dropped
    socket.write("GET / HT");
    slow.push(socket);
  }
  assert.equal((await status(`${home}version`)).code, 200);
  for (const socket of slow) socket.destroy();
  const { code } = await status(`${home}version`, { headers: { Long: "x".repeat(12000) } });
  assert.equal(code, 431);
});

test("it listens on the loopback interface alone", async () => {
  const others = Object.values(networkInterfaces())
    .flat()
    .filter(({ internal, family }) => !internal && family === "IPv4");
  for (const { address } of others) {
    const reached = await new Promise((resolve) => {
      const socket = net.connect({ host: address, port, timeout: 2000 });
      socket.on("connect", () => resolve(true));
      socket.on("error", () => resolve(false));
      socket.on("timeout", () => resolve(false));
    });
    assert.ok(!reached, `reached through ${address}`);
  }
});

test("the page shows the run and follows it", async () => {
  const { page, faults } = await open(browser, `http://127.0.0.1:${port}${home}`);
  assert.match(await page.locator("header").innerText(), /live/i);
  assert.equal(await page.locator("#view").getAttribute("data-step"), "1500");
  reckon(runs.folder, "run", "live.toml", "--threads", "1", "--resume", "--steps", "3000");
  await page.waitForSelector('#view[data-step="3000"]');
  assert.match((await page.locator("#summary").innerText()).replaceAll("\u202f", ""), /Steps\s+3000/);
  assert.deepEqual(faults, []);
  await page.close();
});

test("Ctrl-C ends it", async () => {
  server.kill("SIGINT");
  const [code] = await once(server, "exit");
  assert.equal(code, 0);
});
