// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

const prefixes: [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];
const minus = "\u2212";
const thinSpace = "\u202f";

/** `value` with about `digits` significant digits, without trailing noise: 0.0123, 1.2×10⁻⁷, 12 345. */
export function number(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const sign = value < 0 ? minus : "";
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = size.toExponential(digits - 1).split("e");
    const shown = Number(mantissa).toString();
    return `${sign}${shown}×10${superscript(Number(exponent))}`;
  }
  const text = Number(size.toPrecision(digits)).toString();
  const [whole, part] = text.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, thinSpace) : whole;
  return sign + grouped + (part ? `.${part}` : "");
}

function superscript(exponent: number): string {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const text = Math.abs(exponent).toString();
  return (exponent < 0 ? "⁻" : "") + [...text].map((digit) => digits[Number(digit)]).join("");
}

export function whole(value: number): string {
  return Number.isFinite(value)
    ? Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, thinSpace)
    : "–";
}

/** The factor and the unit in which numbers up to `size` of `unit` read well: 1e5, Pa -> 1e-3, kPa. */
export function scaled(size: number, unit: string): { factor: number; unit: string } {
  const plain = { factor: 1, unit };
  if (!["s", "m", "N", "Pa", "J", "m/s", "kg", "rad/s"].includes(unit)) return plain;
  if (!(size > 0) || !Number.isFinite(size)) return plain;
  if (unit === "kg") {
    const grams = scaledBy(size * 1e3, "g");
    return { factor: 1e3 * grams.factor, unit: grams.unit };
  }
  if (unit === "rad/s") return plain;
  return scaledBy(size, unit);
}
function scaledBy(size: number, unit: string): { factor: number; unit: string } {
  const [power, prefix] = prefixes.find(([least]) => size >= 0.999 * least) ?? prefixes[prefixes.length - 1];
  return { factor: 1 / power, unit: prefix + unit };
}

/** A number with its unit, in a prefix that suits it: "1.25 mm". */
export function quantity(value: number, unit: string, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  const scale = scaled(Math.abs(value), unit);
  const text = number(value * scale.factor, digits);
  return scale.unit ? `${text}${scale.unit === "°" ? "" : "\u00a0"}${scale.unit}` : text;
}

export function duration(seconds: number): string {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 60) return quantity(seconds, "s");
  const minutes = Math.floor(seconds / 60);
  if (minutes < 60) return `${minutes} min ${Math.round(seconds - 60 * minutes)} s`;
  const hours = Math.floor(minutes / 60);
  if (hours < 24) return `${hours} h ${minutes - 60 * hours} min`;
  return `${Math.floor(hours / 24)} d ${hours % 24} h`;
}

export function bytes(count: number): string {
  if (!Number.isFinite(count)) return "–";
  for (const [size, unit] of [
    [1e9, "GB"],
    [1e6, "MB"],
    [1e3, "kB"],
  ] as const) {
    if (count >= size) return `${number(count / size, 3)}\u00a0${unit}`;
  }
  return `${count}\u00a0B`;
}
