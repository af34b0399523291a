// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "reckon/output/run_folder.hpp"
#include "reckon/report/display_mesh.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/shape/shape.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// How many grains have each shape, by ShapeId. Not a list by shape: a damaged file may name any.
using GrainsByShape = std::map<std::uint32_t, std::uint64_t>;

/// At the first saved step that can be read.
[[nodiscard]] GrainsByShape grains_by_shape(const RunFolder& folder);

/// One shape as the page shows it.
struct RunShape {
  std::string name;
  std::vector<double> measures;  ///< as shape_measures() lists them
  double volume{0};              ///< [m^3]
  DisplayMesh fine;
  DisplayMesh coarse;  ///< for machines that cannot turn the fine ones smoothly
};

struct RunShapes {
  std::vector<RunShape> shapes;  ///< by ShapeId; those that no grain has are without surfaces
  GrainsByShape grains;
  std::string missing;  ///< why there are none; empty where there are
};

/// The shapes of a run from the libraries that `scene` names. `grains` is the number of grains of
/// each shape: the more grains and shapes, the fewer triangles each. Where a checkpoint shows that
/// the libraries are not those that ran, or one is missing, there are none, and it states the
/// reason.
[[nodiscard]] RunShapes read_run_shapes(const RunFolder& folder, const SceneConfig& scene,
                                        const GrainsByShape& grains);

}  // namespace reckon
