// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "reckon/scene/describe_geometry.hpp"
#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): the periodic cell.
namespace reckon {

template <class Visitor>
void describe(Visitor& v, CellConfig& cell) {
  describe_corners(v, cell.box);
  constexpr std::array axes{Choice{"xyz", PeriodicAxes::xyz}, Choice{"xy", PeriodicAxes::xy},
                            Choice{"xz", PeriodicAxes::xz},   Choice{"yz", PeriodicAxes::yz},
                            Choice{"x", PeriodicAxes::x},     Choice{"y", PeriodicAxes::y},
                            Choice{"z", PeriodicAxes::z}};
  v.choice({.name = "periodic",
            .meaning = "Axes along which space repeats itself from `low` to `high`; along others "
                       "it is open, or closed by walls."},
           cell.periodic, axes);
}

}  // namespace reckon
