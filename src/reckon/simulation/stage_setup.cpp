// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/stage_setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "reckon/core/exact_sum.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {

std::vector<std::vector<WallId>> planes_named(std::span<const Wall> walls, std::string_view name) {
  const auto find = [&](const std::string& wanted) {
    std::vector<WallId> found;
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
      const bool is_plane = std::holds_alternative<PlaneSurface>(walls[w].surface);
      if (walls[w].name == wanted && is_plane) found.emplace_back(w);
    }
    return found;
  };
  const auto find_pair = [&](const std::string& wanted) {
    std::vector<WallId> found = find(wanted + "-");
    const std::vector<WallId> high = find(wanted + "+");
    found.insert(found.end(), high.begin(), high.end());
    return found;
  };
  const std::string wanted{name};
  if (const auto plane = find(wanted); !plane.empty()) return {plane};
  if (const auto pair = find_pair(wanted); pair.size() == 2) return {pair};
  std::vector<std::vector<WallId>> box;
  for (const char* axis : {".x", ".y", ".z"}) {
    if (auto pair = find_pair(wanted + axis); pair.size() == 2) box.push_back(std::move(pair));
  }
  if (box.size() != 3) box.clear();
  return box;
}

std::vector<CellAxis> cell_axes_named(std::string_view name) {
  if (name == "cell") return {CellAxis::x, CellAxis::y, CellAxis::z};
  constexpr std::array names{"cell.x", "cell.y", "cell.z", "cell.xy", "cell.xz", "cell.yz"};
  const auto* const found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return {static_cast<CellAxis>(found - names.begin())};
}

const ControlConfig* driven_control(const StageConfig& stage) {
  const ControlConfig* found = nullptr;
  for (const ControlConfig& control : stage.controls) {
    if (control.target == WallTarget::stress) continue;
    if (found == nullptr || std::abs(control.value) > std::abs(found->value)) found = &control;
  }
  return found;
}

namespace {

std::optional<DrivenAxis> driven_axis(const SceneConfig& scene, const StageConfig& stage,
                                      std::span<const Wall> walls) {
  const ControlConfig* control = driven_control(stage);
  if (control == nullptr) return std::nullopt;
  if (const auto parts = cell_axes_named(scene.cell ? control->wall : ""); !parts.empty()) {
    Vec3 normal;
    if (!is_shear(parts.front())) normal[static_cast<int>(parts.front())] = 1;
    return DrivenAxis{.normal_unit = normal, .walls = {}, .cell = parts.front()};
  }
  const auto planes = planes_named(walls, control->wall);
  if (planes.empty()) return std::nullopt;
  const Wall& first = walls[planes.front().front().get()];
  return DrivenAxis{.normal_unit = std::get<PlaneSurface>(first.surface).normal_unit,
                    .walls = planes.front(),
                    .cell = {}};
}

/// Stages that drive nothing look along the axis of the one before that does, or of the next.
void set_axes(const SceneConfig& scene, std::span<const Wall> walls,
              std::vector<StageSetup>& stages) {
  std::optional<DrivenAxis> axis;
  for (const StageConfig& stage : scene.stages) {
    if (!axis) axis = driven_axis(scene, stage, walls);
  }
  for (std::size_t n = 0; n < stages.size(); ++n) {
    if (const auto own = driven_axis(scene, scene.stages[n], walls)) axis = own;
    if (axis) stages[n].axis = *axis;
  }
}

}  // namespace

double mean_diameter(std::span<const GrainState> grains, std::span<const ShapeSummary> shapes) {
  ExactSum volumes;
  ExactSum weighted;
  for (const GrainState& grain : grains) {
    const double volume = shapes[grain.shape.get()].outline.mass.volume;
    volumes.add(volume);
    weighted.add(volume * portable::cbrt(6 / std::numbers::pi * volume));
  }
  return weighted.value() / volumes.value();
}

double rate_at(double inertial_number, double stress, double diameter, double density) {
  return inertial_number * std::sqrt(stress / density) / diameter;
}

void resolve_rate_limits(SceneConfig& scene, std::span<const GrainState> grains,
                         std::span<const ShapeSummary> shapes) {
  if (scene.stages.empty() || grains.empty()) return;
  const double diameter = mean_diameter(grains, shapes);
  for (StageConfig& stage : scene.stages) {
    for (ControlConfig& control : stage.controls) {
      if (control.target != WallTarget::stress || control.rate_limit || !(control.value > 0)) {
        continue;
      }
      control.rate_limit = rate_at(servo_inertial_number, control.value, diameter,
                                   scene.material.inertial_density());
    }
  }
}

std::vector<StageSetup> make_stages(const SceneConfig& scene, std::span<const Wall> walls) {
  std::vector<StageSetup> stages;
  for (const StageConfig& config : scene.stages) {
    StageSetup stage{
        .name = config.name,
        .friction = config.friction.value_or(scene.material.friction),
        .gravity = config.gravity.value_or(scene.body.gravity) / scene.material.density_scaling,
        .damping = config.damping.value_or(scene.body.damping)};
    if (config.membrane) {
      stage.membrane = MembranePressure{config.membrane->pressure, config.membrane->ramp};
    } else if (!stages.empty() && stages.back().membrane) {
      stage.membrane = MembranePressure{stages.back().membrane->pressure, 0};
    }
    stage.sets_bonds = config.bond;
    for (const Wall& wall : walls) {
      stage.wall_friction.push_back(config.wall_friction.value_or(wall.friction));
    }
    for (const ControlConfig& control : config.controls) {
      for (const CellAxis axis : cell_axes_named(scene.cell ? control.wall : "")) {
        stage.cell_controls.push_back({.name = control.wall,
                                       .axis = axis,
                                       .target = control.target,
                                       .value = control.value,
                                       .gain = control.gain,
                                       .rate_limit = control.rate_limit.value_or(0)});
      }
      for (auto& planes : planes_named(walls, control.wall)) {
        stage.controls.push_back({.name = control.wall,
                                  .walls = std::move(planes),
                                  .target = control.target,
                                  .value = control.value,
                                  .gain = control.gain,
                                  .rate_limit = control.rate_limit.value_or(0)});
      }
    }
    stages.push_back(std::move(stage));
  }
  set_axes(scene, walls, stages);
  return stages;
}

std::uint64_t most_steps(const StageConfig& stage, double time_step) {
  return stage.steps.value_or(
      static_cast<std::uint64_t>(std::ceil(stage.duration.value_or(0) / time_step * (1 - 1e-12))));
}

}  // namespace reckon
