// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { fromBase64, type Piece, readPiece } from "./piece.ts";

/** Where the page has its data from. */
export interface Source {
  readonly live: boolean;
  readonly runs: number;
  piece<Text>(name: string): Promise<Piece<Text>>;
}

/** Pieces that lie in the page itself. Each is unpacked at its first request. */
class PageSource implements Source {
  readonly live = false;
  readonly runs: number;
  private readonly elements = new Map<string, Element>();

  constructor() {
    for (const element of document.querySelectorAll("script[data-piece]")) {
      this.elements.set(element.getAttribute("data-piece") ?? "", element);
    }
    let runs = 0;
    while (this.elements.has(`${runs}/head`)) ++runs;
    this.runs = runs;
  }

  piece<Text>(name: string): Promise<Piece<Text>> {
    const element = this.elements.get(name);
    if (!element) return Promise.reject(new Error(`this page has no data of "${name}"`));
    return readPiece<Text>(fromBase64(element.textContent ?? ""));
  }
}

/** Pieces that `reckon watch` serves. */
class ServerSource implements Source {
  readonly live = true;
  readonly runs = 1;

  async piece<Text>(name: string): Promise<Piece<Text>> {
    const answer = await fetch(`piece/${name}`, { cache: "no-store" });
    if (!answer.ok) throw new Error((await answer.text()) || answer.statusText);
    return readPiece<Text>(new Uint8Array(await answer.arrayBuffer()));
  }
}

export function pageSource(): Source {
  return document.querySelector('meta[name="reckon-live"]') ? new ServerSource() : new PageSource();
}
