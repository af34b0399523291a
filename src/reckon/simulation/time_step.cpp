// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reckon/simulation/setup.hpp"

namespace reckon {
namespace {

constexpr double touching_share = 0.05;  // of a grain's surface or nodes
constexpr double bonds_of_grain = 6;     // in a dense packing

double contact_stiffness(const ContactConfig& contact, double node_stiffness, bool capped,
                         const ShapeSummary& shape) {
  if (contact.law == ContactLawKind::area) {
    return node_stiffness * touching_share * shape.node_area;
  }
  if (contact.law == ContactLawKind::hertz) {
    const HertzLaw law = hertz_law(contact.young_modulus, contact.poisson_ratio, true, 0);
    const double area = touching_share * shape.node_area;  // 2 pi R d, where a^2 = R d
    return 2 * law.normal_modulus * std::sqrt(area / (2 * std::numbers::pi));
  }
  const double nodes = capped ? static_cast<double>(*contact.node_cap)
                              : touching_share * static_cast<double>(shape.outline.nodes);
  return node_stiffness * std::max(nodes, 1.0);
}

double bond_stiffness(const BondLaw& cement, const ShapeSummary& shape) {
  const double radius = cement.bond_radius(sphere_radius_of(shape.outline.mass.volume));
  return std::max(cement.normal_stiffness, cement.shear_stiffness) * std::numbers::pi * radius *
         radius;
}

}  // namespace

TimeStepChoice choose_time_step(const SceneConfig& scene, std::span<const GrainState> grains,
                                std::span<const ShapeSummary> shapes) {
  double largest = std::max(scene.contact.normal_stiffness, scene.contact.shear_stiffness);
  for (const WallConfig& wall : scene.walls) {
    largest =
        std::max({largest, wall.normal_stiffness.value_or(0), wall.shear_stiffness.value_or(0)});
  }
  const bool capped = scene.contact.node_cap && scene.walls.empty();  // walls know no cap
  const std::optional<BondLaw> cement = make_bond_law(scene);
  std::vector<double> stiffness;
  for (const ShapeSummary& shape : shapes) {
    stiffness.push_back(contact_stiffness(scene.contact, largest, capped, shape));
    if (cement) stiffness.back() += bonds_of_grain * bond_stiffness(*cement, shape);
  }
  TimeStepChoice choice;
  double slowest = std::numeric_limits<double>::infinity();
  for (const GrainState& grain : grains) {
    if (grain.prescribed) continue;
    const std::size_t s = grain.shape.get();
    const double mass = scene.material.inertial_density() * shapes[s].outline.mass.volume;
    if (mass / stiffness[s] < slowest) {
      slowest = mass / stiffness[s];
      choice.limiting = grain.id;
      choice.mass = mass;
      choice.stiffness = stiffness[s];
    }
  }
  choice.rule_step = scene.time.step_fraction * std::sqrt(slowest);
  choice.given = scene.time.step.has_value();
  choice.step = scene.time.step.value_or(choice.rule_step);
  return choice;
}

}  // namespace reckon
