// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/overlap_forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reckon/simulation/stage_setup.hpp"

namespace reckon {
namespace {

constexpr double pi = std::numbers::pi;

/// The largest stress that servos hold, a membrane brings or a goal waits for [Pa].
double stress_of_stages(const SceneConfig& scene) {
  double largest = 0;
  for (const StageConfig& stage : scene.stages) {
    for (const ControlConfig& control : stage.controls) {
      if (control.target == WallTarget::stress) largest = std::max(largest, control.value);
    }
    if (stage.membrane) largest = std::max(largest, stage.membrane->pressure);
    if (stage.until) largest = std::max(largest, stage.until->stress_above.value_or(0));
  }
  return largest;
}

/// The weight of all grains over the ground that they cover as placed [Pa].
double stress_of_weight(const LoadedScene& scene, double diameter) {
  const Vec3& gravity = scene.config.body.gravity;
  const double strength = norm(gravity);
  if (!(strength > 0)) return 0;
  constexpr double far = std::numeric_limits<double>::infinity();
  Vec3 low{far, far, far};
  Vec3 high{-far, -far, -far};
  double volume = 0;
  for (const GrainState& grain : scene.grains) {
    volume += scene.shapes[grain.shape.get()].outline.mass.volume;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], grain.position[axis]);
      high[axis] = std::max(high[axis], grain.position[axis]);
    }
  }
  const Vec3 size = high - low + Vec3{diameter, diameter, diameter};
  const Vec3 down = gravity / strength;
  // The box seen along gravity.
  const double ground = std::abs(down.x) * size.y * size.z + std::abs(down.y) * size.x * size.z +
                        std::abs(down.z) * size.x * size.y;
  return scene.config.material.density * volume * strength / ground;
}

/// The overlap of two spheres at a stiffness per area [m].
double overlap_by_area(double force, double stiffness, double diameter) {
  return std::sqrt(4 * force / (pi * stiffness * diameter));
}

double overlap_by_nodes(double force, const ContactConfig& contact, const LoadedScene& scene,
                        double diameter) {
  double area = 0;
  double nodes = 0;
  for (const GrainState& grain : scene.grains) {
    const ShapeSummary& shape = scene.shapes[grain.shape.get()];
    area += shape.node_area;
    nodes += static_cast<double>(shape.outline.nodes);
  }
  const double node_area = area / nodes;
  const double overlap = overlap_by_area(force, contact.normal_stiffness / node_area, diameter);
  if (!contact.node_cap) return overlap;
  const auto cap = static_cast<double>(*contact.node_cap);
  const double touching = pi * 0.5 * diameter * overlap / node_area;
  return touching <= cap ? overlap : 2 * force / (contact.normal_stiffness * cap);
}

double overlap_at(double force, const LoadedScene& scene, double diameter) {
  const ContactConfig& contact = scene.config.contact;
  switch (contact.law) {
    case ContactLawKind::area:
      return overlap_by_area(force, contact.normal_stiffness, diameter);
    case ContactLawKind::linear:
      return overlap_by_nodes(force, contact, scene, diameter);
    case ContactLawKind::hertz: {
      const double nu = contact.poisson_ratio;
      const double modulus = contact.young_modulus / (2 * (1 - nu * nu));
      return std::pow(0.75 * force / (modulus * std::sqrt(0.25 * diameter)), 2.0 / 3);
    }
  }
  return 0;
}

}  // namespace

std::optional<OverlapForecast> forecast_overlap(const LoadedScene& scene) {
  if (scene.grains.empty()) return std::nullopt;
  const double diameter = mean_diameter(scene.grains, scene.shapes);
  const double held = stress_of_stages(scene.config);
  const double weight = stress_of_weight(scene, diameter);
  OverlapForecast forecast{.stress = std::max(held, weight), .of_weight = weight > held};
  if (!(forecast.stress > 0)) return std::nullopt;
  const double force = forecast.stress * diameter * diameter;
  forecast.ratio = overlap_at(force, scene, diameter) / diameter;
  return forecast;
}

std::string overlap_line(const OverlapForecast& forecast) {
  return fmt::format(
      "about {:.2g} % of a grain's diameter at {:.4g} Pa{}", 100 * forecast.ratio, forecast.stress,
      forecast.of_weight ? ", the weight of the grains over the ground they cover" : "");
}

}  // namespace reckon
