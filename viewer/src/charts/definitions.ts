// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
import type { History } from "../data/history.ts";
import { splitUnit } from "../data/history.ts";

export interface CurveDefinition {
  label: string;
  /** The columns that it needs. */
  needs: string[];
  value(columns: Float64Array[], row: number): number;
}

export interface ChartDefinition {
  id: string;
  title: string;
  unit: string;
  logarithmic?: boolean;
  /** Whether zero belongs to the axis. */
  fromZero?: boolean;
  curves: CurveDefinition[];
}

function plain(label: string, column: string, factor = 1): CurveDefinition {
  return { label, needs: [column], value: ([numbers], row) => factor * numbers[row] };
}

/** Every chart that some run may have; those whose columns are missing are left out by `chartsOf`. */
const charts: ChartDefinition[] = [
  {
    id: "stress-ratio",
    title: "Stress ratio q/p",
    unit: "",
    fromZero: true,
    curves: [
      {
        label: "q/p",
        needs: ["deviator_Pa", "mean_stress_Pa"],
        value: ([q, p], row) => (p[row] > 0 ? q[row] / p[row] : Number.NaN),
      },
    ],
  },
  {
    id: "volumetric-strain",
    title: "Volumetric strain, compression positive",
    unit: "%",
    fromZero: true,
    curves: [plain("volumetric strain", "volumetric_strain", 100)],
  },
  { id: "void-ratio", title: "Void ratio", unit: "", curves: [plain("void ratio", "void_ratio")] },
  {
    id: "stresses",
    title: "Stresses",
    unit: "Pa",
    fromZero: true,
    curves: [
      plain("mean p", "mean_stress_Pa"),
      plain("deviator q", "deviator_Pa"),
      plain("σxx", "stress_xx_Pa"),
      plain("σyy", "stress_yy_Pa"),
      plain("σzz", "stress_zz_Pa"),
    ],
  },
  {
    id: "friction-angle",
    title: "Mobilised friction angle",
    unit: "°",
    fromZero: true,
    curves: [plain("friction angle", "friction_angle_deg")],
  },
  {
    id: "energy",
    title: "Energy budget",
    unit: "J",
    fromZero: true,
    curves: [
      plain("work of walls", "wall_work_J"),
      plain("friction", "friction_J"),
      plain("dashpots", "dashpot_J"),
      plain("damping", "damping_J"),
      plain("elastic", "elastic_J"),
      {
        label: "kinetic",
        needs: ["translation_J", "rotation_J"],
        value: ([translation, rotation], row) => translation[row] + rotation[row],
      },
      {
        label: "gravity",
        needs: ["gravity_J"],
        value: ([gravity], row) => gravity[row] - gravity[0],
      },
    ],
  },
  {
    id: "coordination",
    title: "Coordination number",
    unit: "",
    fromZero: true,
    curves: [
      plain("with walls", "coordination"),
      plain("mechanical, between grains", "mechanical_coordination"),
    ],
  },
  {
    id: "unbalanced",
    title: "Unbalanced force ratio",
    unit: "",
    logarithmic: true,
    curves: [plain("unbalanced ratio", "unbalanced_ratio")],
  },
  {
    id: "inertial",
    title: "Inertial number",
    unit: "",
    logarithmic: true,
    curves: [plain("inertial number", "inertial_number")],
  },
  {
    id: "balance",
    title: "Error of the energy balance",
    unit: "J",
    curves: [plain("balance error", "balance_error_J")],
  },
  {
    id: "speed",
    title: "Largest speed of a grain",
    unit: "m/s",
    logarithmic: true,
    curves: [plain("largest speed", "largest_speed_m_per_s")],
  },
];

function available(curve: CurveDefinition, histories: readonly History[]): boolean {
  return histories.some((history) => curve.needs.every((name) => history.has(name)));
}

/** Whether a curve is shown: a column of zeros is left out where others share its chart. */
function moves(curve: CurveDefinition, histories: readonly History[]): boolean {
  return histories.some((history) => {
    if (!curve.needs.every((name) => history.has(name))) return false;
    const columns = curve.needs.map((name) => history.column(name));
    for (let row = 0; row < history.rows; ++row) {
      if (Math.abs(curve.value(columns, row)) > 0) return true;
    }
    return false;
  });
}

/** The charts that these runs have columns for. */
export function chartsOf(histories: readonly History[]): ChartDefinition[] {
  return charts
    .map((chart) => {
      const there = chart.curves.filter((curve) => available(curve, histories));
      const moving = there.filter((curve) => moves(curve, histories));
      return { ...chart, curves: moving.length > 0 ? moving : there.slice(0, 1) };
    })
    .filter((chart) => chart.curves.length > 0);
}

/** A chart of one column by name. */
export function chartOfColumn(name: string): ChartDefinition {
  const [label, unit] = splitUnit(name);
  return { id: "any", title: label.replaceAll("_", " "), unit, curves: [plain(label, name)] };
}

/** The choices for the horizontal axis. */
export interface Abscissa {
  id: string;
  label: string;
  unit: string;
  value: CurveDefinition;
}

export function abscissasOf(histories: readonly History[]): Abscissa[] {
  const all: Abscissa[] = [
    { id: "time", label: "Time", unit: "s", value: plain("time", "time_s") },
    ...(["x", "y", "z"] as const).map((axis) => ({
      id: `strain_${axis}`,
      label: `Strain along ${axis}, logarithmic`,
      unit: "%",
      value: plain("strain", `strain_${axis}`, 100),
    })),
    { id: "mean_stress", label: "Mean stress p", unit: "Pa", value: plain("p", "mean_stress_Pa") },
    { id: "step", label: "Step", unit: "", value: plain("step", "step") },
  ];
  return all.filter((abscissa) =>
    histories.every((history) => abscissa.value.needs.every((name) => history.has(name))),
  );
}
