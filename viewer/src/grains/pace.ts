// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * How much of a grain is drawn: its surface; a coarse one; a ball of its volume, which is one point;
 * such a ball in a picture of half as many pixels each way.
 */
export enum Detail {
  fine,
  coarse,
  balls,
  blurred,
}

/** The share of the screen's pixels, each way, that a picture has. */
export const sharpness = (detail: Detail): number => (detail === Detail.blurred ? 0.5 : 1);

const slowPicture = 55; // [ms]

/** Which detail keeps pace while the view moves, learned from how long pictures take. */
export class Pace {
  moving = Detail.fine;
  private slowBalls = 0;

  /**
   * A picture of this detail took `time` [ms]. A quick fine one shows that earlier ones only had to wait. A
   * single slow one of balls, which may have had their shader built first, does not yet cost sharpness.
   */
  learn(detail: Detail, time: number): void {
    if (time <= slowPicture) {
      if (detail === Detail.fine) this.moving = Detail.fine;
      this.slowBalls = 0;
    } else if (detail !== Detail.balls || ++this.slowBalls > 1) {
      this.moving = Math.max(this.moving, Math.min(detail + 1, Detail.blurred));
    }
  }
}
