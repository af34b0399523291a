// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
} from "three";
import type { Frame } from "../data/frame.ts";

/** The membrane of a frame: a transparent skin, and its net. */
export class MembraneView {
  readonly group = new Group();
  private readonly skin = new Mesh(
    new BufferGeometry(),
    new MeshLambertMaterial({ color: 0xb0743c, transparent: true, opacity: 0.16, depthWrite: false, side: DoubleSide }),
  );
  private readonly net = new Mesh(
    new BufferGeometry(),
    new MeshBasicMaterial({ color: 0x5c4630, transparent: true, opacity: 0.28, depthWrite: false, wireframe: true }),
  );

  constructor() {
    this.group.add(this.skin, this.net);
    for (const mesh of [this.skin, this.net]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 1; // after what is seen through it
    }
  }

  get materials() {
    return [this.skin.material, this.net.material];
  }

  setFrame(frame: Frame): void {
    this.skin.geometry.dispose();
    const geometry = new BufferGeometry();
    if (frame.membraneCorners.length > 0) {
      geometry.setAttribute("position", new BufferAttribute(frame.membranePosition, 3));
      geometry.setIndex(new BufferAttribute(frame.membraneCorners, 1));
      geometry.computeVertexNormals();
    }
    this.skin.geometry = geometry;
    this.net.geometry = geometry;
    for (const mesh of [this.skin, this.net]) mesh.visible = frame.membraneCorners.length > 0;
  }
}
