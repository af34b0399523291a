// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "reckon/scan/byte_layers.hpp"

namespace reckon {
namespace {

class PlainVolume : public ByteLayers {
 public:
  PlainVolume(std::shared_ptr<const ByteFile> file, const VolumeHeader& header)
      : ByteLayers{outline_of(header), header.big_endian},
        file_{std::move(file)},
        start_{header.data_start} {}

 private:
  void read_layer(std::int32_t k, std::span<std::byte> bytes) override {
    file_->read(start_ + static_cast<std::uint64_t>(k) * bytes.size(), bytes);
  }

  std::shared_ptr<const ByteFile> file_;
  std::uint64_t start_;
};

/// Bytes that a volume's numbers take.
std::uint64_t bytes_of(const VolumeHeader& header) {
  return Box{outline_of(header).dims}.voxels() * size_of(header.type);
}

/// Throws Error unless a file holds the numbers of a header, from the place that it gives on.
/// Returns that place.
std::uint64_t place_in(const VolumeHeader& header, std::uint64_t size, const std::string& name) {
  const std::uint64_t behind = size - std::min(size, header.data_start);
  if (!header.at_end && !header.may_go_on) {
    check_length(header, behind, name);
    return header.data_start;
  }
  check_dims(header.dims, behind / size_of(header.type), name);
  return header.at_end ? size - bytes_of(header) : header.data_start;
}

/// Layers that lie in several files, with the same count of them in each.
class PlainFiles : public ByteLayers {
 public:
  PlainFiles(std::vector<std::filesystem::path> files, const VolumeHeader& header)
      : ByteLayers{outline_of(header), header.big_endian},
        files_{std::move(files)},
        layers_{outline.dims[2] / static_cast<std::int32_t>(files_.size())} {
    VolumeHeader one = header;
    one.dims[2] = layers_;
    starts_.reserve(files_.size());
    for (const auto& file : files_) {
      starts_.push_back(place_in(one, ByteFile{file}.size(), file.string()));
    }
  }

 private:
  void read_layer(std::int32_t k, std::span<std::byte> bytes) override {
    const auto file = static_cast<std::size_t>(k / layers_);
    ByteFile{files_[file]}.read(
        starts_[file] + static_cast<std::uint64_t>(k % layers_) * bytes.size(), bytes);
  }

  std::vector<std::filesystem::path> files_;
  std::int32_t layers_;  // in each
  std::vector<std::uint64_t> starts_;
};

/// A volume whose axes run the other way.
class MirroredVolume : public VolumeReader {
 public:
  MirroredVolume(std::unique_ptr<VolumeReader> reader, const std::array<bool, 3>& axes)
      : reader_{std::move(reader)}, axes_{axes} {
    outline = reader_->outline;
  }

  GrayVolume read_layers(std::int32_t first, std::int32_t count) override {
    const std::int32_t from = axes_[2] ? outline.dims[2] - first - count : first;
    const GrayVolume stored = reader_->read_layers(from, count);
    GrayVolume layers{Box{{0, 0, first}, {outline.dims[0], outline.dims[1], count}}, stored.voxel};
    const auto turned = [&](std::size_t axis, std::int32_t place) {
      return axes_[axis] ? outline.dims[axis] - 1 - place : place;
    };
    std::size_t v = 0;
    for_each_voxel(layers.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      layers.values[v++] = stored.values[stored.index(turned(0, i), turned(1, j), turned(2, k))];
    });
    return layers;
  }

 private:
  std::unique_ptr<VolumeReader> reader_;
  std::array<bool, 3> axes_;
};

}  // namespace

std::unique_ptr<VolumeReader> open_plain_volume(std::shared_ptr<const ByteFile> file,
                                                const VolumeHeader& header) {
  VolumeHeader placed = header;
  placed.data_start = place_in(header, file->size(), file->path().string());
  return std::make_unique<PlainVolume>(std::move(file), placed);
}

std::unique_ptr<VolumeReader> open_plain_files(std::vector<std::filesystem::path> files,
                                               const VolumeHeader& header) {
  const auto count = static_cast<std::int64_t>(files.size());
  if (header.dims[2] % count != 0 || header.skip_lines > 0) {
    refuse_volume(files.front().parent_path(), "the data files do not fit the volume",
                  header.skip_lines > 0 ? std::string{"lines are skipped in each of them"}
                                        : std::to_string(count) + " files for " +
                                              std::to_string(header.dims[2]) + " layers",
                  "List one file for each layer, of numbers alone.");
  }
  return std::make_unique<PlainFiles>(std::move(files), header);
}

std::unique_ptr<VolumeReader> mirrored(std::unique_ptr<VolumeReader> reader,
                                       const std::array<bool, 3>& axes) {
  if (axes == std::array<bool, 3>{}) return reader;
  reader->outline.remarks.emplace_back(
      "the header runs axes backwards, so the volume is mirrored along them");
  return std::make_unique<MirroredVolume>(std::move(reader), axes);
}

}  // namespace reckon
