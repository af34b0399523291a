// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>

#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

class PlainReader : public VolumeReader {
 public:
  PlainReader(const std::filesystem::path& file, const VolumeHeader& header,
              std::vector<std::uint64_t> layer_starts)
      : file_{file}, big_endian_{header.big_endian}, starts_{std::move(layer_starts)} {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      outline.dims[axis] = static_cast<std::int32_t>(header.dims[axis]);
    }
    outline.type = header.type;
    outline.spacing = header.spacing;
  }

  GrayVolume read_layers(std::int32_t first, std::int32_t count) override {
    GrayVolume layers{Box{{0, 0, first}, {outline.dims[0], outline.dims[1], count}}, 0};
    const std::size_t pixels = layers.index(0, 0, first + 1);
    std::string bytes(pixels * size_of(outline.type), '\0');
    for (std::int32_t k = first; k < first + count; ++k) {
      file_.read(starts_[static_cast<std::size_t>(k)], std::as_writable_bytes(std::span{bytes}));
      const auto values = decode_numbers(bytes, outline.type, big_endian_);
      std::copy(values.begin(), values.end(),
                layers.values.begin() + static_cast<std::ptrdiff_t>(layers.index(0, 0, k)));
    }
    return layers;
  }

 private:
  ByteFile file_;
  bool big_endian_;
  std::vector<std::uint64_t> starts_;
};

}  // namespace

std::unique_ptr<VolumeReader> open_plain_volume(const std::filesystem::path& file,
                                                const VolumeHeader& header,
                                                std::vector<std::uint64_t> layer_starts) {
  return std::make_unique<PlainReader>(file, header, std::move(layer_starts));
}

std::unique_ptr<VolumeReader> open_plain_volume(const std::filesystem::path& file,
                                                const VolumeHeader& header) {
  const std::uint64_t size = ByteFile{file}.size();
  check_length(header, size - std::min(size, header.data_start), file.string());
  const std::uint64_t layer =
      static_cast<std::uint64_t>(header.dims[0] * header.dims[1]) * size_of(header.type);
  std::vector<std::uint64_t> starts(static_cast<std::size_t>(header.dims[2]));
  for (std::size_t k = 0; k < starts.size(); ++k) starts[k] = header.data_start + k * layer;
  return open_plain_volume(file, header, std::move(starts));
}

}  // namespace reckon
