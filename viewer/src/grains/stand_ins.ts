// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import {
  BufferAttribute,
  BufferGeometry,
  type Material,
  Mesh,
  MeshLambertMaterial,
  Points,
  ShaderMaterial,
} from "three";
import type { Frame } from "../data/frame.ts";
import { Detail } from "./pace.ts";
import { type Merged, merged } from "./merged.ts";
import type { SurfaceOf } from "./pick.ts";

/** Each point is drawn like the ball that it replaces. */
const ballShader = {
  vertexShader: `
    attribute float radius;
    attribute vec3 color;
    uniform float pixels; // of a length of one at distance one
    varying vec3 shade;
    #include <clipping_planes_pars_vertex>
    void main() {
      shade = color;
      vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
      #include <clipping_planes_vertex>
      gl_Position = projectionMatrix * mvPosition;
      gl_PointSize = 2.0 * radius * pixels / -mvPosition.z;
    }`,
  fragmentShader: `
    uniform float opacity;
    varying vec3 shade;
    #include <clipping_planes_pars_fragment>
    void main() {
      #include <clipping_planes_fragment>
      vec2 at = 2.0 * gl_PointCoord - 1.0;
      float height = 1.0 - dot(at, at);
      if (height < 0.0) discard;
      float light = dot(vec3(at.x, -at.y, sqrt(height)), vec3(-0.41, 0.61, 0.68));
      gl_FragColor = vec4(shade * (0.62 + 0.38 * light), opacity);
      #include <colorspace_fragment>
    }`,
};

/** All grains as one object, in place of their own surfaces where these would be slow to draw. */
export class StandIns {
  readonly coarse = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ vertexColors: true }));
  readonly balls = new Points(
    new BufferGeometry(),
    new ShaderMaterial({
      ...ballShader,
      uniforms: { pixels: { value: 1 }, opacity: { value: 1 } },
      clipping: true,
    }),
  );
  private outdated = { coarse: true, balls: true };

  constructor() {
    for (const thing of [this.coarse, this.balls]) {
      thing.visible = false;
      thing.frustumCulled = false;
    }
  }

  get materials(): Material[] {
    return [this.coarse.material, this.balls.material];
  }

  /** Places or colours have changed. */
  invalidate(): void {
    this.outdated = { coarse: true, balls: true };
  }

  setFaint(faint: boolean, solid: boolean): void {
    for (const material of this.materials) {
      material.transparent = faint;
      material.opacity = faint ? 0.14 : 1;
      material.depthWrite = solid;
      material.needsUpdate = true;
    }
    this.balls.material.uniforms.opacity.value = faint ? 0.14 : 1;
  }

  /** `height` of the picture [pixels], `view` the camera's field of view [degrees]. */
  setPixels(height: number, view: number): void {
    this.balls.material.uniforms.pixels.value = height / 2 / Math.tan((view * Math.PI) / 360);
  }

  /** Shows the substitute for this detail; `colours` has three numbers per row. */
  show(detail: Detail, frame: Frame | null, surfaceOf: SurfaceOf, colours: Float32Array): void {
    this.coarse.visible = detail === Detail.coarse;
    this.balls.visible = detail >= Detail.balls;
    if (!frame) return;
    if (this.coarse.visible && this.outdated.coarse) {
      replaceGeometry(this.coarse, merged(frame, surfaceOf, colours));
      this.outdated.coarse = false;
    }
    if (this.balls.visible && this.outdated.balls) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(frame.position, 3));
      geometry.setAttribute("radius", new BufferAttribute(frame.equivalentRadius, 1));
      geometry.setAttribute("color", new BufferAttribute(colours, 3));
      this.balls.geometry.dispose();
      this.balls.geometry = geometry;
      this.outdated.balls = false;
    }
  }
}

function replaceGeometry(mesh: Mesh, all: Merged): void {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(all.position, 3));
  geometry.setAttribute("normal", new BufferAttribute(all.normal, 3));
  geometry.setAttribute("color", new BufferAttribute(all.colour, 3));
  geometry.setIndex(new BufferAttribute(all.index, 1));
  mesh.geometry.dispose();
  mesh.geometry = geometry;
}
