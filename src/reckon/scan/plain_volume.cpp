// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
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

}  // namespace

std::unique_ptr<VolumeReader> open_plain_volume(std::shared_ptr<const ByteFile> file,
                                                const VolumeHeader& header) {
  const std::uint64_t size = file->size();
  check_length(header, size - std::min(size, header.data_start), file->path().string());
  return std::make_unique<PlainVolume>(std::move(file), header);
}

}  // namespace reckon
