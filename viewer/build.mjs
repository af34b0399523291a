// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
//   node build.mjs FOLDER
// Bundles src/ into FOLDER/viewer.html, one page without outside parts, and into
// FOLDER/viewer_page.cpp, which holds the same page for the program.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? path.join(here, "..", "build", "viewer");

const bundled = await build({
  entryPoints: [path.join(here, "src", "main.ts")],
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome103", "firefox113", "safari16.4"], // the first with DecompressionStream
  charset: "utf8",
  legalComments: "inline", // the licences of what is bundled stay with it
  loader: { ".css": "text" },
  write: false,
  logLevel: "warning",
});
const script = bundled.outputFiles[0].text.replaceAll("</script", "<\\/script");
const style = (await build({
  entryPoints: [path.join(here, "src", "style.css")],
  bundle: true,
  minify: true,
  write: false,
  logLevel: "warning",
})).outputFiles[0].text;

const template = await readFile(path.join(here, "src", "index.html"), "utf8");
const page = template
  .replace("/*STYLE*/", () => style)
  .replace("/*SCRIPT*/", () => script);

/** The page in string literals that every compiler takes. */
function asCpp(text) {
  const delimiter = "reckon_page";
  if (text.includes(`)${delimiter}"`)) throw new Error(`the page holds )${delimiter}"`);
  const bytes = Buffer.from(text, "utf8");
  const parts = [];
  for (let at = 0; at < bytes.length; ) {
    let end = Math.min(at + 16000, bytes.length);
    while (end < bytes.length && (bytes[end] & 0xc0) === 0x80) --end; // not within a character
    parts.push(`    R"${delimiter}(${bytes.subarray(at, end).toString("utf8")})${delimiter}"`);
    at = end;
  }
  return `// Made by viewer/build.mjs.
#include "reckon/report/page.hpp"

namespace reckon {

std::string_view viewer_page() {
  static const char page[] =
${parts.join("\n")};
  return {page, sizeof page - 1};
}

}  // namespace reckon
`;
}

await mkdir(folder, { recursive: true });
await writeFile(path.join(folder, "viewer.html"), page);
await writeFile(path.join(folder, "viewer_page.cpp"), asCpp(page));
console.log(`${path.join(folder, "viewer.html")}: ${(page.length / 1024).toFixed(0)} kB`);
