// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/grains_inside.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "reckon/math/rotation.hpp"
#include "reckon/neighbor/pair_list.hpp"

namespace reckon {
namespace {

/// All that makes two grains copies of each other.
std::array<double, 8> pose_of(const GrainState& grain) {
  const Vec3& p = grain.position;
  const Quaternion& q = grain.orientation;
  return {static_cast<double>(grain.shape.get()), p.x, p.y, p.z, q.w, q.x, q.y, q.z};
}

/// The point of a shape that must not lie inside another grain, in the body frame.
Vec3 core_of(const LevelSet& grid) {
  const auto at_center = LevelSetView{grid}.sample({});
  if (at_center.inside_grid && at_center.phi < 0) return {};
  const auto deepest = std::min_element(grid.values.begin(), grid.values.end());
  const auto place = static_cast<std::int64_t>(deepest - grid.values.begin());
  const std::int64_t row = grid.dims[0];
  const std::int64_t layer = row * grid.dims[1];
  return grid.vertex_body(static_cast<std::int32_t>(place % row),
                          static_cast<std::int32_t>(place % layer / row),
                          static_cast<std::int32_t>(place / layer));
}

/// The level sets of the shapes that were asked for last, in bounded memory.
class LevelSets {
 public:
  struct Entry {
    LevelSet grid;
    Vec3 core_body;  // [m]
  };

  LevelSets(std::span<const ShapeOutline> outlines, const ShapeStore::Read& read)
      : outlines_{outlines}, read_{read} {}

  std::shared_ptr<const Entry> of(ShapeId shape) {
    std::shared_ptr<const Entry>& entry = entries_[shape];
    if (entry) return entry;
    const std::uint64_t bytes = outlines_[shape.get()].values() * sizeof(float);
    if (bytes_ + bytes > most_bytes) {
      entries_.clear();
      bytes_ = 0;
    }
    bytes_ += bytes;
    Shape whole = read_(shape);
    const Vec3 core = core_of(whole.level_set);
    return entries_[shape] = std::make_shared<const Entry>(Entry{std::move(whole.level_set), core});
  }

 private:
  static constexpr std::uint64_t most_bytes = std::uint64_t{1} << 28;

  std::span<const ShapeOutline> outlines_;
  const ShapeStore::Read& read_;
  std::map<ShapeId, std::shared_ptr<const Entry>> entries_;
  std::uint64_t bytes_{0};
};

bool is_in_grid(const ShapeOutline& shape, const Vec3& point_body) {
  for (int axis = 0; axis < 3; ++axis) {
    const double along = (point_body[axis] - shape.origin_body[axis]) / shape.spacing;
    if (!(along >= 0 && along <= shape.dims[static_cast<std::size_t>(axis)] - 1)) return false;
  }
  return true;
}

class Search {
 public:
  Search(std::span<const ShapeOutline> outlines, const ShapeStore::Read& read,
         const PeriodicCell* cell)
      : outlines_{outlines}, level_sets_{outlines, read}, cell_{cell} {}

  /// How deep the core of `inner` lies in `outer`; nothing where it lies outside [m].
  std::optional<double> depth_in(const GrainState& inner, const GrainState& outer) {
    const ShapeOutline& inner_shape = outlines_[inner.shape.get()];
    const ShapeOutline& outer_shape = outlines_[outer.shape.get()];
    const Vec3 apart = cell_ != nullptr ? cell_->branch(inner.position, outer.position)
                                        : inner.position - outer.position;
    if (inner_shape.sphere_radius > 0 && outer_shape.sphere_radius > 0) {
      const double depth = outer_shape.sphere_radius - norm(apart);
      return depth > 0 ? std::optional{depth} : std::nullopt;
    }
    // The centre of mass is in the convex hull of a grain, so if all of its surface lies inside the
    // other, the centre is in the other's grid at least.
    const Mat3 outer_rotation = rotation_matrix(outer.orientation);
    if (!is_in_grid(outer_shape, transposed_times(outer_rotation, apart))) return std::nullopt;
    const Vec3 core = rotation_matrix(inner.orientation) * level_sets_.of(inner.shape)->core_body;
    const auto entry = level_sets_.of(outer.shape);
    const auto sample =
        LevelSetView{entry->grid}.sample(transposed_times(outer_rotation, apart + core));
    return sample.inside_grid && sample.phi < 0 ? std::optional{-sample.phi} : std::nullopt;
  }

 private:
  std::span<const ShapeOutline> outlines_;
  LevelSets level_sets_;
  const PeriodicCell* cell_;
};

}  // namespace

std::vector<Copies> find_copies(std::span<const GrainState> grains) {
  std::vector<std::uint32_t> order(grains.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto first = pose_of(grains[a]);
    const auto second = pose_of(grains[b]);
    return first != second ? first < second : grains[a].id < grains[b].id;
  });
  std::vector<Copies> found;
  for (std::size_t n = 1; n < order.size(); ++n) {
    const GrainState& grain = grains[order[n]];
    const GrainState& before = grains[order[n - 1]];
    if (pose_of(grain) != pose_of(before)) continue;
    if (found.empty() || found.back().back() != before.id) found.push_back({before.id});
    found.back().push_back(grain.id);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<GrainInside> find_grains_inside(std::span<const GrainState> grains,
                                            std::span<const ShapeOutline> outlines,
                                            const ShapeStore::Read& read, const PeriodicCell* cell,
                                            std::size_t most) {
  std::vector<GrainId> repeated;
  for (const Copies& copies : find_copies(grains)) {
    repeated.insert(repeated.end(), copies.begin() + 1, copies.end());
  }
  std::sort(repeated.begin(), repeated.end());
  std::vector<const GrainState*> single;
  std::vector<Vec3> positions;
  std::vector<double> radii;
  for (const GrainState& grain : grains) {
    if (std::binary_search(repeated.begin(), repeated.end(), grain.id)) continue;
    single.push_back(&grain);
    positions.push_back(grain.position);
    radii.push_back(outlines[grain.shape.get()].bounding_radius);
  }
  Search search{outlines, read, cell};
  std::vector<GrainInside> found;
  visit_pairs(positions, radii, cell, [&](std::uint32_t s, std::uint32_t t) {
    // The smaller grain is looked for in the larger one first, of equal ones the later.
    if (std::pair{radii[t], single[s]->id} > std::pair{radii[s], single[t]->id}) std::swap(s, t);
    for (const auto& [inner, outer] : {std::pair{t, s}, std::pair{s, t}}) {
      const auto depth = search.depth_in(*single[inner], *single[outer]);
      if (!depth) continue;
      found.push_back({single[inner]->id, single[outer]->id, *depth});
      break;
    }
    return found.size() < most;
  });
  const auto ids = [](const GrainInside& pair) { return std::pair{pair.inner, pair.outer}; };
  std::sort(found.begin(), found.end(),
            [&](const auto& a, const auto& b) { return ids(a) < ids(b); });
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const auto& a, const auto& b) { return ids(a) == ids(b); }),
              found.end());
  return found;
}

}  // namespace reckon
