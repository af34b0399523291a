// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import { type Camera, Vector2, Vector3 } from "three";

/** Calls `clicked` with the place of a click that was no drag, from (-1, -1) to (1, 1). */
export function listenToPointer(canvas: HTMLCanvasElement, clicked: (place: Vector2) => void): void {
  let down: PointerEvent | null = null;
  canvas.addEventListener("pointerdown", (event) => {
    down = event;
  });
  canvas.addEventListener("pointerup", (event) => {
    const still = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 5;
    down = null;
    if (!still || event.button !== 0) return;
    const box = canvas.getBoundingClientRect();
    clicked(
      new Vector2(
        (2 * (event.clientX - box.left)) / box.width - 1,
        1 - (2 * (event.clientY - box.top)) / box.height,
      ),
    );
  });
}

export interface KeyEvents {
  moved(): void; // the camera has moved
  picked(): void; // the grain in the middle is picked
  released(): void; // no grain is picked any more
}

/** Arrows turn around `target`, plus and minus come closer or go back, Enter picks, Escape lets go. */
export function listenToKeys(
  canvas: HTMLCanvasElement,
  camera: Camera,
  target: Vector3,
  events: KeyEvents,
): void {
  const turn = Math.PI / 36;
  const upward = new Vector3(0, 0, 1);
  canvas.addEventListener("keydown", (event) => {
    const offset = camera.position.clone().sub(target);
    const sideways = new Vector3().crossVectors(upward, offset).normalize();
    switch (event.key) {
      case "ArrowLeft":
        offset.applyAxisAngle(upward, -turn);
        break;
      case "ArrowRight":
        offset.applyAxisAngle(upward, turn);
        break;
      case "ArrowUp":
        offset.applyAxisAngle(sideways, -turn);
        break;
      case "ArrowDown":
        offset.applyAxisAngle(sideways, turn);
        break;
      case "+":
      case "=":
        offset.multiplyScalar(0.9);
        break;
      case "-":
        offset.multiplyScalar(1 / 0.9);
        break;
      case "Enter":
        events.picked();
        return;
      case "Escape":
        events.released();
        return;
      default:
        return;
    }
    event.preventDefault();
    // Not over the top, where left and right change places.
    if (Math.abs(offset.z) < 0.999 * offset.length()) {
      camera.position.copy(target).add(offset);
      events.moved();
    }
  });
}
