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
#include <vector>

#include "reckon/scan/blocks.hpp"
#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/volume.hpp"

namespace reckon {

/// The number types that volumes are stored in.
enum class VoxelType : std::uint8_t { uint8, int8, uint16, int16, uint32, int32, float32, float64 };

[[nodiscard]] std::string_view name_of(VoxelType type);
[[nodiscard]] std::optional<VoxelType> voxel_type_named(std::string_view name);
[[nodiscard]] std::size_t size_of(VoxelType type);

/// A request for a volume.
struct VolumeRequest {
  std::filesystem::path file;  ///< or a folder of TIFF slices
  double voxel{0};             ///< edge of a voxel [m]
  std::string dataset;         ///< HDF5 only; empty: the only one of three dimensions
  bool invert{false};          ///< turn bright into dark, for scans in which void is bright
};

/// A voxel's edge as a file gives it.
struct FileSpacing {
  std::optional<double> edge;  ///< in `unit`
  std::optional<double> unit;  ///< [m]; absent when the file does not give it
  std::string field;           ///< name of the field that gives it
};

/// The properties of a volume, from its file.
struct VolumeOutline {
  VoxelDims dims{0, 0, 0};
  VoxelType type{VoxelType::float32};
  FileSpacing spacing;
  std::vector<std::string> remarks;  ///< what was assumed about the file
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

/// The files that a volume consists of: its own, a text beside it, and those that its header names.
/// A folder of slices stands for all of them.
[[nodiscard]] std::vector<std::string> files_of_volume(const std::filesystem::path& file);

/// Reads a volume by the ending of its name:
///
///   .raw        numbers only; NAME.raw.txt beside it describes them, in lines
///                 `dims NX NY NZ`, `type uint16`, `order little` (or big)
///   .npy        NumPy; the last axis is x
///   .h5 .hdf5   a dataset of three dimensions, the last of which is x; axes of length 1 do not
///               count
///   .mha .mhd   MetaImage, plain or compressed
///   .nrrd .nhdr NRRD, raw or gzip
///   .tif .tiff  a file of several pages, one in which ImageJ stored all slices behind the first,
///               or a folder of slices in the order of the numbers in their names (slice_order.hpp)
///
/// Axes that a file runs backwards (NRRD's space directions, MetaImage's TransformMatrix) are
/// mirrored, so that the volume has the orientation of the header. Rotated axes are refused.
///
/// Layers are read and unpacked when they are requested, which is fastest from the first to the
/// last.
///
/// Throws Error when the file is damaged, cut short, of another number of dimensions, its slices
/// differ in size, or its voxel is not that of the request.
[[nodiscard]] std::unique_ptr<VolumeReader> open_volume(const VolumeRequest& request);
/// All of a volume. Throws Error also when it holds values that are not finite.
[[nodiscard]] StoredVolume read_volume(const VolumeRequest& request);
/// A volume that was brought to disk, and what was assumed about its file.
template <class Values>
struct LoadedVolume {
  Values volume;
  std::vector<std::string> remarks;
};
/// Likewise, from file to file. `on_layers` is called with each part.
[[nodiscard]] LoadedVolume<GrayOnDisk> load_volume(
    const VolumeRequest& request, const Workspace& work,
    const std::function<void(const GrayVolume&)>& on_layers = {});
/// A volume of labels: whole numbers not below zero. Throws Error when a value is not.
[[nodiscard]] LoadedVolume<LabelsOnDisk> load_labels(const VolumeRequest& request,
                                                     const Workspace& work);

/// Takes a volume from its first layer to its last. Its file appears when it is complete.
class VolumeWriter {
 public:
  virtual ~VolumeWriter() = default;

  /// The next layers across z. Throws Error when the disk does not take them.
  virtual void write_layers(const GrayVolume& layers) = 0;
  /// After the last of them.
  virtual void finish() = 0;
};

/// A volume's file, in the format of its ending (.h5, .npy, .raw, .mha, .nrrd or .tif), of numbers
/// of `type`: rounded to integers and clamped to their range. A .raw gets its sidecar. TIFF files
/// have a page per layer.
[[nodiscard]] std::unique_ptr<VolumeWriter> create_volume(const std::filesystem::path& file,
                                                          const VoxelDims& dims, double voxel,
                                                          VoxelType type);
/// All of it at once.
void write_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type);

/// Labels as a volume to be written or looked at. Throws Error when there are more than 2^24.
[[nodiscard]] GrayVolume to_gray(const LabelVolume& labels);
/// The reverse: whole numbers not below zero. Throws Error when a value is not.
[[nodiscard]] LabelVolume to_labels(const GrayVolume& volume, const std::string& place);

}  // namespace reckon
