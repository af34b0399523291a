// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "reckon/scan/blocks.hpp"
#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/volume.hpp"

namespace reckon {

/// The number types that volumes are stored in.
enum class VoxelType : std::uint8_t { uint8, int8, uint16, int16, uint32, int32, float32, float64 };

[[nodiscard]] std::string_view name_of(VoxelType type);
[[nodiscard]] std::optional<VoxelType> voxel_type_named(std::string_view name);
[[nodiscard]] std::size_t size_of(VoxelType type);

/// What is to be read.
struct VolumeRequest {
  std::filesystem::path file;  ///< or a folder of TIFF slices
  double voxel{0};             ///< edge of a voxel [m]
  std::string dataset;         ///< HDF5 only; empty: the only one of three dimensions
};

/// What a volume's file says about it.
struct VolumeOutline {
  VoxelDims dims{0, 0, 0};
  VoxelType type{VoxelType::float32};
  std::optional<double> spacing;  ///< a voxel's edge as the file tells it, in whatever unit
};

/// A volume's file, of which layers across z are read.
class VolumeReader {
 public:
  virtual ~VolumeReader() = default;

  VolumeOutline outline;

  /// So many layers from `first` on. Values as float; whole numbers are exact up to 2^24.
  [[nodiscard]] virtual GrayVolume read_layers(std::int32_t first, std::int32_t count) = 0;
};

/// A volume as it was stored.
struct StoredVolume : VolumeOutline {
  GrayVolume gray;
};

/// Reads a volume by the ending of its name:
///
///   .raw        numbers and nothing else; NAME.raw.txt beside it says what they are, in lines
///                 `dims NX NY NZ`, `type uint16`, `order little` (or big)
///   .npy        NumPy; the last axis is x
///   .h5 .hdf5   a dataset of three dimensions, the last of which is x
///   .mha .mhd   MetaImage       (needs the component `ct`)
///   .nrrd .nhdr NRRD            (likewise)
///   .tif .tiff  a multi-page file, or a folder of slices in the order of their names (likewise)
///
/// Layers are read as they are asked for, but for MetaImage and NRRD with compressed numbers and
/// multi-page TIFF files that are not plain: these are unpacked at once, in memory.
///
/// Throws Error when the file is damaged, cut short, of another number of dimensions, its slices
/// differ in size, the voxel that it tells is not that of the request, or it must be unpacked and
/// does not fit into `memory` [bytes; 0: no limit].
[[nodiscard]] std::unique_ptr<VolumeReader> open_volume(const VolumeRequest& request,
                                                        std::uint64_t memory = 0);
/// All of a volume. Throws Error also when it holds values that are not finite.
[[nodiscard]] StoredVolume read_volume(const VolumeRequest& request);
/// Likewise, from file to file. `on_layers` sees it pass by.
[[nodiscard]] GrayOnDisk load_volume(const VolumeRequest& request, const Workspace& work,
                                     const std::function<void(const GrayVolume&)>& on_layers = {});
/// A volume of labels: whole numbers not below zero. Throws Error when a value is not.
[[nodiscard]] LabelsOnDisk load_labels(const VolumeRequest& request, const Workspace& work);

/// Writes a volume, in the format of its ending, as numbers of `type`: rounded to integers and
/// clamped to their range. A .raw gets its sidecar. TIFF files are multi-page.
void write_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type);

/// Labels as a volume to be written or looked at. Throws Error when there are more than 2^24.
[[nodiscard]] GrayVolume to_gray(const LabelVolume& labels);
/// The reverse: whole numbers not below zero. Throws Error when a value is not.
[[nodiscard]] LabelVolume to_labels(const GrayVolume& volume, const std::string& place);

}  // namespace reckon
