// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// StageCheck's part on periodic cells.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "reckon/neighbor/adaptive_skin.hpp"
#include "reckon/scene/stage_check.hpp"
#include "reckon/simulation/stage_setup.hpp"

namespace reckon {
namespace {

constexpr std::array axis_names{"x", "y", "z"};

/// The two axes of shear, or one twice.
std::array<std::size_t, 2> axes_of(CellAxis axis) {
  switch (axis) {
    case CellAxis::xy:
      return {0, 1};
    case CellAxis::xz:
      return {0, 2};
    case CellAxis::yz:
      return {1, 2};
    default:
      return {static_cast<std::size_t>(axis), static_cast<std::size_t>(axis)};
  }
}

/// Whether a wall is invariant along an axis.
bool is_same_along(const WallSurface& surface, int axis) {
  if (const auto* plane = std::get_if<PlaneSurface>(&surface)) return plane->normal_unit[axis] == 0;
  if (const auto* ledge = std::get_if<LedgeSurface>(&surface)) {
    return ledge->normal_unit[axis] == 0 && ledge->top_unit[axis] == 0;
  }
  const Vec3& along = std::get<CylinderSurface>(surface).axis_unit;
  return along[(axis + 1) % 3] == 0 && along[(axis + 2) % 3] == 0;
}

}  // namespace

void StageCheck::check_cell(const LoadedScene& scene) {
  const std::array<bool, 3> periodic = periodic_axes(*scene_.cell);
  check_walls_in_cell();
  check_room_in_cell(scene);
  if (scene_.membrane) {
    fault_("membrane", "cannot be together with a periodic cell",
           "Leave out [membrane] or [cell].");
  }
  if (scene_.parallel.decomposition == DecompositionKind::bins) {
    fault_("parallel.decomposition", "`bins` knows no periodic cell",
           "Take `balanced`, `grid` or `replicated`.");
  }
  const auto is_fixed = [](const GrainState& grain) { return grain.prescribed; };
  const auto fixed = std::find_if(scene.grains.begin(), scene.grains.end(), is_fixed);
  if (fixed != scene.grains.end()) {
    fault_(
        "grains",
        fmt::format("grain {} is fixed, but a periodic cell has no fixed place", fixed->id.get()),
        "Let all grains move.");
  }
  const auto falls = [&](const Vec3& gravity) {
    return periodic[0] && periodic[1] && periodic[2] && gravity != Vec3{};
  };
  bool some_fall = falls(scene_.body.gravity);
  for (const StageConfig& stage : scene_.stages) some_fall |= falls(stage.gravity.value_or(Vec3{}));
  if (some_fall) {
    fault_("body.gravity",
           "lets all grains fall for ever in a cell that is periodic along all axes",
           "Leave gravity out, or put a floor at one axis and take it out of `cell.periodic`.");
  }
}

void StageCheck::check_walls_in_cell() {
  const std::array<bool, 3> periodic = periodic_axes(*scene_.cell);
  const auto first_crossed = [&](const WallSurface& surface) -> const char* {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (periodic[axis] && !is_same_along(surface, static_cast<int>(axis)))
        return axis_names[axis];
    }
    return nullptr;
  };
  for (const Wall& wall : walls_) {
    if (wall.name == "cell") {
      fault_("wall", "a wall is named \"cell\", as the periodic cell is in controls",
             "Give it another name.");
    }
    if (const char* axis = first_crossed(wall.surface)) {
      fault_("wall",
             fmt::format("wall {} stands across {}, along which the cell is periodic", wall.name,
                         axis),
             "Leave that axis out of `cell.periodic`, or the wall out of the scene.");
    }
  }
  for (const PlaneSurface& plane : outflow_planes(scene_)) {
    if (const char* axis = first_crossed(plane)) {
      return fault_("outflow",
                    fmt::format("stands across {}, along which the cell is periodic", axis),
                    "Leave that axis out of `cell.periodic`, or the outflow out of the scene.");
    }
  }
}

void StageCheck::check_room_in_cell(const LoadedScene& scene) {
  const std::array<bool, 3> periodic = periodic_axes(*scene_.cell);
  const BoxConfig& box = scene_.cell->box;
  double largest = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (const ShapeSummary& shape : scene.shapes) {
    largest = std::max(largest, shape.outline.bounding_radius);
    smallest = std::min(smallest, shape.outline.bounding_radius);
  }
  const AdaptiveSkin skin = AdaptiveSkin::with(scene_.neighbor.skin * smallest, 0);
  const double least = 4 * (largest + skin.max);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!periodic[a]) continue;
    const double width = box.high[axis] - box.low[axis];
    if (width < least) {
      fault_("cell",
             fmt::format("is {:.4g} m wide along {}, but must be {:.4g} m at least", width,
                         axis_names[a], least),
             "In a narrower one two grains could touch through two images at once.");
    }
    for (std::size_t set = 0; set < scene_.grains.size(); ++set) {
      const auto* fill = std::get_if<FillPlacement>(&scene_.grains[set].placement);
      const auto* region = fill != nullptr ? std::get_if<BoxConfig>(&fill->region) : nullptr;
      if (region == nullptr) continue;
      if (region->low[axis] < box.low[axis] || region->high[axis] > box.high[axis]) {
        fault_(fmt::format("grains[{}].fill", set),
               fmt::format("reaches beyond the periodic cell along {}", axis_names[a]),
               "Grains outside would lie upon images of those inside.");
      }
    }
  }
}

void StageCheck::check_cell_control(const ControlConfig& control, const std::string& key,
                                    std::vector<bool>& driven) {
  const std::array<bool, 3> periodic = periodic_axes(*scene_.cell);
  for (const CellAxis axis : cell_axes_named(control.wall)) {
    for (const std::size_t a : axes_of(axis)) {
      if (periodic[a]) continue;
      fault_(key + ".wall", fmt::format("the cell is not periodic along {}", axis_names[a]),
             "Only what is periodic can be deformed.");
      break;
    }
    if (driven[static_cast<std::size_t>(axis)]) {
      fault_(key + ".wall", "another control of this stage moves this part of the cell already",
             "Give one control per part.");
    }
    driven[static_cast<std::size_t>(axis)] = true;
    if (is_shear(axis) && control.target != WallTarget::strain_rate) {
      return fault_(key, "shear takes a `strain_rate` only", "");
    }
  }
  if (control.target == WallTarget::speed) {
    fault_(key, "a cell takes a `stress` or a `strain_rate`, no `speed`", "");
  }
  if (control.target == WallTarget::stress && !closed_) {
    fault_(key, "a stress needs a cell that is periodic along all axes",
           "Take a `strain_rate`, or walls along the other axes.");
  }
  if (control.target == WallTarget::stress && !control.rate_limit) {
    fault_(key, "needs a `rate_limit`", "There is none by rule for a stress of zero.");
  }
}

}  // namespace reckon
