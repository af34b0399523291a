// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/surface_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "reckon/avatar/creases.hpp"
#include "reckon/shape/node_order.hpp"

namespace reckon {
namespace {

/// A part of the relaxation. The first spreads the points, the second makes their distances
/// uniform.
struct Stage {
  std::size_t samples_per_point;
  int rounds;
  // Each point goes so much farther than to the middle of its share, which settles long waves
  // sooner.
  double over_relaxation;
};
using Stages = std::array<Stage, 2>;
constexpr Stages for_few_points{Stage{24, 24, 1.7}, Stage{48, 12, 1.4}};
constexpr Stages for_many_points{Stage{10, 10, 1.7}, Stage{32, 4, 1.4}};
constexpr std::size_t few_points = 2000;
constexpr int rounds_per_look_around = 4;  // after which neighbours are searched again
constexpr double neighbour_reach = 1.7;    // [mean spacings]
constexpr double opposite_cosine = -0.5;
constexpr double least_face = 0.1;  // of a node's largest share, to count as one of its faces

/// Finds the nearest of some oriented points, by cells of about one point each.
class NearestPoint {
 public:
  explicit NearestPoint(const OrientedPoints& points) : points_{points} {
    BoundingBox box;
    for (const Vec3& p : points.position) box.include(p);
    low_ = box.low;
    const Vec3 extent = box.high - box.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    // Points lie on a surface: their spacing is about the box's size over the root of their number.
    cell_ = std::max(longest / std::max(1.0, std::sqrt(static_cast<double>(points.size()) / 3)),
                     std::numeric_limits<double>::min());
    for (int axis = 0; axis < 3; ++axis) {
      dims_[static_cast<std::size_t>(axis)] = static_cast<int>(extent[axis] / cell_) + 1;
    }
    first_.assign(static_cast<std::size_t>(dims_[0]) * static_cast<std::size_t>(dims_[1]) *
                          static_cast<std::size_t>(dims_[2]) +
                      1,
                  0);
    for (const Vec3& p : points.position) ++first_[cell_of(p) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    members_.resize(points.size());
    for (std::uint32_t n = 0; n < points.size(); ++n) {
      members_[next[cell_of(points.position[n])]++] = n;
    }
  }

  /// Ties go to the lower number. When all points are turned away, the nearest of all.
  [[nodiscard]] std::uint32_t find(const Vec3& position, const Vec3& normal) const {
    const Best facing = search(position, [&](std::uint32_t n) {
      return dot(points_.normal[n], normal) >= opposite_cosine;
    });
    if (facing.squared_distance < std::numeric_limits<double>::infinity()) return facing.point;
    return search(position, [](std::uint32_t) { return true; }).point;
  }

  /// Calls visit(point, squared distance) for all within `radius`, in an order of its own.
  template <class Visit>
  void for_each_within(const Vec3& position, double radius, Visit&& visit) const {
    const Vec3 reach{radius, radius, radius};
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    for (int axis = 0; axis < 3; ++axis) {
      low[static_cast<std::size_t>(axis)] = coordinate(position - reach, axis);
      high[static_cast<std::size_t>(axis)] = coordinate(position + reach, axis);
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        // The cells of a row lie behind each other.
        const std::uint32_t first = first_[cell_index(low[0], j, k)];
        const std::uint32_t last = first_[cell_index(high[0], j, k) + 1];
        for (std::uint32_t m = first; m < last; ++m) {
          const double d2 = squared_norm(points_.position[members_[m]] - position);
          if (d2 <= radius * radius) visit(members_[m], d2);
        }
      }
    }
  }

 private:
  struct Best {
    double squared_distance{std::numeric_limits<double>::infinity()};
    std::uint32_t point{0};
  };

  [[nodiscard]] int coordinate(const Vec3& p, int axis) const {
    const double g = (p[axis] - low_[axis]) / cell_;
    const int last = dims_[static_cast<std::size_t>(axis)] - 1;
    return g >= last ? last : g > 0 ? static_cast<int>(g) : 0;
  }
  [[nodiscard]] std::size_t cell_index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(dims_[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(dims_[1]) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] std::size_t cell_of(const Vec3& p) const {
    return cell_index(coordinate(p, 0), coordinate(p, 1), coordinate(p, 2));
  }

  /// Searches shells of cells around that of the position until no closer point is possible.
  template <class Accept>
  [[nodiscard]] Best search(const Vec3& position, Accept&& accept) const {
    const std::array<int, 3> center{coordinate(position, 0), coordinate(position, 1),
                                    coordinate(position, 2)};
    const int last_shell = std::max({dims_[0], dims_[1], dims_[2]});
    Best best;
    for (int shell = 0; shell <= last_shell; ++shell) {
      // Whatever lies in this shell is at least (shell - 1) whole cells away.
      const double gap = std::max(0, shell - 1) * cell_;
      if (gap * gap > best.squared_distance) break;
      for_each_in_shell(center, shell, [&](std::size_t cell) {
        for (std::uint32_t m = first_[cell]; m < first_[cell + 1]; ++m) {
          const std::uint32_t n = members_[m];
          const double d2 = squared_norm(points_.position[n] - position);
          const bool closer =
              d2 < best.squared_distance || (d2 == best.squared_distance && n < best.point);
          if (closer && accept(n)) best = {d2, n};
        }
      });
    }
    return best;
  }

  template <class Visit>
  void for_each_in_shell(const std::array<int, 3>& center, int shell, Visit&& visit) const {
    const auto low = [&](std::size_t a) { return std::max(center[a] - shell, 0); };
    const auto high = [&](std::size_t a) { return std::min(center[a] + shell, dims_[a] - 1); };
    for (int k = low(2); k <= high(2); ++k) {
      for (int j = low(1); j <= high(1); ++j) {
        const bool whole_row = std::abs(k - center[2]) == shell || std::abs(j - center[1]) == shell;
        const int step = whole_row || shell == 0 ? 1 : 2 * shell;
        // A row inside the shell touches it only at its two ends.
        for (int i = center[0] - shell; i <= center[0] + shell; i += step) {
          if (i >= 0 && i < dims_[0]) visit(cell_index(i, j, k));
        }
      }
    }
  }

  const OrientedPoints& points_;
  Vec3 low_;
  double cell_{1};
  std::array<int, 3> dims_{1, 1, 1};
  std::vector<std::uint32_t> first_;    // cell -> first place in members_
  std::vector<std::uint32_t> members_;  // points by cell
};

using Lanes [[gnu::vector_size(16)]] = float;
using Answers [[gnu::vector_size(16)]] = std::int32_t;
constexpr std::size_t lanes = 4;

bool any(const Answers& answers) {
  std::array<std::uint64_t, 2> halves{};
  std::memcpy(halves.data(), &answers, sizeof answers);
  return (halves[0] | halves[1]) != 0;
}

/// Finds the nearest of some points for places that are near each other, by walking from
/// neighbour to neighbour. In single precision, which matters only to places half way between two
/// points.
class NearestWalk {
 public:
  /// `area`: of the surface.
  NearestWalk(const OrientedPoints& points, double area) : points_{points}, cells_{points} {
    reach_ = neighbour_reach * std::sqrt(area / static_cast<double>(points.size()));
    complete_.assign(points.size(), true);
    first_.push_back(0);
    std::vector<Neighbour> neighbours;
    for (std::uint32_t n = 0; n < points.size(); ++n) {
      neighbours.clear();
      cells_.for_each_within(points.position[n], reach_, [&](std::uint32_t m, double d2) {
        if (m == n) return;
        if (facing(m, points.normal[n])) {
          neighbours.push_back({d2, m});
        } else {
          complete_[n] = false;
        }
      });
      std::sort(neighbours.begin(), neighbours.end());
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        if (i % lanes == 0) {
          blocks_.emplace_back();
          blocks_.back().nearest = static_cast<float>(neighbours[i].squared_distance);
        }
        blocks_.back().point[i % lanes] = neighbours[i].point;
      }
      first_.push_back(static_cast<std::uint32_t>(blocks_.size()));
    }
    refresh();
  }

  /// To be called when points have moved. Who are neighbours stays as it was.
  void refresh() {
    constexpr float far_away = 1e18F;
    for (Block& block : blocks_) {
      for (std::size_t i = 0; i < lanes; ++i) {
        const std::uint32_t n = block.point[i];
        block.x[i] = n == nobody ? far_away : static_cast<float>(points_.position[n].x);
        block.y[i] = n == nobody ? far_away : static_cast<float>(points_.position[n].y);
        block.z[i] = n == nobody ? far_away : static_cast<float>(points_.position[n].z);
      }
    }
  }

  /// What NearestPoint::find answers, but for ties; `start` is where the walk begins.
  [[nodiscard]] std::uint32_t find(const Vec3& position, const Vec3& normal,
                                   std::uint32_t start) const {
    const std::uint32_t n = walk(position, normal, start);
    // Whatever were nearer would be within the neighbours' reach of this one.
    const double d2 = squared_norm(points_.position[n] - position);
    const bool sure = complete_[n] && 4 * d2 <= reach_ * reach_ && facing(n, normal);
    return sure ? n : cells_.find(position, normal);
  }

  /// A point that none of its neighbours is nearer than, as they were when they were sought.
  [[nodiscard]] std::uint32_t walk(const Vec3& position, const Vec3& normal,
                                   std::uint32_t start) const {
    const auto x = static_cast<float>(position.x);
    const auto y = static_cast<float>(position.y);
    const auto z = static_cast<float>(position.z);
    std::uint32_t here = start;
    auto d2 = static_cast<float>(squared_norm(points_.position[here] - position));
    for (bool moved = true; moved;) {
      moved = false;
      for (std::uint32_t b = first_[here]; b < first_[here + 1] && !moved; ++b) {
        const Block& block = blocks_[b];
        if (block.nearest > 4 * d2) break;  // all that follow are farther than here
        const Lanes dx = block.x - x;
        const Lanes dy = block.y - y;
        const Lanes dz = block.z - z;
        const Lanes next = dx * dx + dy * dy + dz * dz;
        if (!any(next < d2)) continue;
        for (std::size_t i = 0; i < lanes; ++i) {
          if (!(next[i] < d2) || !facing(block.point[i], normal)) continue;
          here = block.point[i];
          d2 = next[i];
          moved = true;
        }
      }
    }
    return here;
  }

 private:
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

  struct Neighbour {
    double squared_distance;
    std::uint32_t point;

    bool operator<(const Neighbour& other) const {
      return squared_distance != other.squared_distance ? squared_distance < other.squared_distance
                                                        : point < other.point;
    }
  };
  /// Some neighbours of a point, by distance.
  struct Block {
    Lanes x{}, y{}, z{};
    std::array<std::uint32_t, lanes> point{nobody, nobody, nobody, nobody};
    float nearest{0};  // squared distance of the first when they were sought
  };

  [[nodiscard]] bool facing(std::uint32_t n, const Vec3& normal) const {
    return dot(points_.normal[n], normal) >= opposite_cosine;
  }

  const OrientedPoints& points_;
  NearestPoint cells_;
  double reach_;
  std::vector<bool> complete_;        // whether a point's neighbours are all that are within reach
  std::vector<std::uint32_t> first_;  // of each point's blocks
  std::vector<Block> blocks_;
};

}  // namespace

SurfaceSampler::SurfaceSampler(const TriangleMesh& mesh, std::span<const std::uint32_t> order)
    : mesh_{mesh}, order_{order} {
  for (const std::uint32_t t : order) area_ += triangle_area(mesh, mesh.triangles[t]);
}

OrientedPoints sample_surface(const SurfaceSampler& sampler, std::size_t count) {
  OrientedPoints samples;
  samples.position.reserve(count);
  samples.normal.reserve(count);
  sampler.for_each(count, [&](const Vec3& position, const Vec3& normal) {
    samples.position.push_back(position);
    samples.normal.push_back(normal);
  });
  return samples;
}

OrientedPoints sample_surface(const TriangleMesh& mesh, std::size_t count) {
  std::vector<Vec3> centers;
  centers.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    centers.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  }
  const std::vector<std::uint32_t> order = compact_order(centers, 1);
  return sample_surface(SurfaceSampler{mesh, order}, count);
}

namespace {

/// Moves all points but the first `fixed` towards the middles of their shares of the samples.
void relax(OrientedPoints& points, std::size_t fixed, const OrientedPoints& samples, double area,
           const Stage& stage) {
  const std::size_t count = points.size();
  std::vector<std::uint32_t> owner(samples.size());
  std::vector<Vec3> sum(count);
  std::vector<Vec3> normal_sum(count);
  std::vector<std::uint32_t> share(count);
  std::optional<NearestWalk> nearest;
  for (int round = 0; round < stage.rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3{});
    std::fill(normal_sum.begin(), normal_sum.end(), Vec3{});
    std::fill(share.begin(), share.end(), 0U);
    if (round % rounds_per_look_around == 0) {
      nearest.emplace(points, area);
    } else {
      nearest->refresh();
    }
    for (std::size_t s = 0; s < samples.size(); ++s) {
      // Samples follow a curve: at first the last one's owner is a good guess.
      owner[s] = round == 0 ? nearest->find(samples.position[s], samples.normal[s],
                                            s == 0 ? 0 : owner[s - 1])
                            : nearest->walk(samples.position[s], samples.normal[s], owner[s]);
      const std::uint32_t n = owner[s];
      sum[n] += samples.position[s];
      normal_sum[n] += samples.normal[s];
      ++share[n];
    }
    for (std::size_t n = fixed; n < count; ++n) {
      if (share[n] == 0) continue;
      points.position[n] += stage.over_relaxation * (sum[n] / share[n] - points.position[n]);
      points.normal[n] = normalized(normal_sum[n]);
    }
  }
}

}  // namespace

OrientedPoints spread_points(const SurfaceSampler& sampler, const TriangleBvh& bvh,
                             std::size_t count, const OrientedPoints& fixed) {
  OrientedPoints points = fixed;
  const std::size_t free = count - std::min(count, fixed.size());
  for (const Stage& stage : count <= few_points ? for_few_points : for_many_points) {
    const OrientedPoints samples = sample_surface(sampler, stage.samples_per_point * count);
    for (std::size_t n = points.size() - fixed.size(); n < free; ++n) {
      const std::size_t sample = (2 * n + 1) * samples.size() / (2 * free);
      points.position.push_back(samples.position[sample]);
      points.normal.push_back(samples.normal[sample]);
    }
    relax(points, fixed.size(), samples, sampler.area(), stage);
  }
  const double spacing = std::sqrt(sampler.area() / static_cast<double>(count));
  for (std::size_t n = fixed.size(); n < points.size(); ++n) {
    Vec3& p = points.position[n];
    // The same, only faster: most lie so near.
    const auto near = bvh.closest_point_within(p, 0.1 * spacing);
    p = near ? near->point : bvh.closest_point(p).point;
  }
  return points;
}

namespace {

/// Counts whose samples are whose.
class Shares {
 public:
  /// The first `on_edges` points lie on edges.
  Shares(const OrientedPoints& points, double area, std::size_t on_edges = 0)
      : nearest_{points, area}, area_{area}, share_(points.size(), 0), faces_(on_edges) {}

  void add(const Vec3& position, const Vec3& normal) {
    last_ = nearest_.find(position, normal, last_);  // samples follow a curve
    ++share_[last_];
    ++count_;
    if (last_ >= faces_.size()) return;
    for (Face& face : faces_[last_]) {
      if (dot(face.normal, normal) < crease_cosine) continue;
      face.share += 1;
      return;
    }
    faces_[last_].push_back({normal, 1.0});
  }
  [[nodiscard]] std::vector<double> areas() const {
    std::vector<double> areas;
    areas.reserve(share_.size());
    for (std::size_t n = 0; n < share_.size(); ++n) {
      const double samples = n < faces_.size() ? share_of_one_face(n) : share_[n];
      areas.push_back(area_ * samples / static_cast<double>(count_));
    }
    return areas;
  }

 private:
  struct Face {
    Vec3 normal;   // of one of its samples
    double share;  // number of samples
  };

  [[nodiscard]] double share_of_one_face(std::size_t n) const {
    double largest = 0;
    for (const Face& face : faces_[n]) largest = std::max(largest, face.share);
    double faces = 0;
    for (const Face& face : faces_[n]) faces += face.share >= least_face * largest ? 1 : 0;
    return faces > 0 ? share_[n] / faces : 0;
  }

  NearestWalk nearest_;
  double area_;
  std::vector<std::uint32_t> share_;
  std::vector<std::vector<Face>> faces_;  // of each point on an edge
  std::size_t count_{0};
  std::uint32_t last_{0};
};

}  // namespace

std::vector<double> tributary_areas(const OrientedPoints& points, const OrientedPoints& samples,
                                    double area) {
  Shares shares{points, area};
  for (std::size_t s = 0; s < samples.size(); ++s) {
    shares.add(samples.position[s], samples.normal[s]);
  }
  return shares.areas();
}

std::vector<double> tributary_areas(const OrientedPoints& points, const SurfaceSampler& sampler,
                                    std::size_t count, std::size_t on_edges) {
  Shares shares{points, sampler.area(), on_edges};
  sampler.for_each(count,
                   [&](const Vec3& position, const Vec3& normal) { shares.add(position, normal); });
  return shares.areas();
}

}  // namespace reckon
