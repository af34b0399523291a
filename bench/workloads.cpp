// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "workloads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "packing.hpp"
#include "reckon/core/error.hpp"
#include "reckon/simulation/fill_region.hpp"

namespace reckon::bench {
namespace {

// Quasi-static packings and falls use grains of 2 m: all else follows from the ratios. Those after
// the paper use its unit, the voxel.
constexpr double diameter = 2;  // [m]
constexpr double skin = 0.1;    // [m]

/// Where a packing of this request is kept; empty: nowhere.
std::string packing_file(const WorkloadRequest& request, std::string_view name,
                         std::size_t grains) {
  if (request.cache.empty()) return {};
  const char* const kind = request.storage == ShapeStorage::band ? "-band" : "";
  return (request.cache / fmt::format("{}-{}{}.packing", name, grains, kind)).string();
}

double solid_fraction(const Packing& packing) {
  double volume = 0;
  for (const GrainState& grain : packing.state.grains) {
    volume += packing.setup.shapes.views()[grain.shape.get()].mass.volume;
  }
  const Vec3 size = packing.high - packing.low;
  return volume / (size.x * size.y * size.z);
}

Workload from_packing(Packing packing, std::size_t distinct) {
  Workload work;
  work.solid_fraction = solid_fraction(packing);
  work.distinct_shapes = distinct;
  work.setup = std::move(packing.setup);
  work.state = std::move(packing.state);
  return work;
}

/// Squeezed along x and let out along z at constant volume; gives the rate for an inertial number.
Workload sheared(Packing packing, double inertial_number, std::size_t distinct) {
  const double rate =
      inertial_number / (diameter * std::sqrt(packing.setup.density / packing.pressure));
  const Vec3 size = packing.high - packing.low;
  auto& walls = packing.setup.walls;
  walls[0].motion = WallMotion{.velocity = {0.5 * rate * size.x, 0, 0}};
  walls[1].motion = WallMotion{.velocity = {-0.5 * rate * size.x, 0, 0}};
  walls[4].motion = WallMotion{.velocity = {0, 0, -0.5 * rate * size.z}};
  walls[5].motion = WallMotion{.velocity = {0, 0, 0.5 * rate * size.z}};
  packing.setup.damping = 1;
  Workload work = from_packing(std::move(packing), distinct);
  work.inertial_number = inertial_number;
  return work;
}

const Material stiff_sand{.law = LinearLaw{1e8, 0.9e8, 0, 0}};
constexpr double stiff_time_step = 3e-4;  // [s]
constexpr double stiff_pressure = 1e5;    // [Pa]

Workload dense(std::uint32_t grains, const WorkloadRequest& request) {
  return sheared(
      squeeze(make_shapes({{diameter, grains, 279, 18}}, 12, request.storage), stiff_sand,
              stiff_pressure, stiff_time_step, skin, packing_file(request, "dense", grains)),
      1e-3, 12);
}

Workload dense_fine(std::uint32_t grains, const WorkloadRequest& request) {
  return sheared(
      squeeze(make_shapes({{diameter, grains, 5000, 50}}, 8, request.storage), stiff_sand,
              stiff_pressure, stiff_time_step, skin, packing_file(request, "dense-fine", grains)),
      1e-3, 8);
}

Workload graded(std::uint32_t grains, const WorkloadRequest& request) {
  Material material = stiff_sand;
  material.master = MasterRule::smaller;
  const std::uint32_t large = std::max(grains / 1000, 2U);
  const std::uint32_t middle = std::max(grains / 50, 2U);
  return sheared(squeeze(make_shapes({{10 * diameter, large, 1500, 50},
                                      {4 * diameter, middle, 600, 30},
                                      {diameter, grains - large - middle, 279, 18}},
                                     8, request.storage),
                         material, stiff_pressure, stiff_time_step, skin,
                         packing_file(request, "graded", grains)),
                 1e-3, 24);
}

/// Walls at fixed velocity, lateral ones outward at a third of the axial ones: a drained triaxial
/// test's kinematics without its pressure control. The copies of its block share their shapes; as
/// bands every grain has memory of its own.
Workload triaxial(std::uint32_t grains, const WorkloadRequest& request) {
  constexpr int copies = 3;
  constexpr std::uint32_t distinct = 8;
  const std::uint32_t block = (grains + copies * copies * copies - 1) / (copies * copies * copies);
  const std::vector<GrainKind> kinds{{diameter, block, 4772, 50}};
  Packing packing =
      squeeze(make_shapes(kinds, distinct, request.storage), stiff_sand, stiff_pressure,
              stiff_time_step, skin, packing_file(request, "triaxial-block", block));
  const double pressure = packing.pressure;
  repeat(packing, copies, grains);
  if (request.storage == ShapeStorage::band) {  // whole grids would take 20 GB
    packing.setup.shapes = make_shapes(kinds, distinct, request.storage, copies * copies * copies);
    for (GrainState& grain : packing.state.grains) {
      grain.shape = ShapeId{grain.id.get() / block * block + grain.shape.get()};
    }
  }
  packing.pressure = pressure;
  Workload work = sheared(std::move(packing), 1e-3, 8);
  auto& walls = work.setup.walls;
  const Vec3 axial = walls[1].motion->velocity;
  const double lateral = -axial.x / 3;
  walls[2].motion = WallMotion{.velocity = {0, -lateral, 0}};
  walls[3].motion = WallMotion{.velocity = {0, lateral, 0}};
  walls[4].motion = WallMotion{.velocity = {0, 0, -lateral}};
  walls[5].motion = WallMotion{.velocity = {0, 0, lateral}};
  work.warm_up = 600;
  work.plain_steps = 1;
  return work;
}

/// Grains with their own shapes, dropped.
Workload falling(std::uint32_t grains, const BoxConfig& region, const Vec3& velocity,
                 const WorkloadRequest& request) {
  Workload work;
  const AreaLaw law{2e7, 1.8e7, area_dashpot_factor(0.5)};
  work.setup.shapes = make_shapes({{diameter, grains, 279, 18}}, 12, request.storage);
  work.distinct_shapes = 12;
  work.setup.density = 1000;
  work.setup.contact = {law, 0.5, MasterRule::lower_id};
  work.setup.walls = {{"floor", PlaneSurface{region.low, {0, 0, 1}}, law, 0.5, false, {}}};
  work.setup.body_force.gravity = {0, 0, -9.81};
  work.setup.time_step = 1e-3;
  work.setup.skin = skin;
  FillPlacement fill;
  fill.count = grains;
  fill.region = region;
  fill.velocity = velocity;
  work.state.grains = fill_region(fill, work.setup.shapes.views(), ShapeId{0}, GrainId{0}, 5);
  // fill_region draws shapes; here each grain has its own.
  for (GrainState& grain : work.state.grains) grain.shape = ShapeId{grain.id.get()};
  work.course = Course::whole;
  work.warm_up = 0;
  work.steps = 250;
  work.rests_at = 0.01;
  work.stretches = 200;
  return work;
}

Workload settle(std::uint32_t grains, const WorkloadRequest& request) {
  const double edge = 0.96 * diameter * std::cbrt(static_cast<double>(grains));
  const BoxConfig box{{0, 0, 0}, {edge, edge, 100 * edge}};
  Workload work = falling(grains, box, {0, 0, -2}, request);
  const AnyContactLaw& law = work.setup.contact.law;
  work.setup.walls.push_back({"x-", PlaneSurface{box.low, {1, 0, 0}}, law, 0.3, false, {}});
  work.setup.walls.push_back({"x+", PlaneSurface{box.high, {-1, 0, 0}}, law, 0.3, false, {}});
  work.setup.walls.push_back({"y-", PlaneSurface{box.low, {0, 1, 0}}, law, 0.3, false, {}});
  work.setup.walls.push_back({"y+", PlaneSurface{box.high, {0, -1, 0}}, law, 0.3, false, {}});
  if (request.small) work.stretches = 2;
  return work;
}

Workload heap(std::uint32_t grains, const WorkloadRequest& request) {
  // A narrow column; no narrower than one grain needs.
  const double edge = diameter * std::max(0.6 * std::cbrt(static_cast<double>(grains)), 3.0);
  Workload work =
      falling(grains, BoxConfig{{0, 0, 0}, {edge, edge, 100 * edge}}, {0, 0, -2}, request);
  if (request.small) work.stretches = 2;
  return work;
}

/// The paper's scaling tests (sections 6.1 and 6.2): a box full of grains, on which random body
/// forces of ten times gravity act that change at every step. Stiffness, damping and time step are
/// those of the 592 grains that come with the authors' public code.
Workload random_forcing(std::uint32_t grains, std::uint32_t block, int copies, double voxels,
                        const char* name, const WorkloadRequest& request) {
  constexpr double time_step = 0.00200984058448674;  // [s]
  constexpr std::uint32_t distinct = 74;
  const Material material{.law = LinearLaw{30000, 27000, linear_dashpot_factor(0.6), 16},
                          .friction = 0.65,
                          .density = 2.65e-3};
  Packing packing = squeeze(make_shapes({{voxels, block, 279, voxels}}, distinct, request.storage),
                            material, 20, time_step, 1, packing_file(request, name, block));
  repeat(packing, copies, grains);
  packing.setup.damping = 1.5;
  packing.setup.body_force.random_acceleration = 1000;
  packing.setup.body_force.seed = 42;
  Workload work = from_packing(std::move(packing), std::min(distinct, block));
  work.warm_up = 0;
  work.steps = 200;
  work.plain_steps = 2;
  return work;
}

Workload paper_592(std::uint32_t grains, const WorkloadRequest& request) {
  return random_forcing(grains, grains, 1, 24, "paper", request);
}
Workload paper_1998(std::uint32_t grains, const WorkloadRequest& request) {
  Workload work = random_forcing(grains, (grains + 26) / 27, 3, 24, "paper", request);
  work.paper_seconds = 356;
  return work;
}
Workload paper_4736(std::uint32_t grains, const WorkloadRequest& request) {
  Workload work = random_forcing(grains, (grains + 7) / 8, 2, 24, "paper", request);
  work.paper_seconds = 852;
  return work;
}
Workload paper_42684(std::uint32_t grains, const WorkloadRequest& request) {
  Workload work = random_forcing(grains, (grains + 26) / 27, 3, 17.3, "paper-fine", request);
  work.paper_seconds = 67083;
  return work;
}

}  // namespace

const std::vector<WorkloadKind>& workload_kinds() {
  static const std::vector<WorkloadKind> kinds{
      {"dense", "279 nodes, 18 voxels; packed, sheared slowly at constant volume", 4096, 64, dense},
      {"dense-fine", "the same with 5000 nodes and 50 voxels", 1000, 27, dense_fine},
      {"graded", "the same with diameters of 1, 4 and 10", 2000, 60, graded},
      {"settle", "thrown into a box, from drop to rest", 512, 27, settle},
      {"heap", "thrown onto a plain, from drop to rest", 512, 27, heap},
      {"paper-592", "random body forces; 74 shapes of 24 voxels", 592, 27, paper_592},
      {"paper-1998", "the same", 1998, 54, paper_1998},
      {"paper-4736", "the same", 4736, 64, paper_4736},
      {"paper-42684", "the same with shapes of 17 voxels", 42684, 54, paper_42684},
      {"triaxial-19906", "4772 nodes, 50 voxels; compressed by walls of fixed velocity", 19906, 54,
       triaxial}};
  return kinds;
}

Workload make_workload(const std::string& name, const WorkloadRequest& request) {
  for (const WorkloadKind& kind : workload_kinds()) {
    if (kind.name != name) continue;
    const std::uint32_t own = request.small ? kind.small_grains : kind.grains;
    Workload work = kind.make(request.grains > 0 ? request.grains : own, request);
    if (request.small) {
      work.warm_up = std::min<std::uint64_t>(work.warm_up, 100);
      work.steps = std::min<std::uint64_t>(work.steps, 50);
      work.stretches = std::min(work.stretches, 2);
    }
    return work;
  }
  std::string names;
  for (const WorkloadKind& kind : workload_kinds()) names += " " + kind.name;
  throw Error{{.place = {},
               .problem = fmt::format("there is no workload \"{}\"", name),
               .reason = {},
               .fix = fmt::format("There are:{}.", names)}};
}

}  // namespace reckon::bench
