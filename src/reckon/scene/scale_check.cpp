// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scale_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

namespace reckon {
namespace {

/// Rounding of a coordinate as a share of the smallest grain's radius. Overlaps of quasi-static
/// tests are about 1e-4 of a radius: they keep two digits up to the first limit, none beyond the
/// second.
constexpr double coarse_rounding = 1e-6;
constexpr double useless_rounding = 1e-3;

constexpr double lightest = 10;  // foams [kg/m^3]
constexpr double roughest = 5;   // of friction

/// How far things may move in one step, as a share of the smallest grain's radius.
constexpr double long_path = 0.1;
constexpr double large_turn = 0.1;  // in one step [rad]

constexpr double least_steps_per_period = 20;
constexpr double sampling_limit = 2;  // steps per period: below, the motion is another one

/// Above this share of the smallest grain's width, grains find their way between the nodes.
constexpr double wide_mesh = 0.5;

double largest_of(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The mean of the two smaller diameters of the ellipsoid with the same inertia: what must fit
/// through a hole that a grain passes end-on [m].
double width_of(const MassProperties& mass) {
  const Vec3& i = mass.inertia;
  const double sum = i.x + i.y + i.z;
  std::vector<double> diameters;
  for (int axis = 0; axis < 3; ++axis) {
    const double square = 2.5 * std::max(sum - 2 * i[axis], 0.0) / mass.volume;
    diameters.push_back(2 * std::sqrt(square));
  }
  std::sort(diameters.begin(), diameters.end());
  return std::sqrt(diameters[0] * diameters[1]);
}

}  // namespace

ScaleCheck::ScaleCheck(const LoadedScene& scene, double time_step, Fault fault, Warn warn)
    : scene_{scene},
      time_step_{time_step},
      fault_{std::move(fault)},
      warn_{std::move(warn)},
      smallest_radius_{std::numeric_limits<double>::infinity()} {
  for (const GrainState& grain : scene.grains) {
    smallest_radius_ =
        std::min(smallest_radius_, scene.shapes[grain.shape.get()].outline.bounding_radius);
  }
}

void ScaleCheck::run() {
  check_material();
  check_coordinates();
  check_speeds();
  check_walls();
  check_controls();
  check_membrane();
}

void ScaleCheck::check_coordinate(const std::string& key, const std::string& what,
                                  double coordinate) {
  const double rounding = std::numeric_limits<double>::epsilon() * coordinate / smallest_radius_;
  if (rounding > useless_rounding) {
    resolves_positions_ = false;
    return fault_(key,
                  fmt::format("{} at {:.3g} m is beyond double precision: coordinates there are "
                              "{:.2g} m apart, but the smallest grain's radius is {:.3g} m",
                              what, coordinate, rounding * smallest_radius_, smallest_radius_),
                  "Move the scene near the origin.");
  }
  if (rounding > coarse_rounding) {
    warn_(
        fmt::format("{} at {:.3g} m is rounded to {:.2g} of the smallest grain's radius, which "
                    "is coarse for the overlap of a contact; move the scene near the origin",
                    what, coordinate, rounding));
  }
}

void ScaleCheck::check_material() {
  const double density = scene_.config.material.density;
  if (density < lightest) {
    warn_(
        fmt::format("a density of {:g} kg/m^3 is less than that of any solid; if g/cm^3 was "
                    "meant, write \"{:g} g/cm^3\"",
                    density, density));
  }
  const double friction = scene_.config.material.friction;
  if (friction > roughest) {
    warn_(
        fmt::format("a coefficient of friction of {:g} is far above any measured; if an angle in "
                    "degrees was meant, write its tangent",
                    friction));
  }
}

void ScaleCheck::check_coordinates() {
  const auto& grains = scene_.grains;
  const auto farthest =
      std::max_element(grains.begin(), grains.end(), [](const GrainState& a, const GrainState& b) {
        return largest_of(a.position) < largest_of(b.position);
      });
  check_coordinate("grains", fmt::format("grain {}", farthest->id.get()),
                   largest_of(farthest->position));
  for (std::size_t n = 0; n < scene_.config.walls.size(); ++n) {
    const WallConfig& wall = scene_.config.walls[n];
    const std::string key = fmt::format("wall[{}]", n);
    const std::string name = fmt::format("wall \"{}\"", wall.name);
    // A plane at right angles to an axis may stand anywhere: grains near it are near the origin.
    const auto* plane = std::get_if<PlaneConfig>(&wall.geometry);
    if (plane != nullptr && largest_of(plane->normal) < norm(plane->normal)) {
      check_coordinate(key, "the point of " + name, largest_of(plane->point));
    } else if (const auto* ledge = std::get_if<LedgeConfig>(&wall.geometry)) {
      check_coordinate(key, "the edge of " + name, largest_of(ledge->point));
    } else if (const auto* cylinder = std::get_if<CylinderConfig>(&wall.geometry)) {
      check_coordinate(key, "the axis of " + name, largest_of(cylinder->point));
      check_coordinate(key, "the radius of " + name, cylinder->radius);
    }
  }
}

void ScaleCheck::check_path(const std::string& what, double speed) {
  const double path = speed * time_step_ / smallest_radius_;
  if (!(path > long_path)) return;
  warn_(
      fmt::format("{} moves {:.2g} of the smallest grain's radius in one time step of {:.3g} s "
                  "({:.3g} m/s) and may pass through grains; shorten time.step",
                  what, path, time_step_, speed));
}

void ScaleCheck::check_speeds() {
  const auto& grains = scene_.grains;
  const auto fastest =
      std::max_element(grains.begin(), grains.end(), [](const GrainState& a, const GrainState& b) {
        return squared_norm(a.velocity) < squared_norm(b.velocity);
      });
  check_path(fmt::format("grain {}", fastest->id.get()), norm(fastest->velocity));
  const auto spinning =
      std::max_element(grains.begin(), grains.end(), [](const GrainState& a, const GrainState& b) {
        return squared_norm(a.angular_velocity_body) < squared_norm(b.angular_velocity_body);
      });
  const double turn = norm(spinning->angular_velocity_body) * time_step_;
  if (turn > large_turn) {
    warn_(
        fmt::format("grain {} turns by {:.2g} rad in one time step of {:.3g} s; shorten time.step",
                    spinning->id.get(), turn, time_step_));
  }
}

void ScaleCheck::check_walls() {
  for (std::size_t n = 0; n < scene_.config.walls.size(); ++n) {
    const WallConfig& wall = scene_.config.walls[n];
    if (!wall.motion) continue;
    const std::string name = fmt::format("wall \"{}\"", wall.name);
    const WallMotion& motion = *wall.motion;
    const double swing = norm(motion.amplitude);
    check_path(name, norm(motion.velocity) + 2 * std::numbers::pi * motion.frequency * swing);
    if (!(motion.frequency > 0 && swing > 0)) continue;
    const double steps = 1 / (motion.frequency * time_step_);
    const std::string problem =
        fmt::format("{} oscillates at {:.4g} Hz: a period has {:.3g} time steps of {:.3g} s", name,
                    motion.frequency, steps, time_step_);
    if (steps < sampling_limit) {
      fault_(fmt::format("wall[{}].motion", n), problem + ", fewer than two",
             fmt::format("Lower the frequency, or give a time.step of {:.3g} s or less.",
                         1 / (motion.frequency * least_steps_per_period)));
    } else if (steps < least_steps_per_period) {
      warn_(fmt::format("{}, fewer than {:g}; shorten time.step", problem, least_steps_per_period));
    }
  }
}

void ScaleCheck::check_controls() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3 low{inf, inf, inf};
  Vec3 high{-inf, -inf, -inf};
  for (const GrainState& grain : scene_.grains) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], grain.position[axis]);
      high[axis] = std::max(high[axis], grain.position[axis]);
    }
  }
  const double extent = largest_of(high - low) + 2 * smallest_radius_;
  for (std::size_t n = 0; n < scene_.config.stages.size(); ++n) {
    const StageConfig& stage = scene_.config.stages[n];
    for (const ControlConfig& control : stage.controls) {
      const std::string what = fmt::format("\"{}\" in stage {}", control.wall, n + 1);
      if (control.target == WallTarget::speed) check_path(what, std::abs(control.value));
      if (control.target == WallTarget::strain_rate) {
        check_path(what, std::abs(control.value) * extent);
      }
    }
  }
}

void ScaleCheck::check_membrane() {
  if (!scene_.config.membrane) return;
  const double spacing = scene_.config.membrane->spacing;
  const GrainState* narrowest = nullptr;
  double width = std::numeric_limits<double>::infinity();
  for (const GrainState& grain : scene_.grains) {
    const double own = width_of(scene_.shapes[grain.shape.get()].outline.mass);
    if (own < width) {
      width = own;
      narrowest = &grain;
    }
  }
  if (narrowest == nullptr || !(spacing > wide_mesh * width)) return;
  warn_(fmt::format(
      "the membrane's mesh may let grains through: its nodes are {:.3g} m apart, {:.2g} "
      "of the width of the smallest grain (grain {}, {:.3g} m wide); take a "
      "membrane.spacing of {:.2g} m or less",
      spacing, spacing / width, narrowest->id.get(), width, wide_mesh * width));
}

}  // namespace reckon
