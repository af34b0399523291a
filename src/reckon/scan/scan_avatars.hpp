// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "reckon/avatar/shape_builder.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/scan/blocks.hpp"
#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/grain_surface.hpp"
#include "reckon/scan/near_pairs.hpp"
#include "reckon/shape/kept_shape.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// The quality of an avatar of a scanned grain.
struct AvatarQuality {
  std::uint32_t label{0};
  std::uint32_t given_label{0};  ///< LabelledGrain::given
  std::uint64_t voxels{0};
  double label_volume{0};      ///< of its voxels [m^3]
  double gray_volume{0};       ///< of its solid shares [m^3]
  double volume{0};            ///< of the avatar [m^3]
  double level{0};             ///< solid share at its surface
  double solid_gray{0};        ///< deep inside it
  double gradient_error{0};    ///< mean of ||grad phi| - 1| at its nodes
  double surface_distance{0};  ///< root mean square of phi on the scanned surface [m]
  double area_kept{0};  ///< area of the zero surface of the grid over that of the scanned surface
  double deepest_overlap{0};    ///< with any neighbour at the scanned pose [m]
  std::uint32_t neighbours{0};  ///< nearer than contact_reach
  std::uint32_t contacts{0};
};

/// The largest gap of avatars whose contact is tested in the gray values [voxels].
inline constexpr double contact_reach = 1.5;

/// A pair of avatars as scanned.
struct ScannedContact {
  NearPair pair;
  double gray_gap{0};    ///< [m]
  bool touching{false};  ///< gray_gap at most what the settings allow
};

struct AvatarSettings {
  ShapeResolution resolution;
  double smoothing{1.5};     ///< see extract_grain [voxels]
  double sharpening{7};      ///< likewise
  double contact_gap{0.12};  ///< largest gray gap of grains that count as touching [voxels]
};

/// Grains of a scan as avatars: shape n belongs to grain n.
struct ScannedAssembly {
  std::vector<KeptShape> shapes;
  std::vector<GrainState> grains;  ///< id and shape n, at the scanned pose
  std::vector<AvatarQuality> quality;
  std::vector<ScannedContact> contacts;  ///< pairs nearer than contact_reach
  double spread{1};                      ///< see EdgeProfile [voxels]
  std::vector<std::string> refused;      ///< why some grains have no avatar
};

/// A segmented scan on disk.
struct StoredScan {
  GrayOnDisk raw;
  GrayOnDisk denoised;
  LabelsOnDisk labels;
  GrayLevels levels;
  Workspace work;
};

/// Makes an avatar of every grain in `kept` and finds their contacts, block by block. Grains whose
/// form the resolution cannot hold are left out, with the reason. Uses all threads; the result
/// depends neither on their number nor on the blocks. Throws Error when no grain is left.
[[nodiscard]] ScannedAssembly make_avatars(const StoredScan& scan,
                                           const std::vector<LabelledGrain>& grains,
                                           const std::vector<std::uint32_t>& kept,
                                           const AvatarSettings& settings,
                                           const std::function<void(std::size_t)>& on_progress);

/// All shapes as the kernels read them.
[[nodiscard]] std::vector<ShapeView> shape_views(const ShapeLibrary& shapes);
[[nodiscard]] std::vector<ShapeView> shape_views(const std::vector<KeptShape>& shapes);

}  // namespace reckon
