// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mpi.h>
#include <zoltan.h>

#include <algorithm>
#include <memory>

#include "reckon/core/error.hpp"
#include "reckon/domain/balanced_decomposition.hpp"
#include "reckon/parallel/mpi_handle.hpp"

namespace reckon {
namespace {

struct Points {
  std::span<const Vec3> positions;
  std::span<const double> costs;
};

const Points& points_of(void* data) { return *static_cast<const Points*>(data); }

int point_count(void* data, int* error) {
  *error = ZOLTAN_OK;
  return static_cast<int>(points_of(data).positions.size());
}

void list_points(void* data, int /*global_length*/, int /*local_length*/, ZOLTAN_ID_PTR global,
                 ZOLTAN_ID_PTR local, int /*weight_dimension*/, float* weights, int* error) {
  const Points& points = points_of(data);
  for (std::size_t n = 0; n < points.positions.size(); ++n) {
    global[n] = local[n] = static_cast<ZOLTAN_ID_TYPE>(n);
    weights[n] = static_cast<float>(points.costs[n]);
  }
  *error = ZOLTAN_OK;
}

int dimension(void* /*data*/, int* error) {
  *error = ZOLTAN_OK;
  return 3;
}

void coordinates(void* data, int /*global_length*/, int /*local_length*/, int count,
                 ZOLTAN_ID_PTR /*global*/, ZOLTAN_ID_PTR local, int /*dimensions*/, double* out,
                 int* error) {
  const Points& points = points_of(data);
  for (int n = 0; n < count; ++n) {
    const Vec3& p = points.positions[local[n]];
    for (const double coordinate : {p.x, p.y, p.z}) *out++ = coordinate;
  }
  *error = ZOLTAN_OK;
}

void require_ok(int code, const char* call) {
  if (code == ZOLTAN_OK || code == ZOLTAN_WARN) return;
  throw Error{{.problem = "the load could not be balanced",
               .reason = std::string{call} + " of Zoltan failed with code " + std::to_string(code),
               .fix = "Choose another domain.decomposition, for example \"grid\"."}};
}

}  // namespace

std::vector<Region> bisect(const Communicator& ranks, std::span<const Vec3> positions,
                           std::span<const double> costs, int parts) {
  float version = 0;
  require_ok(Zoltan_Initialize(0, nullptr, &version), "Zoltan_Initialize");
  const auto destroy = [](Zoltan_Struct* z) { Zoltan_Destroy(&z); };
  const std::unique_ptr<Zoltan_Struct, decltype(destroy)> zoltan{
      Zoltan_Create(MpiAccess::handle(ranks)), destroy};
  const std::string part_count = std::to_string(parts);
  for (const auto& [key, value] : {std::pair{"DEBUG_LEVEL", "0"},
                                   {"LB_METHOD", "RCB"},
                                   {"KEEP_CUTS", "1"},
                                   {"NUM_GID_ENTRIES", "1"},
                                   {"NUM_LID_ENTRIES", "1"},
                                   {"OBJ_WEIGHT_DIM", "1"},
                                   {"RETURN_LISTS", "NONE"},
                                   {"RCB_RECTILINEAR_BLOCKS", "1"},
                                   {"NUM_GLOBAL_PARTS", part_count.c_str()},
                                   {"IMBALANCE_TOL", "1.02"}}) {
    require_ok(Zoltan_Set_Param(zoltan.get(), key, value), "Zoltan_Set_Param");
  }
  Points points{positions, costs};
  Zoltan_Set_Num_Obj_Fn(zoltan.get(), point_count, &points);
  Zoltan_Set_Obj_List_Fn(zoltan.get(), list_points, &points);
  Zoltan_Set_Num_Geom_Fn(zoltan.get(), dimension, &points);
  Zoltan_Set_Geom_Multi_Fn(zoltan.get(), coordinates, &points);

  int changes = 0;
  int global_length = 0;
  int local_length = 0;
  int imports = 0;
  int exports = 0;
  ZOLTAN_ID_PTR import_global = nullptr;
  ZOLTAN_ID_PTR import_local = nullptr;
  ZOLTAN_ID_PTR export_global = nullptr;
  ZOLTAN_ID_PTR export_local = nullptr;
  int* import_ranks = nullptr;
  int* import_parts = nullptr;
  int* export_ranks = nullptr;
  int* export_parts = nullptr;
  require_ok(
      Zoltan_LB_Partition(zoltan.get(), &changes, &global_length, &local_length, &imports,
                          &import_global, &import_local, &import_ranks, &import_parts, &exports,
                          &export_global, &export_local, &export_ranks, &export_parts),
      "Zoltan_LB_Partition");
  std::vector<Region> regions(static_cast<std::size_t>(parts));
  constexpr double beyond = 1e30;  // used by Zoltan for a face at infinity
  for (int part = 0; part < parts; ++part) {
    int dimensions = 0;
    Region& r = regions[static_cast<std::size_t>(part)];
    require_ok(Zoltan_RCB_Box(zoltan.get(), part, &dimensions, &r.low.x, &r.low.y, &r.low.z,
                              &r.high.x, &r.high.y, &r.high.z),
               "Zoltan_RCB_Box");
    for (int axis = 0; axis < 3; ++axis) {
      if (r.low[axis] < -beyond) r.low[axis] = -Region::infinity;
      if (r.high[axis] > beyond) r.high[axis] = Region::infinity;
    }
  }
  return regions;
}

}  // namespace reckon
