// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/grain_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/error.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/scan/blur.hpp"
#include "reckon/scan/own_share.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {
namespace {

constexpr std::int32_t padding = territory_layers + 2;  // of the piece that a grain is cut out of
constexpr double lowest_level = 0.25;
constexpr double highest_level = 0.75;
constexpr int level_rounds = 6;
constexpr double volume_tolerance = 1e-4;
constexpr int inner_layers = 2;  // of a grain, left out of its solid level
constexpr std::uint64_t fewest_inner = 30;

/// The piece of the volume around one grain; parts of it may lie outside.
struct Piece {
  GrayVolume share;       // solid shares of the denoised volume
  GrayVolume ownership;   // 1: grain, 0: neighbours, 1/2: void
  double gray_volume{0};  // [voxels]
  double solid_gray{0};
};

/// The mean of the raw gray over the grain's voxels that lie `inner_layers` inside it.
double own_solid_gray(const SegmentedScan& scan, std::uint32_t label, const LabelledGrain& grain) {
  const LabelVolume& labels = *scan.labels;
  double sum = 0;
  std::uint64_t count = 0;
  const auto inside = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    if (labels.values[labels.index(i, j, k)] != label) return false;
    for (const int step : {-inner_layers, inner_layers}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<std::int32_t, 3> p{i, j, k};
        p[axis] += step;
        if (!labels.holds(p[0], p[1], p[2])) return false;
        if (labels.values[labels.index(p[0], p[1], p[2])] != label) return false;
      }
    }
    return true;
  };
  for (std::int32_t k = grain.low[2]; k <= grain.high[2]; ++k) {
    for (std::int32_t j = grain.low[1]; j <= grain.high[1]; ++j) {
      for (std::int32_t i = grain.low[0]; i <= grain.high[0]; ++i) {
        if (!inside(i, j, k)) continue;
        sum += scan.raw->values[labels.index(i, j, k)];
        ++count;
      }
    }
  }
  return count < fewest_inner ? scan.levels.solid_gray : sum / static_cast<double>(count);
}

Piece cut_out(const SegmentedScan& scan, std::uint32_t label, const LabelledGrain& grain) {
  Piece piece;
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = grain.low[axis] - padding;
    box.dims[axis] = grain.high[axis] - grain.low[axis] + 1 + 2 * padding;
  }
  piece.share = GrayVolume{box, scan.labels->voxel};
  piece.ownership = GrayVolume{piece.share, 0.5F};
  piece.solid_gray = own_solid_gray(scan, label, grain);
  GrayLevels levels = scan.levels;
  levels.solid_gray = piece.solid_gray;
  for_each_voxel(box, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    if (!scan.labels->holds(i, j, k)) return;
    const std::size_t v = scan.labels->index(i, j, k);
    const std::size_t at = piece.share.index(i, j, k);
    const std::uint32_t owner = scan.territories->values[v];
    piece.share.values[at] = static_cast<float>(levels.share(scan.denoised->values[v]));
    piece.ownership.values[at] = owner == label ? 1.0F : owner != 0 ? 0.0F : 0.5F;
    if (owner == label) piece.gray_volume += levels.share(scan.raw->values[v]);
  });
  return piece;
}

/// Adds `factor` times the part that a smoothing by one voxel removes.
void sharpen(GrayVolume& share, double factor) {
  if (!(factor > 0)) return;
  GrayVolume smoother = share;
  blur_volume(smoother, 1);
  const auto weight = static_cast<float>(factor);
  for (std::size_t v = 0; v < share.values.size(); ++v) {
    share.values[v] += weight * (share.values[v] - smoother.values[v]);
  }
}

/// Keeps the surface off the grid's outermost vertices.
void close_at_edges(LevelSet& grid) {
  const auto close = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    float& value = grid.values[grid.index(i, j, k)];
    value = std::max(value, 0.1F);
  };
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      const bool whole_row = j == 0 || k == 0 || j + 1 == grid.dims[1] || k + 1 == grid.dims[2];
      const std::int32_t step = whole_row ? 1 : grid.dims[0] - 1;
      for (std::int32_t i = 0; i < grid.dims[0]; i += step) close(i, j, k);
    }
  }
}

/// A level set of the grain in solid shares: 0 where its own share is `level`, or at the border
/// with its neighbours, whichever lies farther inside.
LevelSet level_set_of(const OwnShare& own, double level) {
  LevelSet grid;
  grid.dims = own.share.dims;
  grid.spacing = own.share.voxel;
  for (int axis = 0; axis < 3; ++axis) {
    grid.origin_body[axis] =
        (own.share.low[static_cast<std::size_t>(axis)] + 0.5) * own.share.voxel;
  }
  grid.values.resize(own.share.values.size());
  const auto drawn_at = static_cast<float>(level);
  for (std::size_t v = 0; v < grid.values.size(); ++v) {
    grid.values[v] = std::max(drawn_at - own.share.values[v], 0.5F - own.part.values[v]);
  }
  close_at_edges(grid);
  return grid;
}

}  // namespace

TriangleMesh largest_component(TriangleMesh mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) {
      parent[v] = parent[parent[v]];
      v = parent[v];
    }
    return v;
  };
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : {t[1], t[2]}) {
      const std::uint32_t a = root(t[0]);
      const std::uint32_t b = root(corner);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  if (mesh.triangles.empty()) return {};
  const std::uint32_t any = root(mesh.triangles.front()[0]);
  const bool whole = std::all_of(parent.begin(), parent.end(), [&](const std::uint32_t& v) {
    return root(static_cast<std::uint32_t>(&v - parent.data())) == any;
  });
  if (whole) return mesh;
  std::vector<double> volume(mesh.vertices.size(), 0);
  const Vec3 origin = mesh.vertices[mesh.triangles.front()[0]];
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin;
    volume[root(t[0])] +=
        dot(cross(a, mesh.vertices[t[1]] - origin), mesh.vertices[t[2]] - origin) / 6;
  }
  const auto best =
      static_cast<std::uint32_t>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  TriangleMesh part;
  std::vector<std::uint32_t> place(mesh.vertices.size(), 0);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (root(v) != best) continue;
    place[v] = static_cast<std::uint32_t>(part.vertices.size());
    part.vertices.push_back(mesh.vertices[v]);
  }
  for (const auto& t : mesh.triangles) {
    if (root(t[0]) == best) part.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  return part;
}

GrainSurface extract_grain(const SegmentedScan& scan, std::uint32_t label,
                           const LabelledGrain& grain, double smoothing, double sharpening) {
  Piece piece = cut_out(scan, label, grain);
  OwnShare own = own_share(std::move(piece.share), piece.ownership, scan.levels.blur);
  blur_volume(own.share, smoothing);
  sharpen(own.share, sharpening);
  const double voxel_volume = scan.labels->voxel * scan.labels->voxel * scan.labels->voxel;
  GrainSurface surface;
  surface.label_volume = static_cast<double>(grain.voxels) * voxel_volume;
  surface.gray_volume = piece.gray_volume * voxel_volume;
  surface.solid_gray = piece.solid_gray;

  const auto error_at = [&](double level) {
    surface.level = level;
    surface.mesh_world = largest_component(extract_surface(level_set_of(own, level)));
    return enclosed_volume(surface.mesh_world) / surface.gray_volume - 1;
  };
  // Secants. A whole share moves the surface by about two voxels, which gives the first step.
  const double diameter = portable::cbrt(6 * piece.gray_volume / std::numbers::pi);  // [voxels]
  double slope = -12 / diameter;
  double level = 0.5;
  double error = error_at(level);
  for (int round = 1; round < level_rounds && std::abs(error) > volume_tolerance; ++round) {
    const double next = std::clamp(level - error / slope, lowest_level, highest_level);
    if (next == level) break;
    const double next_error = error_at(next);
    const double found = (next_error - error) / (next - level);
    if (found < 0) slope = found;
    level = next;
    error = next_error;
  }
  if (surface.mesh_world.triangles.empty()) {
    throw Error{{.place = fmt::format("grain {}", label),
                 .problem = "it has no surface at this gray level",
                 .reason = fmt::format("{} voxels", grain.voxels),
                 .fix = "It is too small or too faint; drop it by --fewest-voxels."}};
  }
  return surface;
}

}  // namespace reckon
