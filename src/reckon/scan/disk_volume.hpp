// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "reckon/scan/volume.hpp"

namespace reckon {

/// Bytes in a file, read and written at any place. Throws Error when the disk does not do it.
class ByteFile {
 public:
  /// For reading.
  explicit ByteFile(const std::filesystem::path& file);
  /// A new file without a name, which is removed with this object, also after a crash.
  [[nodiscard]] static std::shared_ptr<ByteFile> scratch(const std::filesystem::path& folder);
  ~ByteFile();
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;

  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Parts that were never written are read as zeros.
  void resize(std::uint64_t size);
  [[nodiscard]] std::uint64_t size() const;
  /// Its name; a scratch file's folder.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  ByteFile(int descriptor, std::filesystem::path path);

  int descriptor_;
  std::filesystem::path path_;
};

/// A volume that lies on disk, whose parts are read and written. Copies are the same volume.
template <class Value>
class DiskVolume {
 public:
  DiskVolume() = default;
  /// All zeros, in a scratch file.
  DiskVolume(const VoxelDims& dims, double voxel, const std::filesystem::path& folder)
      : DiskVolume{ByteFile::scratch(folder), 0, dims, voxel} {
    file_->resize(Box{dims}.voxels() * sizeof(Value));
  }
  /// The content of a file from `offset` on.
  DiskVolume(std::shared_ptr<ByteFile> file, std::uint64_t offset, const VoxelDims& dims,
             double voxel)
      : file_{std::move(file)}, offset_{offset}, dims_{dims}, voxel_{voxel} {}

  [[nodiscard]] bool empty() const { return file_ == nullptr; }
  [[nodiscard]] const VoxelDims& dims() const { return dims_; }
  [[nodiscard]] double voxel() const { return voxel_; }
  [[nodiscard]] Box box() const { return Box{dims_}; }

  /// The voxels of a box, which lies in the volume.
  [[nodiscard]] Volume<Value> read(const Box& part) const {
    Volume<Value> volume{part, voxel_};
    for_each_run(part, volume, [&](std::uint64_t place, std::span<Value> values) {
      file_->read(place, std::as_writable_bytes(values));
    });
    return volume;
  }
  /// Stores the voxels of a box from a volume that holds them.
  void write(const Volume<Value>& from, const Box& part) {
    for_each_run(part, from, [&](std::uint64_t place, std::span<const Value> values) {
      file_->write(place, std::as_bytes(values));
    });
  }

 private:
  /// Calls move(place in the file, values in memory) for each run of voxels that is contiguous in
  /// both: whole layers where possible, otherwise lines.
  template <class Held, class Move>
  void for_each_run(const Box& part, Held& held, Move&& move) const {
    const Volume<char> whole{Box{{0, 0, 0}, {dims_[0], dims_[1], 0}}, voxel_};
    const auto line = static_cast<std::size_t>(part.dims[0]);
    const bool layers = part.dims[0] == dims_[0] && part.dims[1] == dims_[1] &&
                        held.dims[0] == dims_[0] && held.dims[1] == dims_[1];
    const std::size_t run = layers ? line * static_cast<std::size_t>(part.dims[1]) : line;
    for (std::int32_t k = part.low[2]; k < part.end(2); ++k) {
      for (std::int32_t j = part.low[1]; j < (layers ? part.low[1] + 1 : part.end(1)); ++j) {
        const std::size_t place = whole.index(part.low[0], j, k);
        move(offset_ + place * sizeof(Value),
             std::span{held.values}.subspan(held.index(part.low[0], j, k), run));
      }
    }
  }

  std::shared_ptr<ByteFile> file_;
  std::uint64_t offset_{0};
  VoxelDims dims_{0, 0, 0};
  double voxel_{0};
};

using GrayOnDisk = DiskVolume<float>;
using MaskOnDisk = DiskVolume<std::uint8_t>;
using LabelsOnDisk = DiskVolume<std::uint32_t>;

/// A volume in memory, put on disk.
template <class Value>
[[nodiscard]] DiskVolume<Value> on_disk(const Volume<Value>& volume,
                                        const std::filesystem::path& folder) {
  DiskVolume<Value> stored{volume.dims, volume.voxel, folder};
  stored.write(volume, volume.box());
  return stored;
}

}  // namespace reckon
