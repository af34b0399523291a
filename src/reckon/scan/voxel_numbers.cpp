// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "reckon/scan/volume_formats.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

static_assert(std::endian::native == std::endian::little, "volumes are written as they lie");

struct TypeName {
  VoxelType type;
  std::string_view name;
  std::string_view numpy;  // without the byte order
  std::size_t size;
};
constexpr std::array types{TypeName{VoxelType::uint8, "uint8", "u1", 1},
                           TypeName{VoxelType::int8, "int8", "i1", 1},
                           TypeName{VoxelType::uint16, "uint16", "u2", 2},
                           TypeName{VoxelType::int16, "int16", "i2", 2},
                           TypeName{VoxelType::uint32, "uint32", "u4", 4},
                           TypeName{VoxelType::int32, "int32", "i4", 4},
                           TypeName{VoxelType::float32, "float32", "f4", 4},
                           TypeName{VoxelType::float64, "float64", "f8", 8}};

const TypeName& entry_of(VoxelType type) {
  return *std::find_if(types.begin(), types.end(),
                       [&](const TypeName& entry) { return entry.type == type; });
}

/// Calls action(Number{}) with the C++ type for `type`.
template <class Action>
void with_number(VoxelType type, Action&& action) {
  switch (type) {
    case VoxelType::uint8:
      return action(std::uint8_t{});
    case VoxelType::int8:
      return action(std::int8_t{});
    case VoxelType::uint16:
      return action(std::uint16_t{});
    case VoxelType::int16:
      return action(std::int16_t{});
    case VoxelType::uint32:
      return action(std::uint32_t{});
    case VoxelType::int32:
      return action(std::int32_t{});
    case VoxelType::float32:
      return action(float{});
    case VoxelType::float64:
      return action(double{});
  }
}

}  // namespace

std::string_view name_of(VoxelType type) { return entry_of(type).name; }
std::size_t size_of(VoxelType type) { return entry_of(type).size; }
std::string numpy_name_of(VoxelType type) {
  return fmt::format("{}{}", size_of(type) == 1 ? '|' : '<', entry_of(type).numpy);
}

std::optional<VoxelType> voxel_type_named(std::string_view name) {
  const auto* const found = std::find_if(types.begin(), types.end(), [&](const TypeName& entry) {
    return entry.name == name || entry.numpy == name;
  });
  if (found == types.end()) return std::nullopt;
  return found->type;
}

void check_dims(const std::array<std::int64_t, 3>& dims, std::uint64_t most,
                const std::string& place) {
  std::uint64_t count = 1;
  for (const std::int64_t dim : dims) {
    if (dim < 1 || dim > std::numeric_limits<std::int32_t>::max()) {
      refuse_volume(place, "the volume's dimensions are out of range",
                    fmt::format("{} was found", dim), "Each is at least 1.");
    }
    if (static_cast<std::uint64_t>(dim) > most / count) {
      refuse_volume(place, "the volume is cut short",
                    fmt::format("{} x {} x {} voxels are announced, {} are there at most", dims[0],
                                dims[1], dims[2], most),
                    "Copy it again, or correct its header.");
    }
    count *= static_cast<std::uint64_t>(dim);
  }
}

std::vector<float> decode_numbers(std::string_view bytes, VoxelType type, bool swap) {
  std::vector<float> values(bytes.size() / size_of(type));
  with_number(type, [&](auto number) {
    std::array<char, sizeof number> one{};
    for (std::size_t v = 0; v < values.size(); ++v) {
      std::memcpy(one.data(), bytes.data() + v * sizeof number, sizeof number);
      if (swap) std::reverse(one.begin(), one.end());
      std::memcpy(&number, one.data(), sizeof number);
      if constexpr (std::is_same_v<decltype(number), double>) {
        // A double beyond the range of floats is as bad as one that is not finite.
        const bool fits = std::abs(number) <= std::numeric_limits<float>::max();
        values[v] = fits ? static_cast<float>(number) : std::numeric_limits<float>::infinity();
      } else {
        values[v] = static_cast<float>(number);
      }
    }
  });
  return values;
}

std::string encode_numbers(const std::vector<float>& values, VoxelType type) {
  std::string bytes(values.size() * size_of(type), '\0');
  with_number(type, [&](auto number) {
    using Number = decltype(number);
    for (std::size_t v = 0; v < values.size(); ++v) {
      if constexpr (std::is_floating_point_v<Number>) {
        number = values[v];
      } else {
        // Clamped as doubles, which hold the ends of all these types.
        const double low = std::numeric_limits<Number>::min();
        const double high = std::numeric_limits<Number>::max();
        number = static_cast<Number>(
            std::clamp(std::floor(static_cast<double>(values[v]) + 0.5), low, high));
      }
      std::memcpy(bytes.data() + v * sizeof number, &number, sizeof number);
    }
  });
  return bytes;
}

}  // namespace reckon
