// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The number types that a piece may hold. */
export type Numbers =
  | Float32Array
  | Float64Array
  | Int8Array
  | Int16Array
  | Int32Array
  | Uint8Array
  | Uint16Array
  | Uint32Array;

const makers: Record<string, (buffer: ArrayBuffer, offset: number, count: number) => Numbers> = {
  Float32: (buffer, offset, count) => new Float32Array(buffer, offset, count),
  Float64: (buffer, offset, count) => new Float64Array(buffer, offset, count),
  Int8: (buffer, offset, count) => new Int8Array(buffer, offset, count),
  Int16: (buffer, offset, count) => new Int16Array(buffer, offset, count),
  Int32: (buffer, offset, count) => new Int32Array(buffer, offset, count),
  UInt8: (buffer, offset, count) => new Uint8Array(buffer, offset, count),
  UInt16: (buffer, offset, count) => new Uint16Array(buffer, offset, count),
  UInt32: (buffer, offset, count) => new Uint32Array(buffer, offset, count),
};

interface ArrayEntry {
  name: string;
  type: string;
  components: number;
  offset: number;
  count: number;
}

/** A part of a run as the program packed it: JSON text and named arrays (report/piece.hpp). */
export class Piece<Text = Record<string, unknown>> {
  constructor(
    readonly text: Text,
    private readonly arrays: ReadonlyMap<string, Numbers>,
  ) {}

  has(name: string): boolean {
    return this.arrays.has(name);
  }

  array(name: string): Numbers {
    const found = this.arrays.get(name);
    if (!found) throw new Error(`the data have no array "${name}"`);
    return found;
  }
}

/** Takes an inflated block apart. Arrays are views of it. */
export function parsePiece<Text>(buffer: ArrayBuffer): Piece<Text> {
  const length = new DataView(buffer).getUint32(0, true);
  const start = 4 + length;
  const text = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))) as Text & {
    arrays: ArrayEntry[];
  };
  const arrays = new Map<string, Numbers>();
  for (const { name, type, offset, count } of text.arrays) {
    const make = makers[type];
    if (!make) throw new Error(`array "${name}" has the unknown type ${type}`);
    arrays.set(name, make(buffer, start + offset, count));
  }
  return new Piece<Text>(text, arrays);
}

export function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let n = 0; n < binary.length; ++n) bytes[n] = binary.charCodeAt(n);
  return bytes;
}

export async function readPiece<Text>(packed: Uint8Array<ArrayBuffer>): Promise<Piece<Text>> {
  const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return parsePiece<Text>(await new Response(plain).arrayBuffer());
}
