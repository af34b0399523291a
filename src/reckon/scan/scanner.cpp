// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "reckon/avatar/random_variates.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scan/blur.hpp"

namespace reckon {
namespace {

constexpr int points_per_edge = 4;  // of a voxel; cubed they fill the bits of a word
constexpr double most_voxels = 2147483648.0;

void require(bool good, const char* setting, double value, const char* range) {
  if (good) return;
  throw Error{{.place = "scanner",
               .problem = fmt::format("{} is out of range", setting),
               .reason = fmt::format("{} was given, {} is allowed", value, range),
               .fix = "Choose a value in this range."}};
}

}  // namespace

/// Its grid and its pose in the volume.
struct ScannedBody {
  LevelSetView grid;
  Mat3 to_world;
  Vec3 position;
  double radius{0};
  double lipschitz{1};
  std::uint32_t label{0};
  double gray{1};     // of its solid
  Vec3 crack_normal;  // zero: it has none
  double half_crack{0};

  /// The level set at a point of the volume; infinite outside the grid, where nothing is solid.
  [[nodiscard]] double phi(const Vec3& world) const {
    if (half_crack > 0 && std::abs(dot(world - position, crack_normal)) < half_crack) {
      return std::numeric_limits<double>::infinity();
    }
    const LevelSetView::Sample sample = grid.sample(transposed_times(to_world, world - position));
    return sample.inside_grid ? sample.phi : std::numeric_limits<double>::infinity();
  }
};

namespace {

/// Which points of a voxel are solid.
std::uint64_t solid_points(const ScannedBody& body, const Vec3& center, double voxel) {
  std::uint64_t points = 0;
  std::uint64_t bit = 1;
  for (int c = 0; c < points_per_edge; ++c) {
    for (int b = 0; b < points_per_edge; ++b) {
      for (int a = 0; a < points_per_edge; ++a, bit <<= 1U) {
        const Vec3 place = Vec3{a + 0.5, b + 0.5, c + 0.5} / points_per_edge - Vec3{0.5, 0.5, 0.5};
        if (body.phi(center + voxel * place) < 0) points |= bit;
      }
    }
  }
  return points;
}

/// Fills layer k of the volume with solid shares, and with labels where they are wanted.
void fill_layer(const std::vector<ScannedBody>& bodies, bool partial_volume, std::int32_t k,
                GrayVolume& gray, LabelVolume& labels) {
  const double voxel = gray.voxel;
  const std::size_t first = gray.index(0, 0, k);
  const std::size_t layer = gray.index(0, 0, gray.low[2] + 1);
  const bool labelled = labels.holds(0, 0, k);
  std::vector<std::uint64_t> points(layer, 0);
  std::vector<double> deepest(layer, 0);
  std::vector<double> nearest(layer, std::numeric_limits<double>::infinity());
  std::vector<float> solid(layer, 1);
  const double z = (k + 0.5) * voxel;
  for (const ScannedBody& body : bodies) {
    const double reach = body.radius + voxel;
    if (std::abs(z - body.position.z) > reach) continue;
    const double half_diagonal = 0.87 * voxel * body.lipschitz;
    const auto from = [&](double center) {
      return std::max(0, static_cast<std::int32_t>(std::floor((center - reach) / voxel)));
    };
    const auto to = [&](double center, std::int32_t size) {
      return std::min(size - 1, static_cast<std::int32_t>(std::floor((center + reach) / voxel)));
    };
    for (std::int32_t j = from(body.position.y); j <= to(body.position.y, gray.dims[1]); ++j) {
      for (std::int32_t i = from(body.position.x); i <= to(body.position.x, gray.dims[0]); ++i) {
        const Vec3 center = gray.center_world(i, j, k);
        const double phi = body.phi(center);
        if (phi > half_diagonal && std::isfinite(phi)) continue;
        const std::size_t at = gray.index(i, j, gray.low[2]);
        const bool near_crack =
            body.half_crack > 0 &&
            std::abs(dot(center - body.position, body.crack_normal)) < body.half_crack + voxel;
        const bool near_surface = (near_crack || !(phi < -half_diagonal)) && partial_volume;
        if (near_surface) {
          points[at] |= solid_points(body, center, voxel);
        } else if (phi < 0) {
          points[at] = ~std::uint64_t{0};
        }
        // A voxel of two minerals takes the gray of the one that it lies deeper in.
        if (phi < nearest[at]) {
          nearest[at] = phi;
          solid[at] = static_cast<float>(body.gray);
        }
        if (phi < deepest[at]) {
          deepest[at] = phi;
          if (labelled) labels.values[labels.index(i, j, k)] = body.label;
        }
      }
    }
  }
  for (std::size_t at = 0; at < layer; ++at) {
    gray.values[first + at] = solid[at] * static_cast<float>(std::popcount(points[at])) / 64.0F;
  }
}

/// Distance of a voxel's centre from the volume's axis [voxels].
double from_axis(const VoxelDims& dims, std::int32_t i, std::int32_t j) {
  return std::hypot(i + 0.5 - 0.5 * dims[0], j + 0.5 - 0.5 * dims[1]);
}

/// Tube and floor, with the share of each voxel that they fill.
void add_container(GrayVolume& gray, const ScanArtefacts& artefacts, double tube_radius,
                   double floor_top) {
  const auto share = [](double depth) { return std::clamp(depth + 0.5, 0.0, 1.0); };
  for_each_voxel(gray.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    float& value = gray.values[gray.index(i, j, k)];
    const double r = from_axis(gray.dims, i, j);
    if (artefacts.tube > 0) {
      const double filled =
          share(r - tube_radius) * share(tube_radius + ScannerSettings::tube_width - r);
      value = std::max(value, static_cast<float>(artefacts.tube * filled));
    }
    const bool beside_tube = artefacts.tube > 0 && r > tube_radius;
    if (artefacts.floor > 0 && !beside_tube) {
      const double filled =
          share(floor_top - k - 0.5) * share(k + 0.5 - floor_top + ScannerSettings::tube_width);
      value = std::max(value, static_cast<float>(artefacts.floor * filled));
    }
  });
}

/// Cupping, shading and rings, on gray values without noise.
void shade(GrayVolume& gray, const ScannerSettings& settings) {
  const ScanArtefacts& a = settings.artefacts;
  const double step = settings.solid_gray - settings.void_gray;
  const double black = settings.void_gray / step;  // below void
  const double radius = 0.5 * std::hypot(gray.dims[0], gray.dims[1]);
  std::vector<double> ring(static_cast<std::size_t>(radius) + 2, 0);
  for (std::size_t n = 0; a.rings > 0 && n < ring.size(); ++n) {
    RandomStream random{settings.seed, RandomPurpose::other, n};
    ring[n] = a.rings * standard_normal(random);
  }
  for_each_voxel(gray.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    float& stored = gray.values[gray.index(i, j, k)];
    const double r = from_axis(gray.dims, i, j);
    const double across = (i + 0.5) / gray.dims[0] - 0.5;
    double value = black + static_cast<double>(stored);
    if (a.cupping > 0) value *= 1 - a.cupping * (1 - r * r / (radius * radius));
    if (a.gain_shading > 0) value *= 1 + a.gain_shading * across;
    if (a.shading > 0) value += a.shading * across;
    value += ring[static_cast<std::size_t>(r)];
    stored = static_cast<float>(value - black);
  });
}

void cut_circle(GrayVolume& gray, double circle_gray) {
  const double radius = 0.5 * std::min(gray.dims[0], gray.dims[1]);
  for_each_voxel(gray.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    if (from_axis(gray.dims, i, j) > radius) {
      gray.values[gray.index(i, j, k)] = static_cast<float>(circle_gray);
    }
  });
}

/// From solid shares to gray values, before the point spread function.
void harden_beam(GrayVolume& gray, double loss) {
  const Vec3 axis{0.5 * gray.dims[0], 0.5 * gray.dims[1], 0};
  const double squared_radius = axis.x * axis.x + axis.y * axis.y;
  parallel_for(static_cast<std::size_t>(gray.dims[2]), 1, [&](std::size_t layer) {
    const std::int32_t k = gray.low[2] + static_cast<std::int32_t>(layer);
    for (std::int32_t j = 0; j < gray.dims[1]; ++j) {
      for (std::int32_t i = 0; i < gray.dims[0]; ++i) {
        const double x = i + 0.5 - axis.x;
        const double y = j + 0.5 - axis.y;
        const double factor = 1 - loss * (1 - (x * x + y * y) / squared_radius);
        float& value = gray.values[gray.index(i, j, k)];
        value = static_cast<float>(value * factor);
      }
    }
  });
}

/// Also brings the step from void to solid to its gray values. Noise belongs to the voxel's place
/// in the whole volume.
void add_noise(GrayVolume& gray, const ScannerSettings& settings) {
  const std::size_t layer = gray.index(0, 0, gray.low[2] + 1);
  const std::size_t before = static_cast<std::size_t>(gray.low[2]) * layer;
  const double step = settings.solid_gray - settings.void_gray;
  parallel_for(static_cast<std::size_t>(gray.dims[2]), 1, [&](std::size_t k) {
    for (std::size_t at = k * layer; at < (k + 1) * layer; ++at) {
      double value = gray.values[at];
      if (settings.noise > 0) {
        RandomStream random{settings.seed, RandomPurpose::scan_noise, before + at};
        value += settings.noise * standard_normal(random);
      }
      gray.values[at] = static_cast<float>(settings.void_gray + step * value);
    }
  });
}

/// Drops the layers that are not in `slab`.
void trim(GrayVolume& gray, const Box& slab) {
  const std::size_t first = gray.index(0, 0, slab.low[2]);
  gray.values.erase(gray.values.begin(), gray.values.begin() + static_cast<std::ptrdiff_t>(first));
  gray.values.resize(slab.voxels());
  gray.low = slab.low;
  gray.dims = slab.dims;
}

}  // namespace

void ScannerSettings::validate() const {
  require(voxel > 0 && std::isfinite(voxel), "the voxel's edge", voxel, "a length above zero");
  require(margin >= 0 && margin <= 1000, "the margin", margin, "0 to 1000 voxels");
  require(blur >= 0 && blur <= 10, "the blur", blur, "0 to 10 voxels");
  require(noise >= 0 && noise <= 1, "the noise", noise, "0 to 1");
  require(beam_hardening >= 0 && beam_hardening <= 0.5, "the beam hardening", beam_hardening,
          "0 to 0.5");
  const ScanArtefacts& a = artefacts;
  require(a.tube >= 0 && a.tube <= 10, "the gray of the tube", a.tube, "0 to 10");
  require(a.floor >= 0 && a.floor <= 10, "the gray of the floor", a.floor, "0 to 10");
  require(std::isfinite(a.circle_gray), "the gray outside the circle", a.circle_gray, "a number");
  require(std::abs(a.shading) <= 10, "the shading", a.shading, "-10 to 10");
  require(std::abs(a.gain_shading) <= 1, "the shading of the gain", a.gain_shading, "-1 to 1");
  require(a.cupping >= 0 && a.cupping <= 0.9, "the cupping", a.cupping, "0 to 0.9");
  require(a.rings >= 0 && a.rings <= 1, "the rings", a.rings, "0 to 1");
  require(a.mineral_share >= 0 && a.mineral_share <= 1, "the share of the other mineral",
          a.mineral_share, "0 to 1");
  require(a.mineral_gray > 0 && a.mineral_gray <= 10, "the gray of the other mineral",
          a.mineral_gray, "above 0, to 10");
  require(a.crack_share >= 0 && a.crack_share <= 1, "the share of cracked grains", a.crack_share,
          "0 to 1");
  require(a.crack_width > 0 && a.crack_width <= 20, "the width of the cracks", a.crack_width,
          "above 0, to 20 voxels");
  require(std::isfinite(void_gray) && std::isfinite(solid_gray) && solid_gray > void_gray,
          "the gray of solid", solid_gray, "more than the gray of void");
}

Scanner::Scanner(const std::vector<GrainState>& grains, const ReadShape& read_shape,
                 const ScannerSettings& settings)
    : settings_{settings}, grains_{grains} {
  settings.validate();
  if (grains.empty()) {
    throw Error{{.place = "scanner",
                 .problem = "there are no grains to scan",
                 .reason = {},
                 .fix = "Name a run or a scene with grains."}};
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity};
  Vec3 high = -low;
  for (const GrainState& grain : grains) {
    if (!shapes_.contains(grain.shape)) shapes_.emplace(grain.shape, read_shape(grain.shape));
    const double radius = shapes_.at(grain.shape).bounding_radius;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], grain.position[axis] - radius);
      high[axis] = std::max(high[axis], grain.position[axis] + radius);
    }
  }
  double count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::ceil((high[axis] - low[axis]) / settings.voxel + 2 * settings.margin);
    count *= cells;
    require(count < most_voxels, "the voxel's edge", settings.voxel,
            "what makes fewer than 2^31 voxels");
    dims_[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(cells);
  }
  const ScanArtefacts& artefacts = settings.artefacts;
  const double margin = settings.margin * settings.voxel;
  const Vec3 corner = low - Vec3{margin, margin, margin};
  for (GrainState& grain : grains_) {
    const Shape& shape = shapes_.at(grain.shape);
    grain.position -= corner;
    grain.orientation = normalized(grain.orientation);
    bodies_.push_back({shape.level_set,
                       rotation_matrix(grain.orientation),
                       grain.position,
                       shape.bounding_radius,
                       shape.lipschitz,
                       static_cast<std::uint32_t>(bodies_.size() + 1),
                       1.0,
                       {},
                       0.0});
    ScannedBody& body = bodies_.back();
    RandomStream random{settings.seed, RandomPurpose::other,
                        body.label + (std::uint64_t{1} << 32U)};
    if (random.uniform() < artefacts.mineral_share) body.gray = artefacts.mineral_gray;
    if (random.uniform() < artefacts.crack_share) {
      body.crack_normal = normalized(
          Vec3{standard_normal(random), standard_normal(random), standard_normal(random)});
      body.half_crack = 0.5 * artefacts.crack_width * settings.voxel;
    }
  }
  if (artefacts.tube > 0 || artefacts.floor > 0) place_container();
}

Scanner::~Scanner() = default;

/// The tube touches the outermost node about the axis, the floor the lowest.
void Scanner::place_container() {
  const double voxel = settings_.voxel;
  floor_top_ = dims_[2];
  for (const GrainState& grain : grains_) {
    const Shape& shape = shapes_.at(grain.shape);
    const Mat3 rotation = rotation_matrix(grain.orientation);
    for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
      const Vec3 world = (rotation * shape.nodes.position(n) + grain.position) / voxel;
      tube_radius_ =
          std::max(tube_radius_, std::hypot(world.x - 0.5 * dims_[0], world.y - 0.5 * dims_[1]));
      floor_top_ = std::min(floor_top_, world.z);
    }
  }
}

std::int32_t Scanner::margin() const { return blur_reach(settings_.blur); }

ScannedLayers Scanner::scan(const Box& slab) const {
  GrayVolume gray{slab.widened(margin(), Box{dims_}), settings_.voxel};
  LabelVolume labels{slab, settings_.voxel};
  parallel_for(static_cast<std::size_t>(gray.dims[2]), 1, [&](std::size_t layer) {
    fill_layer(bodies_, settings_.partial_volume, gray.low[2] + static_cast<std::int32_t>(layer),
               gray, labels);
  });
  const ScanArtefacts& artefacts = settings_.artefacts;
  if (artefacts.tube > 0 || artefacts.floor > 0) {
    add_container(gray, artefacts, tube_radius_, floor_top_);
  }
  if (settings_.beam_hardening > 0) harden_beam(gray, settings_.beam_hardening);
  blur_volume(gray, settings_.blur);
  trim(gray, slab);
  if (artefacts.cupping > 0 || artefacts.shading > 0 || artefacts.gain_shading > 0 ||
      artefacts.rings > 0) {
    shade(gray, settings_);
  }
  add_noise(gray, settings_);
  if (artefacts.circle > 0) cut_circle(gray, artefacts.circle_gray);
  return {std::move(gray), std::move(labels)};
}

SimulatedScan scan_assembly(const std::vector<GrainState>& grains, const ReadShape& read_shape,
                            const ScannerSettings& settings) {
  const Scanner scanner{grains, read_shape, settings};
  ScannedLayers all = scanner.scan(Box{scanner.dims()});
  return {std::move(all.gray), std::move(all.labels), scanner.grains()};
}

}  // namespace reckon
