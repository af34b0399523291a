// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/container.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace reckon {
namespace {

constexpr double line_share = 0.93;   // bright voxels of a line along z that belongs to a wall
constexpr double layer_share = 0.85;  // likewise of a layer
constexpr std::int32_t fewest_layers = 40;
constexpr double least_span = 0.4;       // of the volume's width, that a wall reaches over
constexpr std::int32_t blur_beside = 4;  // a wall's blur reaches so far [voxels]
constexpr std::int32_t rim = 8;          // where the specimen begins for certain [voxels]
constexpr double least_rise = 0.4;       // of a container above the gray at its rim, in steps
constexpr double low_part = 0.2;  // of values in order, whose largest is the gray of no grain
constexpr std::size_t value_bins = 256;

/// Something for each line of voxels along z.
template <class Value>
struct Map {
  std::int32_t nx{0};
  std::int32_t ny{0};
  std::vector<Value> values;

  Map(const VoxelDims& dims, Value value)
      : nx{dims[0]},
        ny{dims[1]},
        values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), value) {}
  [[nodiscard]] std::size_t index(std::int32_t i, std::int32_t j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] bool holds(std::int32_t i, std::int32_t j) const {
    return i >= 0 && j >= 0 && i < nx && j < ny;
  }
};
using Flags = Map<std::uint8_t>;

/// Calls visit(map index, layer, gray, inside) for each voxel.
template <class Visit>
void for_each_gray(const Specimen& specimen, const Workspace& work, Visit&& visit) {
  const auto& dims = specimen.gray.dims();
  const std::size_t layer = Box{{dims[0], dims[1], 1}}.voxels();
  for (const Box& slab : work.slabs(dims)) {
    const GrayVolume gray = specimen.gray.read(slab);
    const MaskVolume mask =
        specimen.inside.empty() ? MaskVolume{gray, 1} : specimen.inside.read(slab);
    for (std::size_t v = 0; v < gray.values.size(); ++v) {
      visit(v % layer, slab.low[2] + static_cast<std::int32_t>(v / layer), gray.values[v],
            mask.values[v] != 0);
    }
  }
}

/// Floods a map from a place through cells of one flag; returns the cells and how far they span.
struct Patch {
  std::vector<std::size_t> cells;
  double span{0};  // of the map's width, the larger of both directions
};
std::vector<Patch> patches_of(const Flags& flags, std::uint8_t wanted) {
  std::vector<Patch> patches;
  Map<std::uint8_t> seen{{flags.nx, flags.ny, 1}, 0};
  for (std::int32_t j0 = 0; j0 < flags.ny; ++j0) {
    for (std::int32_t i0 = 0; i0 < flags.nx; ++i0) {
      const std::size_t first = flags.index(i0, j0);
      if (flags.values[first] != wanted || seen.values[first] != 0) continue;
      Patch patch;
      std::vector<std::pair<std::int32_t, std::int32_t>> front{{i0, j0}};
      seen.values[first] = 1;
      std::array<std::int32_t, 4> box{i0, i0, j0, j0};
      while (!front.empty()) {
        const auto [i, j] = front.back();
        front.pop_back();
        patch.cells.push_back(flags.index(i, j));
        box = {std::min(box[0], i), std::max(box[1], i), std::min(box[2], j), std::max(box[3], j)};
        for (const auto& [a, b] :
             {std::pair{i - 1, j}, std::pair{i + 1, j}, std::pair{i, j - 1}, std::pair{i, j + 1}}) {
          if (!flags.holds(a, b)) continue;
          const std::size_t next = flags.index(a, b);
          if (flags.values[next] != wanted || seen.values[next] != 0) continue;
          seen.values[next] = 1;
          front.emplace_back(a, b);
        }
      }
      patch.span = std::max(static_cast<double>(box[1] - box[0] + 1) / flags.nx,
                            static_cast<double>(box[3] - box[2] + 1) / flags.ny);
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

/// Lines that are bright nearly all along, in patches that reach over much of the volume.
Flags find_walls(const Specimen& specimen, double threshold, const Workspace& work) {
  const auto& dims = specimen.gray.dims();
  Map<std::int32_t> bright{dims, 0};
  Map<std::int32_t> all{dims, 0};
  for_each_gray(specimen, work, [&](std::size_t line, std::int32_t, float value, bool inside) {
    if (!inside) return;
    ++all.values[line];
    bright.values[line] += value > threshold ? 1 : 0;
  });
  Flags walls{dims, 0};
  for (std::size_t line = 0; line < walls.values.size(); ++line) {
    walls.values[line] =
        all.values[line] >= fewest_layers && bright.values[line] > line_share * all.values[line]
            ? 1
            : 0;
  }
  for (const Patch& patch : patches_of(walls, 1)) {
    if (patch.span >= least_span) continue;
    for (const std::size_t line : patch.cells) walls.values[line] = 0;
  }
  return walls;
}

/// Lines that a closed wall divides from the volume's sides. None when there is no such wall.
Flags enclosed_by(const Flags& walls) {
  Flags enclosed{{walls.nx, walls.ny, 1}, 0};
  for (const Patch& patch : patches_of(walls, 0)) {
    const bool at_side = std::any_of(patch.cells.begin(), patch.cells.end(), [&](std::size_t line) {
      const auto i = static_cast<std::int32_t>(line % static_cast<std::size_t>(walls.nx));
      const auto j = static_cast<std::int32_t>(line / static_cast<std::size_t>(walls.nx));
      return i == 0 || j == 0 || i + 1 == walls.nx || j + 1 == walls.ny;
    });
    if (at_side || patch.span < least_span) continue;
    for (const std::size_t line : patch.cells) enclosed.values[line] = 1;
  }
  return enclosed;
}

Flags widened(const Flags& flags, std::int32_t by) {
  Flags wide = flags;
  for (std::int32_t step = 0; step < by; ++step) {
    Flags next = wide;
    for (std::int32_t j = 0; j < flags.ny; ++j) {
      for (std::int32_t i = 0; i < flags.nx; ++i) {
        for (const auto& [a, b] :
             {std::pair{i - 1, j}, std::pair{i + 1, j}, std::pair{i, j - 1}, std::pair{i, j + 1}}) {
          if (flags.holds(a, b) && wide.values[wide.index(a, b)] != 0) {
            next.values[next.index(i, j)] = 1;
          }
        }
      }
    }
    wide = std::move(next);
  }
  return wide;
}

/// Counts of values in equal bins, for many groups of voxels.
class Quantiles {
 public:
  Quantiles(std::size_t groups, double low, double high)
      : low_{low}, width_{(high - low) / static_cast<double>(value_bins)}, counts_(groups) {}
  void add(std::size_t group, double value) {
    auto& counts = counts_[group];
    if (counts.empty()) counts.resize(value_bins, 0);
    const double place = (value - low_) / width_;
    ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(value_bins) - 1))];
  }
  /// The value that `part` of a group's values stay below.
  [[nodiscard]] double at(std::size_t group, double part) const {
    const auto& counts = counts_[group];
    std::uint64_t total = 0;
    for (const std::uint32_t count : counts) total += count;
    double below = 0;
    for (std::size_t b = 0; b < counts.size(); ++b) {
      const double next = below + counts[b];
      const double wanted = part * static_cast<double>(total);
      if (next >= wanted && counts[b] > 0) {
        return low_ + width_ * (static_cast<double>(b) + (wanted - below) / counts[b]);
      }
      below = next;
    }
    return low_;
  }
  [[nodiscard]] bool empty(std::size_t group) const { return counts_[group].empty(); }

 private:
  double low_;
  double width_;
  std::vector<std::vector<std::uint32_t>> counts_;
};

/// The gray that a container adds: by line for walls, by layer for floors.
struct Container {
  Flags gone;               // lines of walls and of the outside of a closed one
  Map<float> added;         // to the gray of lines beside walls
  std::vector<bool> floor;  // by layer
  std::vector<float> floor_added;
  double wall_gray{0};
  std::size_t wall_lines{0};
  bool closed{false};
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Values of the lines in walls and beside them.
Quantiles values_near(const Specimen& specimen, const Flags& walls, const RoughLevels& levels,
                      const Workspace& work) {
  const Flags zone = widened(walls, rim);
  Quantiles values{zone.values.size(), levels.void_gray - levels.step(),
                   levels.void_gray + 4 * levels.step()};
  for_each_gray(specimen, work, [&](std::size_t line, std::int32_t, float value, bool inside) {
    if (inside && zone.values[line] != 0) values.add(line, value);
  });
  return values;
}

/// Drops patches that do not differ from their surroundings, as the bright side of a shaded scan.
void drop_shading(Flags& walls, const Quantiles& values, double step) {
  for (const Patch& patch : patches_of(walls, 1)) {
    Flags own{{walls.nx, walls.ny, 1}, 0};
    std::vector<double> inner;
    for (const std::size_t line : patch.cells) {
      own.values[line] = 1;
      inner.push_back(values.at(line, low_part));
    }
    const Flags far = widened(own, rim);
    const Flags near = widened(own, blur_beside + 1);
    std::vector<double> beside;
    for (std::size_t line = 0; line < far.values.size(); ++line) {
      const bool at_rim = far.values[line] != 0 && near.values[line] == 0;
      if (at_rim && walls.values[line] == 0 && !values.empty(line)) {
        beside.push_back(values.at(line, low_part));
      }
    }
    const bool stands_out =
        !beside.empty() && median_of(inner) - median_of(beside) > least_rise * step;
    if (stands_out) continue;
    for (const std::size_t line : patch.cells) walls.values[line] = 0;
  }
}

/// Walls and the gray that they add beside them. Half of a wall's own gray is its surface.
void measure_walls(const Flags& walls, const Quantiles& values, const RoughLevels& levels,
                   Container& container) {
  const Flags zone = widened(walls, blur_beside);
  std::vector<double> plateau;
  for (std::size_t line = 0; line < walls.values.size(); ++line) {
    if (walls.values[line] != 0) plateau.push_back(values.at(line, 0.5));
  }
  container.wall_gray = median_of(std::move(plateau));
  const double surface = 0.5 * (levels.void_gray + container.wall_gray);
  Flags solid = walls;
  for (std::size_t line = 0; line < walls.values.size(); ++line) {
    if (zone.values[line] == 0 || values.empty(line)) continue;
    const double base = values.at(line, low_part);
    solid.values[line] = walls.values[line] != 0 && base >= surface ? 1 : 0;
    container.added.values[line] = static_cast<float>(std::max(0.0, base - levels.void_gray));
    container.wall_lines += solid.values[line];
  }
  container.gone = solid;
  const Flags enclosed = enclosed_by(solid);
  container.closed = std::any_of(enclosed.values.begin(), enclosed.values.end(),
                                 [](std::uint8_t flag) { return flag != 0; });
  if (!container.closed) return;
  for (std::size_t line = 0; line < enclosed.values.size(); ++line) {
    if (enclosed.values[line] == 0) container.gone.values[line] = 1;
  }
}

/// Layers that are bright nearly all over, in runs at either end of what is inside, and what they
/// add to the layers beside them.
void measure_floors(const Specimen& specimen, const RoughLevels& levels, const Workspace& work,
                    Container& container) {
  const auto layers = static_cast<std::size_t>(specimen.gray.dims()[2]);
  Quantiles values{layers, levels.void_gray - levels.step(), levels.void_gray + 4 * levels.step()};
  std::vector<std::uint64_t> bright(layers, 0);
  std::vector<std::uint64_t> all(layers, 0);
  for_each_gray(specimen, work,
                [&](std::size_t line, std::int32_t layer, float value, bool inside) {
                  if (!inside || container.gone.values[line] != 0) return;
                  const auto k = static_cast<std::size_t>(layer);
                  const float own = value - container.added.values[line];
                  ++all[k];
                  bright[k] += own > levels.threshold ? 1 : 0;
                  values.add(k, own);
                });
  for (std::size_t k = 0; k < layers; ++k) {
    container.floor[k] =
        all[k] > 0 && static_cast<double>(bright[k]) > layer_share * static_cast<double>(all[k]);
  }
  // A floor stands out from the layers at its rim, as the bright end of a shaded scan does not.
  const std::vector<bool> bright_layers = container.floor;
  for (std::size_t k = 0; k < layers; ++k) {
    if (!bright_layers[k]) continue;
    bool stands_out = false;
    for (const int side : {-1, 1}) {
      auto at = static_cast<std::ptrdiff_t>(k);
      const auto end = static_cast<std::ptrdiff_t>(layers);
      while (at >= 0 && at < end && bright_layers[static_cast<std::size_t>(at)]) at += side;
      at += static_cast<std::ptrdiff_t>(side) * blur_beside;
      if (at < 0 || at >= end || all[static_cast<std::size_t>(at)] == 0) continue;
      stands_out |= values.at(k, low_part) - values.at(static_cast<std::size_t>(at), low_part) >
                    least_rise * levels.step();
    }
    container.floor[k] = stands_out;
  }
  double plateau = levels.void_gray;
  for (std::size_t k = 0; k < layers; ++k) {
    if (container.floor[k]) plateau = std::max(plateau, values.at(k, 0.5));
  }
  const std::vector<bool> found = container.floor;
  const double surface = 0.5 * (levels.void_gray + plateau);
  for (std::size_t k = 0; k < layers; ++k) {
    const std::size_t low = k >= blur_beside ? k - blur_beside : 0;
    const std::size_t high = std::min(layers - 1, k + blur_beside);
    const bool beside = std::any_of(found.begin() + static_cast<std::ptrdiff_t>(low),
                                    found.begin() + static_cast<std::ptrdiff_t>(high) + 1,
                                    [](bool floor) { return floor; });
    if (!beside || all[k] == 0) continue;
    const double base = values.at(k, low_part);
    container.floor[k] = found[k] && base >= surface;
    container.floor_added[k] = static_cast<float>(std::max(0.0, base - levels.void_gray));
  }
}

GrayOnDisk without(const Container& container, const Specimen& specimen, double void_gray,
                   const Workspace& work) {
  GrayOnDisk result{specimen.gray.dims(), specimen.gray.voxel(), work.folder};
  for (const Box& slab : work.slabs(result.dims())) {
    GrayVolume part = specimen.gray.read(slab);
    std::size_t v = 0;
    for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t line = container.gone.index(i, j);
      const auto layer = static_cast<std::size_t>(k);
      float& value = part.values[v++];
      if (container.gone.values[line] != 0 || container.floor[layer]) {
        value = static_cast<float>(void_gray);
      } else {
        value -= container.added.values[line] + container.floor_added[layer];
      }
    });
    result.write(part, slab);
  }
  return result;
}

/// The specimen without the removed lines and layers.
MaskOnDisk inside_without(const Container& container, const Specimen& specimen,
                          const Workspace& work) {
  MaskOnDisk result{specimen.gray.dims(), specimen.gray.voxel(), work.folder};
  for (const Box& slab : work.slabs(result.dims())) {
    MaskVolume part =
        specimen.inside.empty() ? MaskVolume{slab, result.voxel(), 1} : specimen.inside.read(slab);
    std::size_t v = 0;
    for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const bool gone = container.gone.values[container.gone.index(i, j)] != 0 ||
                        container.floor[static_cast<std::size_t>(k)];
      if (gone) part.values[v] = 0;
      ++v;
    });
    result.write(part, slab);
  }
  return result;
}

}  // namespace

void remove_container(Specimen& specimen, const Workspace& work) {
  const auto& dims = specimen.gray.dims();
  const RoughLevels levels = rough_levels(specimen.gray, specimen.inside, work);
  const auto layers = static_cast<std::size_t>(dims[2]);
  Container container{Flags{dims, 0}, Map<float>{dims, 0}, std::vector<bool>(layers, false),
                      std::vector<float>(layers, 0)};
  Flags walls = find_walls(specimen, levels.threshold, work);
  const Quantiles values = values_near(specimen, walls, levels, work);
  drop_shading(walls, values, levels.step());
  const auto lines = std::count(walls.values.begin(), walls.values.end(), 1);
  if (lines > 0) measure_walls(walls, values, levels, container);
  measure_floors(specimen, levels, work, container);
  const auto floors = std::count(container.floor.begin(), container.floor.end(), true);
  if (lines == 0 && floors == 0) return;
  if (lines > 0) {
    specimen.remarks.push_back(
        fmt::format("a wall stands along z: {:.1f} % of the volume with a gray of about {:.6g}, "
                    "{}. It was made "
                    "void (--keep-container leaves it)",
                    100 * static_cast<double>(container.wall_lines) /
                        static_cast<double>(container.gone.values.size()),
                    container.wall_gray,
                    container.closed ? "closed all around; what lies outside it was left out too"
                                     : "not closed in this volume"));
  }
  if (floors > 0) {
    const auto first = std::find(container.floor.begin(), container.floor.end(), true);
    const auto last = std::find(container.floor.rbegin(), container.floor.rend(), true);
    specimen.remarks.push_back(
        fmt::format("{} layers between {} and {} are solid nearly all over, like a floor or a lid: "
                    "made void (--keep-container leaves them)",
                    floors, first - container.floor.begin(),
                    layers - 1 - static_cast<std::size_t>(last - container.floor.rbegin())));
  }
  specimen.gray = without(container, specimen, levels.void_gray, work);
  specimen.inside = inside_without(container, specimen, work);
}

}  // namespace reckon
