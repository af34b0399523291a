// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { BufferAttribute, BufferGeometry, type MeshLambertMaterial } from "three";
import type { Surface } from "./surfaces.ts";

export function geometryOf(surface: Surface): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(surface.position, 3));
  geometry.setAttribute("normal", new BufferAttribute(surface.normal, 3));
  geometry.setIndex(new BufferAttribute(surface.index, 1));
  return geometry;
}

/** Where the slicing plane opens a grain, its inside is painted in one shade, like a cut face. */
export function paintCutsFlat(material: MeshLambertMaterial): void {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <opaque_fragment>",
      "if (!gl_FrontFacing) outgoingLight = 0.58 * diffuseColor.rgb;\n#include <opaque_fragment>",
    );
  };
}
