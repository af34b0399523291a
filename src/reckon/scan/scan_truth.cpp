// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/scan_truth.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/error.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

constexpr double some_share = 0.1;      // that counts as a part of a grain
constexpr double distinct_axes = 0.05;  // relative difference of moments

/// The avatar of each true grain.
struct Matching {
  std::map<std::uint32_t, std::uint32_t> avatar_of;  // true grain -> place of its avatar
  std::map<std::uint32_t, std::uint32_t> most_in;    // avatar -> true grain that it has most of
  std::uint32_t split{0};
  std::uint32_t joined{0};
};

Matching match(const ScanTruth& truth, const ScannedAssembly& assembly, const LabelsOnDisk& labels,
               const Workspace& work) {
  std::map<std::uint32_t, std::uint32_t> avatar_of_label;
  for (std::uint32_t n = 0; n < assembly.quality.size(); ++n) {
    avatar_of_label[assembly.quality[n].label] = n;
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> shared;
  std::map<std::uint32_t, std::uint64_t> truth_size;
  std::map<std::uint32_t, std::uint64_t> label_size;
  for (const Box& slab : work.slabs(labels.dims())) {
    const LabelVolume true_part = truth.labels.read(slab);
    const LabelVolume part = labels.read(slab);
    for (std::size_t v = 0; v < part.values.size(); ++v) {
      const std::uint32_t t = true_part.values[v];
      const std::uint32_t f = part.values[v];
      if (t != 0) ++truth_size[t];
      if (f != 0) ++label_size[f];
      if (t != 0 && f != 0) ++shared[{t, f}];
    }
  }
  Matching matching;
  std::map<std::uint32_t, int> parts_of_truth;
  std::map<std::uint32_t, int> parts_of_label;
  const auto share_of = [&](std::uint64_t count, std::uint64_t size) {
    return static_cast<double>(count) / static_cast<double>(size);
  };
  for (const auto& [pair, count] : shared) {
    if (share_of(count, truth_size[pair.first]) < some_share) continue;
    ++parts_of_truth[pair.first];
    ++parts_of_label[pair.second];
  }
  std::map<std::uint32_t, std::uint64_t> most;
  for (const auto& [pair, count] : shared) {
    const auto avatar = avatar_of_label.find(pair.second);
    if (avatar == avatar_of_label.end()) continue;
    if (count > most[avatar->second]) {
      most[avatar->second] = count;
      matching.most_in[avatar->second] = pair.first - 1;
    }
    const bool whole = share_of(count, truth_size[pair.first]) > 0.5 &&
                       share_of(count, label_size[pair.second]) > 0.5;
    if (whole && parts_of_truth[pair.first] == 1 && parts_of_label[pair.second] == 1) {
      matching.avatar_of[pair.first - 1] = avatar->second;
    }
  }
  for (const auto& [grain, parts] : parts_of_truth) matching.split += parts > 1 ? 1 : 0;
  for (const auto& [label, parts] : parts_of_label) matching.joined += parts > 1 ? 1 : 0;
  return matching;
}

/// Adds the errors of one avatar, each divided by `count`.
struct SurfaceErrors {
  double distance{0};
  double angle{0};
};
SurfaceErrors compare_surfaces(const ShapeView& shape, const GrainState& grain,
                               const Shape& true_shape, const GrainState& true_grain) {
  const Mat3 rotation = rotation_matrix(grain.orientation);
  const Mat3 true_rotation = rotation_matrix(true_grain.orientation);
  const LevelSetView grid = shape.level_set;
  const LevelSetView true_grid{true_shape.level_set};
  SurfaceErrors errors;
  double weight = 0;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const Vec3 body = shape.nodes.position(n);
    const Vec3 world = rotation * body + grain.position;
    const auto own = grid.sample(body);
    const auto other =
        true_grid.sample(transposed_times(true_rotation, world - true_grain.position));
    if (!other.inside_grid) continue;
    const Vec3 normal = normalized(rotation * own.gradient_body);
    const Vec3 true_normal = normalized(true_rotation * other.gradient_body);
    const double area = shape.nodes.area[n];
    errors.distance += area * std::abs(other.phi);
    errors.angle += area * std::atan2(norm(cross(normal, true_normal)), dot(normal, true_normal));
    weight += area;
  }
  return {errors.distance / weight, errors.angle / weight};
}

/// `shown`: by true grain, whether the scan shows it whole. A contact of a grain that was lost,
/// split or joined is a contact missed.
void compare_contacts(const ScanTruth& truth, const ScannedAssembly& assembly,
                      const Matching& matching, const std::vector<bool>& shown,
                      TruthFigures& figures) {
  std::map<std::uint32_t, std::uint32_t> truth_of;
  for (const auto& [grain, avatar] : matching.avatar_of) truth_of[avatar] = grain;
  std::set<std::pair<std::uint32_t, std::uint32_t>> real;
  for (const NearPair& pair : near_surfaces(shape_views(truth.shapes), truth.grains, 0)) {
    if (shown[pair.a] && shown[pair.b]) real.insert({pair.a, pair.b});
  }
  const auto is_cut = [&](std::uint32_t avatar) {
    const auto grain = matching.most_in.find(avatar);
    return grain != matching.most_in.end() && !shown[grain->second];
  };
  figures.true_contacts = static_cast<std::uint32_t>(real.size());
  for (const ScannedContact& contact : assembly.contacts) {
    if (!contact.touching || is_cut(contact.pair.a) || is_cut(contact.pair.b)) continue;
    ++figures.found_contacts;
    const auto a = truth_of.find(contact.pair.a);
    const auto b = truth_of.find(contact.pair.b);
    if (a == truth_of.end() || b == truth_of.end()) continue;
    figures.right_contacts += real.contains(std::minmax(a->second, b->second)) ? 1U : 0U;
  }
}

}  // namespace

double TruthFigures::recall() const {
  return true_contacts == 0 ? 1 : static_cast<double>(right_contacts) / true_contacts;
}
double TruthFigures::precision() const {
  return found_contacts == 0 ? 1 : static_cast<double>(right_contacts) / found_contacts;
}

TruthFigures compare_with_truth(const ScanTruth& truth, const ScannedAssembly& assembly,
                                const LabelsOnDisk& labels, const Workspace& work) {
  if (truth.labels.dims() != labels.dims()) {
    throw Error{{.place = "truth",
                 .problem = "the true labels are of another volume",
                 .reason = "their dimensions differ from the scan's",
                 .fix = "Name the folder that `reckon grains scan` wrote for this volume."}};
  }
  const Matching matching = match(truth, assembly, labels, work);
  TruthFigures figures;
  std::vector<bool> shown(truth.grains.size(), false);
  const auto grains = measure_labels(truth.labels, work);
  for (std::size_t n = 0; n < std::min(grains.size(), shown.size()); ++n) {
    shown[n] = grains[n].voxels > 0 && !grains[n].on_border;
    figures.grains += shown[n] ? 1U : 0U;
  }
  figures.found_once = static_cast<std::uint32_t>(matching.avatar_of.size());
  figures.split = matching.split;
  figures.joined = matching.joined;

  std::map<ShapeId, SolidProperties> true_solids;
  for (const auto& [t, f] : matching.avatar_of) {
    const ShapeId shape = truth.grains[t].shape;
    if (true_solids.contains(shape)) continue;
    true_solids[shape] = solid_properties(extract_surface(truth.shapes[shape.get()].level_set));
  }
  const double count = std::max(1.0, static_cast<double>(figures.found_once));
  const double voxel = labels.voxel();
  double axes = 0;
  for (const auto& [t, f] : matching.avatar_of) {
    const GrainState& true_grain = truth.grains[t];
    const Shape& true_shape = truth.shapes[true_grain.shape.get()];
    const SolidProperties& solid = true_solids[true_grain.shape];
    const PrincipalFrame frame = principal_frame(solid);
    const ShapeView shape = assembly.shapes[f].view();
    const GrainState& grain = assembly.grains[f];
    const double error = shape.mass.volume / solid.volume - 1;
    figures.volume_error += error / count;
    figures.volume_error_absolute += std::abs(error) / count;
    figures.voxels_per_diameter +=
        portable::cbrt(6 * solid.volume / std::numbers::pi) / voxel / count;
    for (int axis = 0; axis < 3; ++axis) {
      figures.inertia_error +=
          std::abs(shape.mass.inertia[axis] / frame.moments[axis] - 1) / (3 * count);
    }
    const Mat3 true_rotation = rotation_matrix(true_grain.orientation);
    const Vec3 center = true_rotation * solid.centroid + true_grain.position;
    figures.center_error += norm(grain.position - center) / voxel / count;
    if (frame.moments.y / frame.moments.x > 1 + distinct_axes) {
      const Vec3 long_axis = rotation_matrix(grain.orientation) * Vec3{1, 0, 0};
      const Vec3 true_axis = true_rotation * frame.rotation.row_x;
      figures.axis_error +=
          std::atan2(norm(cross(long_axis, true_axis)), std::abs(dot(long_axis, true_axis)));
      ++axes;
    }
    const SurfaceErrors errors = compare_surfaces(shape, grain, true_shape, true_grain);
    figures.surface_error += errors.distance / voxel / count;
    figures.normal_error += errors.angle / count;
  }
  if (axes > 0) figures.axis_error /= axes;
  compare_contacts(truth, assembly, matching, shown, figures);
  return figures;
}

}  // namespace reckon
