// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/scan_avatars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scan/gray_gap.hpp"

namespace reckon {
namespace {

struct Avatar {
  KeptShape shape;
  GrainState grain;
  AvatarQuality quality;
  double solid_gray{0};
};

AvatarQuality judge(const Shape& shape, const GrainSurface& surface, const TriangleMesh& body_mesh,
                    std::uint32_t label, const LabelledGrain& grain) {
  AvatarQuality quality;
  quality.label = label;
  quality.voxels = grain.voxels;
  quality.label_volume = surface.label_volume;
  quality.gray_volume = surface.gray_volume;
  quality.volume = shape.mass.volume;
  quality.level = surface.level;
  const LevelSetView grid{shape.level_set};
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const double slope = norm(grid.sample(shape.nodes.position(n)).gradient_body);
    quality.gradient_error += std::abs(slope - 1) / static_cast<double>(shape.nodes.size());
  }
  double squares = 0;
  for (const Vec3& vertex : body_mesh.vertices) {
    const double phi = grid.sample(vertex).phi;
    squares += phi * phi;
  }
  quality.surface_distance = std::sqrt(squares / static_cast<double>(body_mesh.vertices.size()));
  quality.area_kept = surface_area(extract_surface(grid)) / surface_area(body_mesh);
  return quality;
}

Avatar make_avatar(const SegmentedScan& scan, std::uint32_t label, const LabelledGrain& grain,
                   const AvatarSettings& settings) {
  const GrainSurface surface = extract_grain(scan, label, grain, settings.smoothing);
  const PrincipalFrame frame = principal_frame(solid_properties(surface.mesh_world));
  const TriangleMesh body_mesh = to_frame(surface.mesh_world, frame);
  Avatar avatar;
  Shape shape = build_shape(body_mesh, settings.resolution, fmt::format("grain_{}", label));
  avatar.quality = judge(shape, surface, body_mesh, label, grain);
  avatar.shape = KeptShape{std::move(shape)};
  avatar.grain.position = frame.origin_mesh;
  avatar.grain.orientation = quaternion_from_matrix(transpose(frame.rotation));
  avatar.solid_gray = surface.solid_gray;
  return avatar;
}

/// The blur of the denoised volume [voxels], from where grains have nothing but void before them.
double measured_spread(const SegmentedScan& scan, const std::vector<double>& solid_gray,
                       const ScannedAssembly& assembly) {
  constexpr std::size_t lines_per_grain = 500;
  constexpr int looks_per_voxel = 2;
  const LabelVolume& territories = *scan.territories;
  const double voxel = territories.voxel;
  const auto free_before = [&](std::uint32_t label, const Vec3& point, const Vec3& normal) {
    for (int n = 0; n <= EdgeProfile::reach * looks_per_voxel; ++n) {
      const double t = static_cast<double>(n) / looks_per_voxel;
      const Vec3 p = point / voxel + t * normal;
      const auto i = static_cast<std::int32_t>(std::floor(p.x));
      const auto j = static_cast<std::int32_t>(std::floor(p.y));
      const auto k = static_cast<std::int32_t>(std::floor(p.z));
      if (!territories.holds(i, j, k)) return false;
      const std::uint32_t owner = territories.values[territories.index(i, j, k)];
      if (owner != 0 && owner != label) return false;
    }
    return true;
  };
  std::vector<EdgeProfile> profiles(assembly.shapes.size());
  parallel_for(profiles.size(), 1, [&](std::size_t n) {
    const ShapeView shape = assembly.shapes[n].view();
    const GrainState& grain = assembly.grains[n];
    const Mat3 rotation = rotation_matrix(grain.orientation);
    GrayLevels levels = scan.levels;
    levels.solid_gray = solid_gray[n];
    const std::size_t stride = shape.nodes.size() / lines_per_grain + 1;
    for (std::size_t node = 0; node < shape.nodes.size(); node += stride) {
      const Vec3 body = shape.nodes.position(node);
      const Vec3 normal = normalized(rotation * shape.level_set.sample(body).gradient_body);
      const Vec3 world = rotation * body + grain.position;
      if (!free_before(assembly.quality[n].label, world, normal)) continue;
      profiles[n].add(*scan.denoised, levels, world, normal);
    }
  });
  EdgeProfile all;
  for (const EdgeProfile& profile : profiles) all.add(profile);
  return all.spread();
}

void find_contacts(const SegmentedScan& scan, const std::vector<double>& solid_gray,
                   double contact_gap, ScannedAssembly& assembly) {
  const double voxel = scan.labels->voxel;
  assembly.spread = measured_spread(scan, solid_gray, assembly);
  const auto pairs =
      near_surfaces(shape_views(assembly.shapes), assembly.grains, contact_reach * voxel);
  assembly.contacts.resize(pairs.size());
  parallel_for(pairs.size(), 16, [&](std::size_t p) {
    GrayLevels levels = scan.levels;
    levels.solid_gray = 0.5 * (solid_gray[pairs[p].a] + solid_gray[pairs[p].b]);
    const double gap = gray_gap(*scan.denoised, levels, pairs[p], assembly.spread);
    assembly.contacts[p] = {pairs[p], gap, gap <= contact_gap * voxel};
  });
  for (const ScannedContact& contact : assembly.contacts) {
    for (const std::uint32_t n : {contact.pair.a, contact.pair.b}) {
      AvatarQuality& quality = assembly.quality[n];
      ++quality.neighbours;
      quality.contacts += contact.touching ? 1 : 0;
      quality.deepest_overlap = std::max(quality.deepest_overlap, -contact.pair.gap);
    }
  }
}

}  // namespace

std::vector<ShapeView> shape_views(const ShapeLibrary& shapes) {
  return {shapes.begin(), shapes.end()};
}

std::vector<ShapeView> shape_views(const std::vector<KeptShape>& shapes) {
  std::vector<ShapeView> views;
  views.reserve(shapes.size());
  for (const KeptShape& shape : shapes) views.push_back(shape.view());
  return views;
}

ScannedAssembly make_avatars(const SegmentedScan& scan, const std::vector<LabelledGrain>& grains,
                             const std::vector<std::uint32_t>& kept, const AvatarSettings& settings,
                             const std::function<void(std::size_t)>& on_progress) {
  std::vector<std::optional<Avatar>> made(kept.size());
  std::vector<std::string> refused(kept.size());
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(kept.size(), 1, [&](std::size_t n) {
    try {
      made[n] = make_avatar(scan, kept[n], grains[kept[n] - 1], settings);
    } catch (const Error& error) {
      refused[n] = error.what();
    }
    const std::lock_guard lock{mutex};
    if (on_progress) on_progress(++done);
  });
  ScannedAssembly assembly;
  std::vector<double> solid_gray;
  for (std::size_t n = 0; n < made.size(); ++n) {
    if (!made[n]) {
      assembly.refused.push_back(refused[n]);
      continue;
    }
    const auto place = static_cast<std::uint32_t>(assembly.shapes.size());
    assembly.shapes.push_back(std::move(made[n]->shape));
    assembly.grains.push_back(made[n]->grain);
    assembly.grains.back().id = GrainId{place};
    assembly.grains.back().shape = ShapeId{place};
    assembly.quality.push_back(made[n]->quality);
    solid_gray.push_back(made[n]->solid_gray);
  }
  if (assembly.shapes.empty()) {
    throw Error{{.place = "avatars",
                 .problem = "no grain became an avatar",
                 .reason = assembly.refused.empty()
                               ? "all are tiny or cut off by the volume's border"
                               : assembly.refused.front(),
                 .fix = "Look at the pictures of the slices; check --voxel, --threshold and "
                        "--fewest-voxels."}};
  }
  find_contacts(scan, solid_gray, settings.contact_gap, assembly);
  return assembly;
}

}  // namespace reckon
