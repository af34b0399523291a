// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

/** How much of a grain is drawn: its surface; a coarse one; a ball of its volume, which is one point. */
export enum Detail {
  fine,
  coarse,
  balls,
}

const slowPicture = 55; // [ms]

/** Which detail keeps pace while the view moves, learned from how long pictures take. */
export class Pace {
  moving = Detail.fine;

  /** A picture of this detail took `time` [ms]. A quick fine one shows that earlier ones only had to wait. */
  learn(detail: Detail, time: number): void {
    if (time > slowPicture) this.moving = Math.max(this.moving, Math.min(detail + 1, Detail.balls));
    else if (detail === Detail.fine) this.moving = Detail.fine;
  }
}
