// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/scan_avatars.hpp"

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
#include "reckon/scan/labels.hpp"

namespace reckon {
namespace {

// Beyond a grain's voxels or a contact, of what is read for them [voxels]: what is cut out of the
// territories, and the lines of gray values, reach less far.
constexpr std::int32_t surroundings = 12;

struct Avatar {
  KeptShape shape;
  GrainState grain;
  AvatarQuality quality;
  double solid_gray{0};
  EdgeProfile edge;
};

/// The part of a scan that some grains are made from.
struct ScanPart {
  GrayVolume raw;
  GrayVolume denoised;
  LabelVolume labels;
  LabelVolume territories;

  ScanPart(const StoredScan& scan, const Box& box)
      : raw{scan.raw.read(box)},
        denoised{scan.denoised.read(box)},
        labels{scan.labels.read(box)},
        territories{grown(labels, territory_layers)} {}
};

/// The smallest box that holds both.
Box around(const Box& a, const Box& b) {
  Box both = a;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    both.low[axis] = std::min(a.low[axis], b.low[axis]);
    both.dims[axis] = std::max(a.end(axis), b.end(axis)) - both.low[axis];
  }
  return both;
}

AvatarQuality judge(const Shape& shape, const GrainSurface& surface, const TriangleMesh& body_mesh,
                    std::uint32_t label, const LabelledGrain& grain) {
  AvatarQuality quality;
  quality.label = label;
  quality.given_label = grain.given;
  quality.voxels = grain.voxels;
  quality.label_volume = surface.label_volume;
  quality.gray_volume = surface.gray_volume;
  quality.volume = shape.mass.volume;
  quality.level = surface.level;
  quality.solid_gray = surface.solid_gray;
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

/// The gray values where only void is in front of the grain.
EdgeProfile free_edge(const SegmentedScan& scan, const Avatar& avatar) {
  constexpr std::size_t lines_per_grain = 500;
  constexpr int looks_per_voxel = 2;
  const LabelVolume& territories = *scan.territories;
  const double voxel = territories.voxel;
  const auto free_before = [&](const Vec3& point, const Vec3& normal) {
    for (int n = 0; n <= EdgeProfile::reach * looks_per_voxel; ++n) {
      const double t = static_cast<double>(n) / looks_per_voxel;
      const Vec3 p = point / voxel + t * normal;
      const auto i = static_cast<std::int32_t>(std::floor(p.x));
      const auto j = static_cast<std::int32_t>(std::floor(p.y));
      const auto k = static_cast<std::int32_t>(std::floor(p.z));
      if (!territories.holds(i, j, k)) return false;
      const std::uint32_t owner = territories.values[territories.index(i, j, k)];
      if (owner != 0 && owner != avatar.quality.label) return false;
    }
    return true;
  };
  EdgeProfile profile;
  const ShapeView shape = avatar.shape.view();
  const Mat3 rotation = rotation_matrix(avatar.grain.orientation);
  GrayLevels levels = scan.levels;
  levels.solid_gray = avatar.solid_gray;
  const std::size_t stride = shape.nodes.size() / lines_per_grain + 1;
  for (std::size_t node = 0; node < shape.nodes.size(); node += stride) {
    const Vec3 body = shape.nodes.position(node);
    const Vec3 normal = normalized(rotation * shape.level_set.sample(body).gradient_body);
    const Vec3 world = rotation * body + avatar.grain.position;
    if (!free_before(world, normal)) continue;
    profile.add(*scan.denoised, levels, world, normal);
  }
  return profile;
}

Avatar make_avatar(const SegmentedScan& scan, std::uint32_t label, const LabelledGrain& grain,
                   const AvatarSettings& settings) {
  const GrainSurface surface =
      extract_grain(scan, label, grain, settings.smoothing, settings.sharpening);
  const PrincipalFrame frame = principal_frame(solid_properties(surface.mesh_world));
  const TriangleMesh body_mesh = to_frame(surface.mesh_world, frame);
  Avatar avatar;
  Shape shape =
      build_shape(body_mesh, settings.resolution, name_of(grain, label), SurfaceKind::sampled);
  avatar.quality = judge(shape, surface, body_mesh, label, grain);
  avatar.shape = KeptShape{std::move(shape)};
  avatar.grain.position = frame.origin_mesh;
  avatar.grain.orientation = quaternion_from_matrix(transpose(frame.rotation));
  avatar.solid_gray = surface.solid_gray;
  avatar.edge = free_edge(scan, avatar);
  return avatar;
}

/// Places in a list, by the block in which what stands there lies, and what has to be read for it.
struct BlockWork {
  std::vector<std::size_t> members;
  Box box;
};
template <class BoxOf>
std::vector<BlockWork> share_out(std::size_t count, const StoredScan& scan, BoxOf&& box_of) {
  const auto blocks = scan.work.blocks(scan.labels.dims(), scan.work.grain_overlap());
  std::vector<BlockWork> shares(blocks.size());
  for (std::size_t n = 0; n < count; ++n) {
    const Box box = box_of(n);
    const auto middle = [&](std::size_t axis) {
      return std::clamp(box.low[axis] + box.dims[axis] / 2, 0, scan.labels.dims()[axis] - 1);
    };
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (!blocks[b].core.holds(middle(0), middle(1), middle(2))) continue;
      const Box wide = box.widened(surroundings, scan.labels.box());
      shares[b].box = shares[b].members.empty() ? wide : around(shares[b].box, wide);
      shares[b].members.push_back(n);
      break;
    }
  }
  return shares;
}

void find_contacts(const StoredScan& scan, const std::vector<double>& solid_gray,
                   double contact_gap, ScannedAssembly& assembly) {
  const double voxel = scan.labels.voxel();
  const auto pairs =
      near_surfaces(shape_views(assembly.shapes), assembly.grains, contact_reach * voxel);
  assembly.contacts.resize(pairs.size());
  const auto place_of = [&](std::size_t p) {
    Box box{{1, 1, 1}};
    for (int axis = 0; axis < 3; ++axis) {
      box.low[static_cast<std::size_t>(axis)] =
          static_cast<std::int32_t>(std::floor(pairs[p].point_world[axis] / voxel));
    }
    return box;
  };
  for (const BlockWork& share : share_out(pairs.size(), scan, place_of)) {
    if (share.members.empty()) continue;
    const GrayVolume denoised = scan.denoised.read(share.box);
    parallel_for(share.members.size(), 16, [&](std::size_t n) {
      const std::size_t p = share.members[n];
      GrayLevels levels = scan.levels;
      levels.solid_gray = 0.5 * (solid_gray[pairs[p].a] + solid_gray[pairs[p].b]);
      const double gap = gray_gap(denoised, levels, pairs[p], assembly.spread);
      assembly.contacts[p] = {pairs[p], gap, gap <= contact_gap * voxel};
    });
  }
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

ScannedAssembly make_avatars(const StoredScan& scan, const std::vector<LabelledGrain>& grains,
                             const std::vector<std::uint32_t>& kept, const AvatarSettings& settings,
                             const std::function<void(std::size_t)>& on_progress) {
  std::vector<std::optional<Avatar>> made(kept.size());
  std::vector<std::string> refused(kept.size());
  std::mutex mutex;
  std::size_t done = 0;
  const auto box_of = [&](std::size_t n) {
    const LabelledGrain& grain = grains[kept[n] - 1];
    return around({grain.low, {1, 1, 1}}, {grain.high, {1, 1, 1}});
  };
  for (const BlockWork& share : share_out(kept.size(), scan, box_of)) {
    if (share.members.empty()) continue;
    const ScanPart part{scan, share.box};
    const SegmentedScan pieces{&part.raw, &part.denoised, &part.labels, &part.territories,
                               scan.levels};
    parallel_for(share.members.size(), 1, [&](std::size_t m) {
      const std::size_t n = share.members[m];
      try {
        made[n] = make_avatar(pieces, kept[n], grains[kept[n] - 1], settings);
      } catch (const Error& error) {
        refused[n] = error.what();
      }
      const std::lock_guard lock{mutex};
      if (on_progress) on_progress(++done);
    });
  }
  ScannedAssembly assembly;
  std::vector<double> solid_gray;
  EdgeProfile edges;
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
    edges.add(made[n]->edge);
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
  assembly.spread = edges.spread();
  find_contacts(scan, solid_gray, settings.contact_gap, assembly);
  return assembly;
}

}  // namespace reckon
