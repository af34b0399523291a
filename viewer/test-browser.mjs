// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
//   RECKON_PROGRAM=... node test-browser.mjs [report | watch]
// Runs the tests in a headless Chromium; exits with 77 where there is none. With
// RECKON_PICTURES=FOLDER it also saves the pictures of the documents, of the reports that
// RECKON_REPORT and, of a run in a periodic cell, RECKON_CELL_REPORT name, or else of its own small runs.
import { spawnSync } from "node:child_process";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { browserPath } from "./test/browser/harness.mjs";

if (!browserPath) {
  console.log("skipped: needs Chromium (tools/install_dependencies.sh test)");
  process.exit(77);
}
const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), "test", "browser");
const parts = process.argv.length > 2 ? process.argv.slice(2) : ["report", "watch"];
const files = parts.map((part) => path.join(folder, `${part}.test.mjs`));
process.exit(spawnSync(process.execPath, ["--test", ...files], { stdio: "inherit" }).status ?? 1);
