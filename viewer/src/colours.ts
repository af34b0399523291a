// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

export type Rgb = [number, number, number]; // 0 to 1, sRGB

/**
 * Maps that read the same for most kinds of colour blindness and in gray print, as 17 colours to be
 * blended: viridis (van der Walt and Smith 2015), cividis (Nunez, Anderton and Renslow 2018), and a
 * plain gray.
 */
export const maps: Record<string, string[]> = {
  viridis: [
    "#440154", "#48186a", "#472d7b", "#424086", "#3b528b", "#33638d",
    "#2c728e", "#26828e", "#21918c", "#1fa088", "#28ae80", "#3fbc73",
    "#5ec962", "#84d44b", "#addc30", "#d8e219", "#fde725",
  ],
  cividis: [
    "#00224e", "#002e6a", "#1a386f", "#32436d", "#434e6c", "#535a6d",
    "#61656f", "#6f7073", "#7d7c78", "#8c8878", "#9b9476", "#aba072",
    "#bcae6c", "#cdbb63", "#dec958", "#f0d846", "#fee838",
  ],
  gray: ["#303030", "#f0f0f0"],
};

/** Colours of runs and curves (Okabe and Ito 2008), darkest first. */
export const hues = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#5b5b5b"];

/** Dashes of runs, where colours distinguish quantities. */
export const dashes: number[][] = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

function channels(colour: string): Rgb {
  return [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16) / 255) as Rgb;
}

/** A map as a function of [0, 1]; values beyond take the end's colour, NaN is light gray. */
export function colourMap(name: string): (value: number) => Rgb {
  const stops = (maps[name] ?? maps.viridis).map(channels);
  return (value) => {
    if (Number.isNaN(value)) return [0.8, 0.8, 0.8];
    const place = Math.min(Math.max(value, 0), 1) * (stops.length - 1);
    const below = Math.min(Math.floor(place), stops.length - 2);
    const share = place - below;
    return [0, 1, 2].map(
      (channel) => (1 - share) * stops[below][channel] + share * stops[below + 1][channel],
    ) as Rgb;
  };
}

/** The map as a CSS gradient from left to right. */
export function gradient(name: string): string {
  return `linear-gradient(to right, ${(maps[name] ?? maps.viridis).join(", ")})`;
}
