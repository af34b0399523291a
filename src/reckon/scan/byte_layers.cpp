// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/byte_layers.hpp"

#include <algorithm>
#include <string>

namespace reckon {

GrayVolume ByteLayers::read_layers(std::int32_t first, std::int32_t count) {
  GrayVolume layers{Box{{0, 0, first}, {outline.dims[0], outline.dims[1], count}}, 0};
  std::string bytes(bytes_per_layer(), '\0');
  for (std::int32_t k = first; k < first + count; ++k) {
    read_layer(k, std::as_writable_bytes(std::span{bytes}));
    const auto values = decode_numbers(bytes, outline.type, big_endian_);
    std::copy(values.begin(), values.end(),
              layers.values.begin() + static_cast<std::ptrdiff_t>(layers.index(0, 0, k)));
  }
  return layers;
}

}  // namespace reckon
