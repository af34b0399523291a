// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { History, splitUnit, strainAxis } from "../src/data/history.ts";
import { fromBase64, readPiece } from "../src/data/piece.ts";
import { frameOf, near } from "./frames.ts";

function packed(arrays: object[], bytes: Buffer): Uint8Array<ArrayBuffer> {
  let text = JSON.stringify({ step: 7, arrays });
  while ((text.length + 4) % 8 !== 0) text += " ";
  const head = Buffer.alloc(4);
  head.writeUInt32LE(text.length);
  return new Uint8Array(deflateSync(Buffer.concat([head, Buffer.from(text), bytes])));
}

test("a piece gives back its text and its arrays", async () => {
  const bytes = Buffer.alloc(24);
  bytes.writeDoubleLE(0.1, 0);
  bytes.writeDoubleLE(-3e300, 8);
  bytes.writeInt16LE(-5, 16);
  const piece = await readPiece<{ step: number }>(
    packed(
      [
        { name: "a", type: "Float64", components: 1, offset: 0, count: 2 },
        { name: "b", type: "Int16", components: 1, offset: 16, count: 1 },
      ],
      bytes,
    ),
  );
  assert.equal(piece.text.step, 7);
  assert.deepEqual([...piece.array("a")], [0.1, -3e300]);
  assert.deepEqual([...piece.array("b")], [-5]);
  assert.throws(() => piece.array("c"), /no array "c"/);
});

test("a piece with an unknown type or cut short is refused", async () => {
  const entry = { name: "a", type: "Float16", components: 1, offset: 0, count: 1 };
  await assert.rejects(readPiece(packed([entry], Buffer.alloc(8))), /unknown type Float16/);
  const long = { name: "a", type: "Float64", components: 1, offset: 0, count: 9 };
  await assert.rejects(readPiece(packed([long], Buffer.alloc(8))), RangeError);
  await assert.rejects(readPiece(new Uint8Array([1, 2, 3])));
});

test("base64 is read as bytes", () => {
  assert.deepEqual([...fromBase64(" AP8Q\n")], [0, 255, 16]);
});

test("a column of uniaxial load has the stress of force over area", () => {
  // A cube's worth of volume between two platens a distance of 2 apart, pressed by 10 N.
  const volume = (4 / 3) * Math.PI;
  const frame = frameOf(
    [{ id: 0, position: [0, 0, 0] }],
    [],
    [
      { ends: [0, 0], force: [0, 0, 10], branch: [0, 0, -1] },
      { ends: [0, 1], force: [0, 0, -10], branch: [0, 0, 1] },
    ],
  );
  const { mean, deviator } = frame.stress();
  near(mean[0], 20 / volume / 3);
  near(deviator[0], 20 / volume);
});

test("a pair shares its contact evenly, and shear has no mean stress", () => {
  const volume = (4 / 3) * Math.PI;
  const frame = frameOf(
    [
      { id: 4, position: [0, 0, 0] },
      { id: 9, position: [2, 0, 0] },
    ],
    [{ ends: [0, 1], force: [-6, 0, 0], branch: [2, 0, 0] }],
  );
  const { mean, deviator } = frame.stress();
  for (const row of [0, 1]) {
    near(mean[row], 6 / volume / 3);
    near(deviator[row], 6 / volume);
  }
  assert.deepEqual([frame.rowOf(4), frame.rowOf(9), frame.rowOf(5)], [0, 1, -1]);

  const shear = frameOf(
    [{ id: 0, position: [0, 0, 0] }],
    [],
    [
      { ends: [0, 0], force: [3, 0, 0], branch: [0, 1, 0] },
      { ends: [0, 0], force: [0, 3, 0], branch: [1, 0, 0] },
    ],
  );
  near(shear.stress().mean[0], 0);
  near(shear.stress().deviator[0], (Math.sqrt(3) * 3) / volume);
});

const table = () =>
  new History(
    [
      { name: "step", meaning: "" },
      { name: "stage", meaning: "" },
      { name: "strain_x", meaning: "" },
      { name: "strain_y", meaning: "" },
      { name: "strain_z", meaning: "" },
    ],
    Float64Array.from([
      ...[0, 1, 2, 3, 4],
      ...[1, 1, 2, 2, 3],
      ...[0, 0.1, 0, -0.01, 0],
      ...[0, 0, 0, 0.02, 0],
      ...[0, 0, 0, 0.01, 0.1 + 0.2],
    ]),
  );

test("rows of a stage are found, all of them for stage 0", () => {
  const history = table();
  assert.deepEqual(history.stageRows(1), [0, 2]);
  assert.deepEqual(history.stageRows(2), [2, 4]);
  assert.deepEqual(history.stageRows(4), [5, 5]);
  assert.deepEqual(history.stageRows(0), [0, 5]);
  assert.equal(strainAxis(history, 1), "x");
  assert.equal(strainAxis(history, 2), "y");
  assert.equal(strainAxis(history, 3), "z");
});

test("a table downloaded as CSV reads back as the same bits", () => {
  const lines = table().csv().trimEnd().split("\n");
  assert.equal(lines[0], "step,stage,strain_x,strain_y,strain_z");
  assert.equal(lines.length, 6);
  assert.equal(Number(lines[5].split(",")[4]), 0.1 + 0.2);
});

test("the unit is read from the end of a column's name", () => {
  assert.deepEqual(splitUnit("largest_speed_m_per_s"), ["largest_speed", "m/s"]);
  assert.deepEqual(splitUnit("momentum_x_kg_m_per_s"), ["momentum_x", "kg m/s"]);
  assert.deepEqual(splitUnit("volume_m3"), ["volume", "m³"]);
  assert.deepEqual(splitUnit("box.x-:fx_N"), ["box.x-:fx", "N"]);
  assert.deepEqual(splitUnit("contacts"), ["contacts", ""]);
});
