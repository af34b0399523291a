// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  FrontSide,
  HemisphereLight,
  InstancedBufferAttribute,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Plane,
  Quaternion,
  Raycaster,
  Scene,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Frame } from "../data/frame.ts";
import type { Run } from "../data/run.ts";
import type { Rgb } from "../colours.ts";
import { boundsOf, wallLines } from "./outlines.ts";
import { CellView } from "./cell.ts";
import { listenToKeys, listenToPointer } from "./input.ts";
import { MembraneView } from "./membrane.ts";
import { Detail, Pace, sharpness } from "./pace.ts";
import { pickGrain } from "./pick.ts";
import { geometryOf, paintCutsFlat } from "./solids.ts";
import { StandIns } from "./stand_ins.ts";
import { ball, type ShapeSurfaces, unpackSurfaces } from "./surfaces.ts";

export type GrainStyle = "solid" | "faint" | "hidden";
export type Axis = "x" | "y" | "z";

export interface Slice {
  axis: Axis;
  /** From 0 to 1 across the box of the grains. */
  place: number;
  /** The part in front of the plane is cut away for the oblique view; flipped, the part behind it. */
  flipped: boolean;
}

const pickedColour = 0xd81b60;
const settleTime = 250; // [ms] after the last move until the fine ones come back

/** A renderer with an opaque canvas: software would blend every pixel with the page behind. */
function opaqueContext(canvas: HTMLCanvasElement): WebGL2RenderingContext {
  const context = canvas.getContext("webgl2", { alpha: false, antialias: true, powerPreference: "high-performance" });
  if (!context) throw new Error("no WebGL 2");
  return context;
}

interface ShapeMesh {
  mesh: InstancedMesh;
  rows: number[]; // of the frame, by instance
}

/** The grains, contacts and walls of one frame. Draws only when something has changed. */
export class GrainView {
  readonly canvas: HTMLCanvasElement;
  /** How long the last picture took, until the graphics card had finished it [ms]. */
  frameTime = 0;
  picked: (row: number) => void = () => {};

  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(28, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly light = new DirectionalLight(0xffffff, 1.9);
  private readonly grainMaterial = new MeshLambertMaterial();
  private readonly standIns = new StandIns();
  private readonly membrane = new MembraneView();
  private readonly cell = new CellView();
  private colourOf: (row: number) => Rgb = () => [0.8, 0.8, 0.8];
  private colours = new Float32Array(); // three per row
  private readonly plane = new Plane();
  private readonly walls = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: 0x5c6670 }),
  );
  private chains: InstancedMesh | null = null;
  private readonly chainMaterial = new MeshLambertMaterial({ color: 0xffffff });
  private readonly highlight = new Mesh(
    new BufferGeometry(),
    new MeshLambertMaterial({ color: pickedColour, emissive: 0x5a0b28, side: DoubleSide }),
  );
  private meshes: ShapeMesh[] = [];
  private surfaces: (ShapeSurfaces | null)[] = [];
  private readonly ball: ShapeSurfaces = { fine: ball(3), coarse: ball(1) };
  private shapesKnown = false;
  private frame: Frame | null = null;
  private run: Run | null = null;
  private style: GrainStyle = "solid";
  private slice: Slice | null = null;
  private selected = -1;
  private pending = false;
  private busy = false; // the graphics card is at work
  private outdated = false; // and the content has changed meanwhile
  private held = false; // the pointer is down
  private detail = Detail.fine;
  private readonly pace = new Pace();
  private settle = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, context: opaqueContext(canvas) });
    this.renderer.setClearColor(0xf3f2ee);
    this.renderer.localClippingEnabled = true;
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.camera.up.set(0, 0, 1);
    this.scene.add(new HemisphereLight(0xffffff, 0x9a958a, 1.7), this.camera, this.walls);
    this.camera.add(this.light);
    this.light.position.set(-0.6, 0.9, 1);
    this.highlight.visible = false;
    const { coarse, balls } = this.standIns;
    this.scene.add(this.highlight, coarse, balls, this.membrane.group, this.cell.lines);
    for (const material of [this.grainMaterial, coarse.material]) paintCutsFlat(material);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.moved());
    this.controls.addEventListener("start", () => {
      this.held = true;
    });
    this.controls.addEventListener("end", () => {
      this.held = false;
    });
    listenToPointer(canvas, (place) => this.picked(this.grainAt(place)));
    listenToKeys(canvas, this.camera, this.controls.target, {
      moved: () => {
        this.controls.update();
        this.moved();
      },
      picked: () => this.picked(this.grainAt(new Vector2(0, 0))),
      released: () => this.picked(-1),
    });
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  setRun(run: Run): void {
    this.run = run;
    for (const { mesh } of this.meshes) this.remove(mesh);
    this.meshes = [];
    this.shapesKnown = run.text.shapes_missing === "";
    this.surfaces = this.shapesKnown ? unpackSurfaces(run.head) : [];
    this.selected = -1;
  }

  setFrame(frame: Frame): void {
    this.frame = frame;
    this.placeGrains(frame);
    this.placeWalls(frame);
    this.membrane.setFrame(frame);
    this.cell.setFrame(frame);
    this.applySlice();
    this.placeHighlight();
    this.draw();
  }

  /** A colour for every row of the frame. */
  setColours(colour: (row: number) => Rgb): void {
    this.colourOf = colour;
    this.paint();
    this.draw();
  }

  /** The picked grain has a colour that no map has. */
  private paint(): void {
    const mixed = new Color();
    this.colours = new Float32Array(3 * (this.frame?.grains ?? 0));
    for (const { mesh, rows } of this.meshes) {
      mesh.instanceColor ??= new InstancedBufferAttribute(new Float32Array(3 * mesh.instanceMatrix.count), 3);
      rows.forEach((row, n) => {
        if (row === this.selected) mixed.setHex(pickedColour);
        else mixed.setRGB(...this.colourOf(row), SRGBColorSpace);
        mesh.setColorAt(n, mixed);
        mixed.toArray(this.colours, 3 * row);
      });
      mesh.instanceColor.needsUpdate = true;
    }
    this.standIns.invalidate();
    this.chooseSurfaces();
  }

  /** Contacts as bars between centres, with this `thickness` [m]; null: none. */
  setChains(thickness: ((contact: number) => number) | null, colour?: (contact: number) => Rgb): void {
    if (this.chains) {
      this.scene.remove(this.chains);
      this.chains.geometry.dispose();
      this.chains.dispose();
      this.chains = null;
    }
    const frame = this.frame;
    if (frame && thickness && frame.contacts > 0) {
      const bar = new CylinderGeometry(1, 1, 1, 7, 1, true);
      bar.rotateX(Math.PI / 2); // along z
      const mesh = new InstancedMesh(bar, this.chainMaterial, frame.contacts);
      mesh.frustumCulled = false;
      const matrix = new Matrix4();
      const turn = new Quaternion();
      const along = new Vector3(0, 0, 1);
      const branch = new Vector3();
      const middle = new Vector3();
      const mixed = new Color();
      for (let c = 0; c < frame.contacts; ++c) {
        const row = frame.ends[2 * c];
        branch.fromArray(frame.branch, 3 * c);
        middle.fromArray(frame.position, 3 * row).addScaledVector(branch, 0.5);
        const length = branch.length();
        turn.setFromUnitVectors(along, branch.divideScalar(length || 1));
        const radius = thickness(c);
        matrix.compose(middle, turn, branch.set(radius, radius, length));
        mesh.setMatrixAt(c, matrix);
        if (colour) mesh.setColorAt(c, mixed.setRGB(...colour(c), SRGBColorSpace));
      }
      this.chains = mesh;
      this.scene.add(mesh);
    }
    this.draw();
  }

  setStyle(style: GrainStyle): void {
    this.style = style;
    this.standIns.setFaint(style === "faint", style === "solid");
    this.chooseSurfaces();
    this.draw();
  }

  showMembrane(shown: boolean): void {
    this.membrane.group.visible = shown;
    this.draw();
  }

  setSlice(slice: Slice | null): void {
    this.slice = slice;
    this.applySlice();
    this.draw();
  }

  select(row: number): void {
    this.selected = row;
    this.paint();
    this.placeHighlight();
    this.draw();
  }

  /** Shows the whole frame, obliquely or along an axis. */
  lookAt(direction: Axis | "oblique"): void {
    if (!this.frame) return;
    const { low, high } = boundsOf(this.frame);
    const center = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
    const size = new Vector3(...high).sub(new Vector3(...low)).length();
    const from = {
      oblique: new Vector3(0.62, -1, 0.42),
      x: new Vector3(1, 0, 0),
      y: new Vector3(0, -1, 0),
      z: new Vector3(0, -1e-4, 1),
    }[direction].normalize();
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (0.47 * size) / Math.tan((this.camera.fov * Math.PI) / 360) / narrow;
    this.camera.position.copy(center).addScaledVector(from, distance);
    this.camera.near = distance / 200;
    this.camera.far = distance * 8;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(center);
    this.controls.minDistance = distance / 60;
    this.controls.maxDistance = distance * 4;
    this.controls.update();
    this.draw();
  }

  draw(): void {
    this.canvas.dataset.busy = "true";
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.drawNow();
    });
  }

  /** Draws, unless the graphics card is still at the last picture; then as soon as it is done. */
  private drawNow(): void {
    if (this.canvas.clientWidth === 0) {
      delete this.canvas.dataset.busy;
      return;
    }
    if (this.busy) {
      this.outdated = true;
      return;
    }
    this.outdated = false;
    this.busy = true;
    const start = performance.now();
    const { detail } = this;
    this.fit();
    this.renderer.render(this.scene, this.camera);
    const context = this.renderer.getContext() as WebGL2RenderingContext;
    const fence = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
    context.flush();
    const look = () => {
      const done = !fence || context.getSyncParameter(fence, context.SYNC_STATUS) === context.SIGNALED;
      if (!done && !context.isContextLost()) {
        window.setTimeout(look, 2);
        return;
      }
      context.deleteSync(fence);
      this.busy = false;
      this.frameTime = performance.now() - start;
      this.pace.learn(detail, this.frameTime);
      const { calls, triangles, points } = this.renderer.info.render;
      Object.assign(this.canvas.dataset, { detail: Detail[detail], calls, triangles, points });
      this.canvas.dataset.frameTime = this.frameTime.toFixed(1);
      this.canvas.dataset.drawn = String(Number(this.canvas.dataset.drawn ?? 0) + 1);
      if (this.outdated) this.drawNow(); // without waiting for the next frame of the screen
      else if (!this.pending) delete this.canvas.dataset.busy;
    };
    look();
  }

  /** While the view moves, slow machines draw less of each grain; all of it comes when it rests. */
  private moved(): void {
    this.setDetail(this.pace.moving);
    window.clearTimeout(this.settle);
    this.settle = window.setTimeout(() => this.rest(), settleTime);
    this.draw();
  }
  private rest(): void {
    if (this.held) this.settle = window.setTimeout(() => this.rest(), settleTime);
    else this.setDetail(Detail.fine);
  }
  private setDetail(detail: Detail): void {
    if (detail === this.detail) return;
    this.detail = detail;
    this.chooseSurfaces();
    this.draw();
  }
  /** Grains that are seen through need no details, and many layers of them cost much. */
  private chooseSurfaces(): void {
    const { frame, style } = this;
    const detail = style === "faint" ? Math.max(this.detail, Detail.coarse) : this.detail;
    const shown = frame && style !== "hidden";
    for (const { mesh } of this.meshes) mesh.visible = Boolean(shown) && detail === Detail.fine;
    this.standIns.show(
      shown ? detail : Detail.fine,
      frame,
      (row) => ({
        surface: this.shapeOf(frame?.shape[row] ?? 0).coarse,
        scale: frame ? this.scaleOf(frame, row) : 1,
      }),
      this.colours,
    );
  }
  private remove(mesh: InstancedMesh): void {
    this.scene.remove(mesh);
    mesh.geometry.dispose();
    mesh.dispose();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
  /** Gives the picture the pixels that it is to have. This clears it, so it is drawn right after. */
  private fit(): void {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = Math.min(window.devicePixelRatio, 2) * sharpness(this.detail);
    const size = this.renderer.getSize(new Vector2());
    if (size.x === clientWidth && size.y === clientHeight && this.renderer.getPixelRatio() === ratio) return;
    this.renderer.setDrawingBufferSize(clientWidth, clientHeight, ratio);
    this.standIns.setPixels(this.canvas.height, this.camera.fov);
  }

  private shapeOf(shape: number): ShapeSurfaces {
    return this.surfaces[shape] ?? this.ball;
  }
  private scaleOf(frame: Frame, row: number): number {
    return this.surfaces[frame.shape[row]] ? 1 : frame.equivalentRadius[row];
  }

  private placeGrains(frame: Frame): void {
    const rowsOfShape = new Map<number, number[]>();
    for (let row = 0; row < frame.grains; ++row) {
      const shape = this.surfaces[frame.shape[row]] ? frame.shape[row] : -1;
      const rows = rowsOfShape.get(shape);
      if (rows) rows.push(row);
      else rowsOfShape.set(shape, [row]);
    }
    const reusable = new Map(this.meshes.map((shape) => [shape.mesh.userData.shape as number, shape]));
    this.meshes = [];
    const matrix = new Matrix4();
    const place = new Vector3();
    const turn = new Quaternion();
    const size = new Vector3();
    for (const [shape, rows] of rowsOfShape) {
      let entry = reusable.get(shape);
      if (!entry || entry.mesh.instanceMatrix.count < rows.length) {
        if (entry) this.remove(entry.mesh);
        const mesh = new InstancedMesh(
          geometryOf(this.shapeOf(shape).fine),
          this.grainMaterial,
          rows.length,
        );
        mesh.frustumCulled = false;
        mesh.userData.shape = shape;
        this.scene.add(mesh);
        entry = { mesh, rows };
      }
      reusable.delete(shape);
      entry.rows = rows;
      entry.mesh.count = rows.length;
      rows.forEach((row, n) => {
        const [w, x, y, z] = frame.orientation.subarray(4 * row, 4 * row + 4);
        place.fromArray(frame.position, 3 * row);
        turn.set(x, y, z, w);
        const scale = this.scaleOf(frame, row);
        matrix.compose(place, turn, size.set(scale, scale, scale));
        entry.mesh.setMatrixAt(n, matrix);
      });
      entry.mesh.instanceMatrix.needsUpdate = true;
      this.meshes.push(entry);
    }
    for (const { mesh } of reusable.values()) this.remove(mesh);
  }

  private placeWalls(frame: Frame): void {
    const lines = wallLines(this.run?.text.walls ?? [], frame);
    this.walls.geometry.dispose();
    this.walls.geometry = new BufferGeometry();
    this.walls.geometry.setAttribute(
      "position",
      new BufferAttribute(Float32Array.from(lines.flat()), 3),
    );
  }

  private placeHighlight(): void {
    const frame = this.frame;
    this.highlight.visible = frame !== null && this.selected >= 0 && this.selected < frame.grains;
    if (!frame || !this.highlight.visible) return;
    const row = this.selected;
    this.highlight.geometry.dispose();
    this.highlight.geometry = geometryOf(this.shapeOf(frame.shape[row]).fine);
    const [w, x, y, z] = frame.orientation.subarray(4 * row, 4 * row + 4);
    this.highlight.position.fromArray(frame.position, 3 * row);
    this.highlight.quaternion.set(x, y, z, w);
    this.highlight.scale.setScalar(1.015 * this.scaleOf(frame, row));
  }

  private applySlice(): void {
    const planes: Plane[] = [];
    if (this.slice && this.frame) {
      const { low, high } = boundsOf(this.frame);
      const axis = "xyz".indexOf(this.slice.axis);
      const at = low[axis] + this.slice.place * (high[axis] - low[axis]);
      const side = (this.slice.axis === "y") === this.slice.flipped ? -1 : 1;
      this.plane.set(new Vector3().setComponent(axis, side), -side * at);
      planes.push(this.plane);
    }
    const cut = [this.grainMaterial, this.chainMaterial, this.highlight.material as MeshLambertMaterial];
    for (const material of [...cut, ...this.standIns.materials, ...this.membrane.materials]) {
      material.clippingPlanes = planes;
    }
    const side = planes.length > 0 ? DoubleSide : FrontSide;
    for (const material of [this.grainMaterial, this.standIns.coarse.material]) {
      if (material.side === side) continue;
      material.side = side;
      material.needsUpdate = true;
    }
  }

  /** The row of the grain that shows at a place of the canvas, from (-1, -1) to (1, 1); or -1. */
  private grainAt(place: Vector2): number {
    const frame = this.frame;
    if (!frame || this.style === "hidden") return -1;
    const caster = new Raycaster();
    caster.setFromCamera(place, this.camera);
    const { origin, direction } = caster.ray;
    const point = new Vector3();
    return pickGrain(
      frame,
      (row) => ({ surface: this.shapeOf(frame.shape[row]).fine, scale: this.scaleOf(frame, row) }),
      { origin: origin.toArray(), direction: direction.toArray() },
      (at) => !this.slice || this.plane.distanceToPoint(point.set(...at)) >= 0,
    );
  }
}
