// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "workloads.hpp"

#include <algorithm>
#include <cmath>

#include "packing.hpp"
#include "reckon/simulation/placement.hpp"

namespace reckon::bench {
namespace {

constexpr double diameter = 2;  // [m]: of most grains; all else follows from the ratios
constexpr double skin = 0.1;

/// Squeezed along x and let out along z at constant volume; gives the rate for an inertial number.
Workload sheared(Packing packing, double inertial_number) {
  const double rate =
      inertial_number / (diameter * std::sqrt(packing.setup.density / packing.pressure));
  const Vec3 size = packing.high - packing.low;
  auto& walls = packing.setup.walls;
  walls[0].motion = WallMotion{.velocity = {0.5 * rate * size.x, 0, 0}};
  walls[1].motion = WallMotion{.velocity = {-0.5 * rate * size.x, 0, 0}};
  walls[4].motion = WallMotion{.velocity = {0, 0, -0.5 * rate * size.z}};
  walls[5].motion = WallMotion{.velocity = {0, 0, 0.5 * rate * size.z}};
  packing.setup.damping = 1;
  double volume = 0;
  for (const ShapeView& shape : packing.setup.shapes.views()) volume += shape.mass.volume;
  return {std::move(packing.setup), std::move(packing.state), inertial_number,
          volume / (size.x * size.y * size.z)};
}

const Material stiff_sand{.law = LinearLaw{1e8, 0.9e8, 0, 0}};
constexpr double stiff_time_step = 3e-4;
constexpr double stiff_pressure = 1e5;

std::shared_ptr<const ShapeLibrary> library(const std::vector<GrainKind>& kinds,
                                            std::uint32_t distinct) {
  return std::make_shared<const ShapeLibrary>(make_shapes(kinds, distinct));
}

Workload dense(std::uint32_t grains, const std::string& packing_file) {
  return sheared(squeeze(library({{diameter, grains, 279, 18}}, 12), stiff_sand, stiff_pressure,
                         stiff_time_step, skin, packing_file),
                 1e-3);
}

Workload dense_fine(std::uint32_t grains, const std::string& packing_file) {
  return sheared(squeeze(library({{diameter, grains, 5000, 50}}, 8), stiff_sand, stiff_pressure,
                         stiff_time_step, skin, packing_file),
                 1e-3);
}

Workload graded(std::uint32_t grains, const std::string& packing_file) {
  Material material = stiff_sand;
  material.master = MasterRule::smaller;
  const std::uint32_t large = std::max(grains / 1000, 2U);
  const std::uint32_t middle = std::max(grains / 50, 2U);
  return sheared(squeeze(library({{10 * diameter, large, 1500, 50},
                                  {4 * diameter, middle, 600, 30},
                                  {diameter, grains - large - middle, 279, 18}},
                                 8),
                         material, stiff_pressure, stiff_time_step, skin, packing_file),
                 1e-3);
}

Workload settle(std::uint32_t grains, const std::string& /*packing_file*/) {
  Workload work;
  const AreaLaw law{2e7, 1.8e7, area_dashpot_factor(0.5)};
  work.setup.shapes = library({{diameter, grains, 279, 18}}, 12);
  work.setup.density = 1000;
  work.setup.contact = {law, 0.5, MasterRule::lower_id};
  const double edge = 0.8 * diameter * std::cbrt(static_cast<double>(grains)) * 1.2;
  const BoxConfig box{{0, 0, 0}, {edge, edge, 100 * edge}};
  work.setup.walls = {{"x-", PlaneSurface{box.low, {1, 0, 0}}, law, 0.3, false, {}},
                      {"x+", PlaneSurface{box.high, {-1, 0, 0}}, law, 0.3, false, {}},
                      {"y-", PlaneSurface{box.low, {0, 1, 0}}, law, 0.3, false, {}},
                      {"y+", PlaneSurface{box.high, {0, -1, 0}}, law, 0.3, false, {}},
                      {"z-", PlaneSurface{box.low, {0, 0, 1}}, law, 0.3, false, {}}};
  work.setup.body_force.gravity = {0, 0, -9.81};
  work.setup.time_step = 1e-3;
  work.setup.skin = skin;
  FillPlacement fill;
  fill.count = grains;
  fill.region = box;
  fill.velocity = {0, 0, -2};
  work.state.grains = fill_region(fill, work.setup.shapes.views(), ShapeId{0}, GrainId{0}, 5);
  // fill_region draws shapes; here each grain has its own.
  for (GrainState& grain : work.state.grains) grain.shape = ShapeId{grain.id.get()};
  work.whole_run = 5000;
  return work;
}

}  // namespace

const std::vector<WorkloadKind>& workload_kinds() {
  static const std::vector<WorkloadKind> kinds{
      {"dense", "279 nodes, 18 voxels; packed, sheared slowly at constant volume", 4096, dense},
      {"dense-fine", "the same with 5000 nodes and 50 voxels", 1000, dense_fine},
      {"graded", "the same with diameters of 1, 4 and 10", 4000, graded},
      {"settle", "thrown into a box, from drop to rest", 343, settle}};
  return kinds;
}

}  // namespace reckon::bench
