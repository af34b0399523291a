// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reckon/simulation/stage_setup.hpp"

namespace reckon {
namespace {

/// The node cap belongs to pairs of grains: the published code does not apply it to walls.
AnyContactLaw make_law(const ContactConfig& contact, double normal_stiffness,
                       double shear_stiffness, bool dashpot, std::uint32_t node_cap,
                       bool rigid_wall) {
  const bool damped = dashpot && contact.restitution.has_value();
  if (contact.law == ContactLawKind::linear) {
    return LinearLaw{normal_stiffness, shear_stiffness,
                     damped ? linear_dashpot_factor(*contact.restitution) : 0, node_cap};
  }
  if (contact.law == ContactLawKind::hertz) {
    return hertz_law(contact.young_modulus, contact.poisson_ratio, rigid_wall,
                     damped ? hertz_dashpot_factor(*contact.restitution) : 0);
  }
  return AreaLaw{normal_stiffness, shear_stiffness,
                 damped ? area_dashpot_factor(*contact.restitution) : 0,
                 dashpot ? contact.viscosity : 0};
}

std::vector<std::pair<std::string, PlaneSurface>> box_sides(const BoxConfig& box) {
  std::vector<std::pair<std::string, PlaneSurface>> sides{{".x-", {box.low, {1, 0, 0}}},
                                                          {".x+", {box.high, {-1, 0, 0}}},
                                                          {".y-", {box.low, {0, 1, 0}}},
                                                          {".y+", {box.high, {0, -1, 0}}},
                                                          {".z-", {box.low, {0, 0, 1}}}};
  if (!box.open_top) sides.push_back({".z+", {box.high, {0, 0, -1}}});
  return sides;
}

/// A wall's surfaces and what to add to its name: a box has several.
std::vector<std::pair<std::string, WallSurface>> surfaces(const WallConfig& wall) {
  if (const auto* plane = std::get_if<PlaneConfig>(&wall.geometry)) {
    return {{"", PlaneSurface{plane->point, normalized(plane->normal)}}};
  }
  if (const auto* cylinder = std::get_if<CylinderConfig>(&wall.geometry)) {
    return {{"", CylinderSurface{cylinder->point, normalized(cylinder->axis), cylinder->radius}}};
  }
  if (const auto* ledge = std::get_if<LedgeConfig>(&wall.geometry)) {
    return {{"", LedgeSurface{ledge->point, normalized(ledge->normal), normalized(ledge->top)}}};
  }
  const auto sides = box_sides(std::get<BoxConfig>(wall.geometry));
  return {sides.begin(), sides.end()};
}

constexpr double bond_shear_share = 0.4;  // of the normal stiffness, unless given

/// Of the membrane's nodes: leapfrog keeps their fastest oscillations stable with a wide margin.
constexpr double membrane_phase = 0.5;     // radians per step
constexpr double membrane_damping = 0.01;  // per step, unless given
constexpr double membrane_dashpot = 0.3;   // of what would be critical for a node alone
constexpr double membrane_softness = 0.1;  // of the stiffness of grains, unless given

}  // namespace

std::optional<BondLaw> make_bond_law(const SceneConfig& scene) {
  if (!scene.bond) return std::nullopt;
  const BondConfig& config = *scene.bond;
  const double normal = config.normal_stiffness.value_or(scene.contact.normal_stiffness);
  return BondLaw{normal, config.shear_stiffness.value_or(bond_shear_share * normal),
                 config.tensile_strength, config.shear_strength, config.radius_share};
}

std::optional<MembraneSetup> make_membrane(const SceneConfig& scene, std::span<const Wall> walls,
                                           double time_step) {
  if (!scene.membrane) return std::nullopt;
  const MembraneConfig& config = *scene.membrane;
  MembraneSetup setup;
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    if (walls[w].name == config.mould) setup.mould = WallId{w};
  }
  setup.spacing = config.spacing;
  setup.bond_stiffness = membrane_bond_stiffness(config.modulus * config.thickness);
  setup.contact.normal_stiffness =
      config.normal_stiffness.value_or(membrane_softness * scene.contact.normal_stiffness);
  setup.contact.shear_stiffness = setup.contact.normal_stiffness;
  setup.friction = config.friction;
  setup.ends = config.ends;
  setup.damping = config.damping.value_or(membrane_damping / time_step);
  double highest = 0;
  for (const StageConfig& stage : scene.stages) {
    if (stage.membrane) highest = std::max(highest, std::abs(stage.membrane->pressure));
  }
  setup.areal_mass = membrane_areal_mass(setup, highest, time_step, membrane_phase);
  setup.contact.viscosity =
      2 * membrane_dashpot * std::sqrt(setup.contact.normal_stiffness * setup.areal_mass);
  return setup;
}

std::vector<Wall> make_walls(const SceneConfig& scene) {
  std::vector<Wall> walls;
  for (const WallConfig& config : scene.walls) {
    const AnyContactLaw law = make_law(
        scene.contact, config.normal_stiffness.value_or(scene.contact.normal_stiffness),
        config.shear_stiffness.value_or(scene.contact.shear_stiffness), config.dashpot, 0, true);
    for (const auto& [suffix, surface] : surfaces(config)) {
      walls.push_back({config.name + suffix, surface, law,
                       config.friction.value_or(scene.material.friction), config.shortened_lever,
                       config.motion});
    }
  }
  return walls;
}

std::array<bool, 3> periodic_axes(const CellConfig& cell) {
  switch (cell.periodic) {
    case PeriodicAxes::xyz:
      return {true, true, true};
    case PeriodicAxes::xy:
      return {true, true, false};
    case PeriodicAxes::xz:
      return {true, false, true};
    case PeriodicAxes::yz:
      return {false, true, true};
    case PeriodicAxes::x:
      return {true, false, false};
    case PeriodicAxes::y:
      return {false, true, false};
    case PeriodicAxes::z:
      return {false, false, true};
  }
  return {};
}

std::vector<PlaneSurface> outflow_planes(const SceneConfig& scene) {
  std::vector<PlaneSurface> planes;
  for (const OutflowConfig& outflow : scene.outflows) {
    if (const auto* plane = std::get_if<PlaneConfig>(&outflow.geometry)) {
      planes.push_back({plane->point, normalized(plane->normal)});
      continue;
    }
    for (const auto& [suffix, side] : box_sides(std::get<BoxConfig>(outflow.geometry))) {
      planes.push_back(side);
    }
  }
  return planes;
}

PreparedScene prepare(const LoadedScene& scene, const Communicator& ranks) {
  const SceneConfig& config = scene.config;
  PreparedScene prepared;
  prepared.time_step = choose_time_step(config, scene.grains, scene.shapes);
  std::vector<ShapeOutline> outlines;
  double smallest_radius = std::numeric_limits<double>::infinity();
  for (const ShapeSummary& shape : scene.shapes) {
    smallest_radius = std::min(smallest_radius, shape.outline.bounding_radius);
    outlines.push_back(shape.outline);
    // Law `linear` counts nodes: only all of them mean what it says.
    if (config.contact.law == ContactLawKind::linear) outlines.back().sphere_radius = 0;
  }
  prepared.setup = {
      .shapes = ShapeStore{ranks, std::move(outlines), scene.read_shape},
      .density = config.material.inertial_density(),
      .contact = {make_law(config.contact, config.contact.normal_stiffness,
                           config.contact.shear_stiffness, true,
                           config.contact.node_cap.value_or(0), false),
                  config.material.friction, config.contact.master, make_bond_law(config)},
      .walls = make_walls(config),
      .membrane = {},
      .cell = {},
      .outflows = outflow_planes(config),
      .body_force = {config.body.gravity / config.material.density_scaling,
                     config.body.random_acceleration, config.body.random_interval, config.seed,
                     scene.own_accelerations},
      .damping = config.body.damping,
      .time_step = prepared.time_step.step,
      .stages = {},
      .skin = config.neighbor.skin * smallest_radius,
      .engine = config.neighbor.engine,
      .simd = resolve(config.neighbor.simd),
      .decomposition = config.parallel.decomposition,
  };
  prepared.setup.membrane = make_membrane(config, prepared.setup.walls, prepared.time_step.step);
  if (config.cell) {
    const BoxConfig& box = config.cell->box;
    prepared.setup.cell = CellSetup{.center = 0.5 * (box.low + box.high),
                                    .periodic = periodic_axes(*config.cell),
                                    .size = box.high - box.low};
  }
  prepared.setup.stages = make_stages(config, prepared.setup.walls);
  prepared.initial.grains = scene.grains;
  prepared.steps = config.time.steps.value_or(static_cast<std::uint64_t>(
      std::ceil(config.time.duration.value_or(0) / prepared.time_step.step * (1 - 1e-12))));
  for (const StageConfig& stage : config.stages) {
    prepared.steps += most_steps(stage, prepared.time_step.step);
  }
  return prepared;
}

}  // namespace reckon
