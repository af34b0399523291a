// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>

#include "reckon/core/hdf5_file.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

// 2 added departed grains, 3 driven walls and stages, 4 the membrane, 5 the cell and bonds, 6 the
// last push of dashpots, 7 the stiffness of springs, 8 since when a goal is met.
inline const Hdf5Kind checkpoint_kind{"checkpoint", 8};

/// How the parts of the state lie in columns. The same walk fills columns from the state, and the
/// state from columns: `Columns` offers number, vector, quaternion, id and flag.
template <class Columns, class Grain>
void walk_grain(Columns& columns, Grain& grain) {
  columns.id("id", grain.id);
  columns.id("shape", grain.shape);
  columns.flag("prescribed", grain.prescribed);
  columns.vector("position", "m", grain.position);
  columns.quaternion("orientation", grain.orientation);
  columns.vector("velocity", "m/s", grain.velocity);
  columns.vector("angular_velocity_body", "rad/s", grain.angular_velocity_body);
  columns.vector("angular_increment_body", "rad/s", grain.angular_increment_body);
  columns.number("lost_to_friction", "J", grain.ledger.friction);
  columns.number("lost_to_dashpots", "J", grain.ledger.dashpot);
  columns.number("lost_to_damping", "J", grain.ledger.damping);
  columns.number("work_of_body_forces", "J", grain.ledger.body_work);
  columns.number("work_of_walls", "J", grain.ledger.wall_work);
  if (columns.has_since(5)) columns.number("lost_to_fracture", "J", grain.ledger.fracture);
}

template <class Columns, class Pair>
void walk_pair(Columns& columns, Pair& pair) {
  columns.id("id_a", pair.id_a);
  columns.id("id_b", pair.id_b);
}

template <class Columns, class Pair, class Cement>
void walk_bond(Columns& columns, Pair& pair, Cement& bond) {
  walk_pair(columns, pair);
  columns.vector("arm_a", "m", bond.arm_a);
  columns.vector("arm_b", "m", bond.arm_b);
  columns.quaternion("turn", bond.turn);
  columns.vector("axis_a", "1", bond.axis_a);
  columns.number("radius", "m", bond.radius);
}

/// The history of the springs of grains, walls and the membrane.
template <class Columns, class Spring>
void walk_memory(Columns& columns, Spring& spring) {
  columns.vector("shear_force", "N", spring.shear_force);
  columns.vector("normal", "1", spring.normal);
  if (columns.has_since(6)) columns.number("dashpot_push", "N", spring.dashpot_push);
}

template <class Columns, class Spring>
void walk_spring(Columns& columns, Spring& spring) {
  columns.integer("node", spring.node);
  columns.flag("master_is_b", spring.master_is_b);
  walk_memory(columns, spring);
  if (columns.has_since(7)) columns.number("shear_stiffness", "N/m", spring.shear_stiffness);
}

template <class Columns, class Departed>
void walk_departed(Columns& columns, Departed& departed) {
  columns.integer("step", departed.step);
  walk_grain(columns, departed.grain);
}

template <class Columns, class Contact>
void walk_wall_contact(Columns& columns, Contact& contact) {
  columns.id("grain", contact.grain);
  columns.id("wall", contact.wall);
}

template <class Columns, class Wall>
void walk_wall(Columns& columns, Wall& wall) {
  columns.vector("displacement", "m", wall.displacement);
  columns.vector("velocity", "m/s", wall.velocity);
  columns.vector("displacement_at_stage_start", "m", wall.displacement_at_stage_start);
}

/// Edges and rates as their diagonal and what is above it.
template <class Columns, class Matrix>
void walk_upper(Columns& columns, const char* diagonal, const char* above, const char* unit,
                Matrix& m) {
  columns.vector(diagonal, unit, m.diagonal);
  Vec3 rest{m.xy, m.xz, m.yz};
  columns.vector(above, unit, rest);
  if constexpr (!std::is_const_v<Matrix>) {
    m.xy = rest.x;
    m.xz = rest.y;
    m.yz = rest.z;
  }
}

/// One row where there is a cell, else none.
template <class Columns, class Cell>
void walk_cell(Columns& columns, Cell& cell) {
  walk_upper(columns, "edges", "lean", "m", cell.edges);
  walk_upper(columns, "edge_rates", "lean_rates", "m/s", cell.rates);
  walk_upper(columns, "edges_at_stage_start", "lean_at_stage_start", "m",
             cell.edges_at_stage_start);
  columns.vector("shear", "1", cell.shear);
  columns.vector("shear_at_stage_start", "1", cell.shear_at_stage_start);
  columns.number("work", "J", cell.work);
}

/// One row where the membrane is in place, else none.
template <class Columns, class Membrane>
void walk_membrane(Columns& columns, Membrane& membrane) {
  columns.vector("foot", "m", membrane.start.foot);
  columns.vector("axis", "1", membrane.start.axis_unit);
  columns.number("radius", "m", membrane.start.radius);
  columns.number("height", "m", membrane.start.height);
  columns.id("floor", membrane.floor);
  columns.id("lid", membrane.lid);
  columns.vector("floor_start", "m", membrane.floor_start);
  columns.vector("lid_start", "m", membrane.lid_start);
  columns.number("pressure_before", "Pa", membrane.pressure_before);
  columns.number("volume_at_stage_start", "m^3", membrane.volume_at_stage_start);
  columns.number("height_at_stage_start", "m", membrane.height_at_stage_start);
}

template <class Columns, class Node>
void walk_membrane_node(Columns& columns, Node& node) {
  columns.vector("position", "m", node.position);
  columns.vector("velocity", "m/s", node.velocity);
  columns.number("lost_to_friction", "J", node.ledger.friction);
  columns.number("lost_to_damping", "J", node.ledger.damping);
  columns.number("work_of_pressure", "J", node.ledger.wall_work);
}

template <class Columns, class Spring>
void walk_membrane_spring(Columns& columns, Spring& spring) {
  columns.integer("node", spring.node);
  columns.id("grain", spring.grain);
  walk_memory(columns, spring);
}

}  // namespace reckon
