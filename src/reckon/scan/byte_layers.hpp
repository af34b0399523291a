// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "reckon/scan/volume_formats.hpp"

namespace reckon {

/// A volume whose layers are bytes, from any source.
class ByteLayers : public VolumeReader {
 public:
  [[nodiscard]] GrayVolume read_layers(std::int32_t first, std::int32_t count) final;

 protected:
  /// `big_endian`: the order of the bytes that read_layer() brings.
  ByteLayers(const VolumeOutline& what, bool big_endian) : big_endian_{big_endian} {
    outline = what;
  }
  [[nodiscard]] std::size_t bytes_per_layer() const {
    return Box{{outline.dims[0], outline.dims[1], 1}}.voxels() * size_of(outline.type);
  }

 private:
  /// Fills `bytes` with the numbers of layer `k`.
  virtual void read_layer(std::int32_t k, std::span<std::byte> bytes) = 0;

  bool big_endian_;
};

}  // namespace reckon
