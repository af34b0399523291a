// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/stage_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "reckon/boundary/enclosure.hpp"
#include "reckon/simulation/stage_setup.hpp"

namespace reckon {

StageCheck::StageCheck(const LoadedScene& scene, Fault fault)
    : loaded_{scene},
      scene_{scene.config},
      fault_{std::move(fault)},
      walls_{make_walls(scene.config)},
      closed_{scene_.cell ? scene_.cell->periodic == PeriodicAxes::xyz
                          : enclosure_of(walls_, poses_at(walls_, {}, 0, 1)).has_value()} {}

void StageCheck::run() {
  check_membrane();
  if (scene_.cell) check_cell(loaded_);
  check_bonds();
  for (std::size_t n = 0; n < scene_.stages.size(); ++n) {
    const StageConfig& stage = scene_.stages[n];
    const std::string key = fmt::format("stage[{}]", n);
    std::vector<bool> controlled(walls_.size(), false);
    std::vector<bool> driven(6, false);  // parts of the cell
    for (std::size_t c = 0; c < stage.controls.size(); ++c) {
      const std::string control = fmt::format("{}.control[{}]", key, c);
      if (scene_.cell && !cell_axes_named(stage.controls[c].wall).empty()) {
        check_cell_control(stage.controls[c], control, driven);
      } else {
        check_control(stage.controls[c], control, controlled);
      }
    }
    check_goal(stage, key);
  }
}

void StageCheck::check_control(const ControlConfig& control, const std::string& key,
                               std::vector<bool>& controlled) {
  std::vector<WallId> planes;
  for (const auto& group : planes_named(walls_, control.wall)) {
    planes.insert(planes.end(), group.begin(), group.end());
  }
  if (planes.empty()) {
    return fault_(key + ".wall",
                  fmt::format("no plane or pair of planes is named \"{}\"", control.wall),
                  known_planes());
  }
  for (const WallId plane : planes) {
    if (controlled[plane.get()]) {
      fault_(key + ".wall",
             fmt::format("\"{}\" is moved by another control of this stage already",
                         walls_[plane.get()].name),
             "Give one control per plane.");
    }
    controlled[plane.get()] = true;
  }
  if (control.target != WallTarget::speed && !closed_) {
    fault_(key, "needs walls that close off a space, which these do not",
           "Close it: six planes, a box with its top, or a cylinder between two planes.");
  }
  if (control.target == WallTarget::stress && !control.rate_limit) {
    fault_(key, "needs a `rate_limit`", "There is none by rule for a stress of zero.");
  }
}

void StageCheck::check_membrane() {
  const auto& stages = scene_.stages;
  const auto has_pressure = [](const StageConfig& s) { return s.membrane.has_value(); };
  const auto first = std::find_if(stages.begin(), stages.end(), has_pressure);
  if (!scene_.membrane) {
    if (first != stages.end()) {
      fault_(fmt::format("stage[{}].membrane", first - stages.begin()),
             "gives a pressure for a membrane that the scene does not have",
             "Describe it in a table [membrane].");
    }
    return;
  }
  const MembraneConfig& membrane = *scene_.membrane;
  if (first == stages.end()) {
    fault_("membrane", "never takes its place, since no stage gives it a pressure",
           "Add `membrane = { pressure = ... }` to a stage.");
  }
  if (!membrane.normal_stiffness && scene_.contact.law != ContactLawKind::area) {
    fault_("membrane", "needs a `normal_stiffness`",
           "There is none by rule unless the contact law is `area`.");
  }
  const auto mould = std::find_if(walls_.begin(), walls_.end(),
                                  [&](const Wall& wall) { return wall.name == membrane.mould; });
  if (mould == walls_.end() || !std::holds_alternative<CylinderSurface>(mould->surface)) {
    return fault_("membrane.mould", fmt::format("no cylinder is named \"{}\"", membrane.mould),
                  "Name the cylinder wall that holds the sample until then.");
  }
  const WallId id{static_cast<std::uint32_t>(mould - walls_.begin())};
  const auto closed = closed_cylinder(walls_, poses_at(walls_, {}, 0, 1), id);
  if (!closed) {
    return fault_("membrane.mould", "has not a plane at right angles to it at each end",
                  "Add them: they hold the ends of the membrane.");
  }
  const CylinderPlace& place = closed->place;
  if (!(membrane.spacing <= place.radius)) {
    fault_("membrane.spacing", "is larger than the radius of the mould",
           "A third of a grain's diameter is good.");
  }
  constexpr double most_nodes = 4e6;
  const double nodes = MembraneMesh::expected_size(place, membrane.spacing);
  if (nodes > most_nodes) {
    fault_("membrane.spacing",
           fmt::format("makes {:.3g} nodes, more than {:.0g}", nodes, most_nodes),
           "A third of a grain's diameter is good.");
  }
}

void StageCheck::check_bonds() {
  const auto& stages = scene_.stages;
  const auto setting = std::find_if(stages.begin(), stages.end(),
                                    [](const StageConfig& stage) { return stage.bond; });
  if (!scene_.bond) {
    if (setting == stages.end()) return;
    return fault_(fmt::format("stage[{}].bond", setting - stages.begin()),
                  "sets cement that the scene does not describe", "Add a table [bond].");
  }
  if (setting == stages.end()) {
    fault_("bond", "is never set", "Add `bond = true` to the stage at whose start grains join.");
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (const ShapeSummary& shape : loaded_.shapes) {
    smallest = std::min(smallest, shape.outline.bounding_radius);
  }
  if (const double gap = make_bond_law(scene_)->longest_gap(); gap > smallest) {
    fault_("bond",
           fmt::format("opens by {:.3g} m before it breaks, more than the radius of a grain", gap),
           "Raise the stiffnesses or lower the strengths: it breaks at strength over stiffness.");
  }
}

void StageCheck::check_goal(const StageConfig& stage, const std::string& key) {
  if (!stage.until) return;
  const StageGoal& goal = *stage.until;
  const auto is_driven = [](const ControlConfig& c) { return c.target != WallTarget::stress; };
  const auto& controls = stage.controls;
  const bool asks_for_stress = goal.stress_above || goal.stress_below;
  if (!goal.wall.empty()) {
    const bool is_part = scene_.cell && !cell_axes_named(goal.wall).empty();
    if (!is_part && planes_named(walls_, goal.wall).empty()) {
      fault_(key + ".until.wall",
             fmt::format("no plane or pair of planes is named \"{}\"", goal.wall), known_planes());
    }
    if (!asks_for_stress && !goal.strain) {
      fault_(key + ".until.wall", "is of no use without a `strain` or a stress of it",
             "Add `strain`, `stress_above` or `stress_below`, or leave it out.");
    }
  }
  const bool driven = std::any_of(controls.begin(), controls.end(), is_driven);
  const bool held = !std::all_of(controls.begin(), controls.end(), is_driven);
  if (asks_for_stress && goal.wall.empty() && std::ranges::count_if(controls, is_driven) > 1) {
    fault_(key + ".until", "asks for a stress, but several controls drive something",
           "Name one of them by `wall`.");
  }
  if (asks_for_stress && goal.wall.empty() && !driven) {
    fault_(key + ".until", "asks for the stress on walls that are driven, but none is",
           "Add a control with `strain_rate` or `speed`, or name a `wall`.");
  }
  if (goal.stress_error && !held) {
    fault_(key + ".until", "asks how well servos hold their stress, but there is none",
           "Add a control with `stress`.");
  }
  const bool needs_space = goal.strain || goal.stress_above || goal.stress_below || goal.void_ratio;
  if (needs_space && !closed_) {
    fault_(key + ".until", "needs walls that close off a space, which these do not", "");
  }
}

std::string StageCheck::known_planes() const {
  std::string names;
  for (const Wall& wall : walls_) {
    if (!std::holds_alternative<PlaneSurface>(wall.surface)) continue;
    names += (names.empty() ? "" : ", ") + wall.name;
  }
  if (scene_.cell) names += (names.empty() ? "" : ", ") + std::string{"cell, cell.x, cell.xy, ..."};
  return names.empty() ? "The scene has no planes." : fmt::format("There are: {}.", names);
}

}  // namespace reckon
