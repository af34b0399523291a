// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "reckon/avatar/text_reader.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

struct NamedType {
  std::string_view name;
  VoxelType type;
};
constexpr std::array meta_types{
    NamedType{"MET_UCHAR", VoxelType::uint8},   NamedType{"MET_CHAR", VoxelType::int8},
    NamedType{"MET_USHORT", VoxelType::uint16}, NamedType{"MET_SHORT", VoxelType::int16},
    NamedType{"MET_UINT", VoxelType::uint32},   NamedType{"MET_INT", VoxelType::int32},
    NamedType{"MET_FLOAT", VoxelType::float32}, NamedType{"MET_DOUBLE", VoxelType::float64}};
constexpr std::array nrrd_types{NamedType{"uchar", VoxelType::uint8},
                                NamedType{"unsigned char", VoxelType::uint8},
                                NamedType{"uint8", VoxelType::uint8},
                                NamedType{"uint8_t", VoxelType::uint8},
                                NamedType{"signed char", VoxelType::int8},
                                NamedType{"int8", VoxelType::int8},
                                NamedType{"int8_t", VoxelType::int8},
                                NamedType{"ushort", VoxelType::uint16},
                                NamedType{"unsigned short", VoxelType::uint16},
                                NamedType{"unsigned short int", VoxelType::uint16},
                                NamedType{"uint16", VoxelType::uint16},
                                NamedType{"uint16_t", VoxelType::uint16},
                                NamedType{"short", VoxelType::int16},
                                NamedType{"short int", VoxelType::int16},
                                NamedType{"signed short", VoxelType::int16},
                                NamedType{"signed short int", VoxelType::int16},
                                NamedType{"int16", VoxelType::int16},
                                NamedType{"int16_t", VoxelType::int16},
                                NamedType{"uint", VoxelType::uint32},
                                NamedType{"unsigned int", VoxelType::uint32},
                                NamedType{"uint32", VoxelType::uint32},
                                NamedType{"uint32_t", VoxelType::uint32},
                                NamedType{"int", VoxelType::int32},
                                NamedType{"signed int", VoxelType::int32},
                                NamedType{"int32", VoxelType::int32},
                                NamedType{"int32_t", VoxelType::int32},
                                NamedType{"float", VoxelType::float32},
                                NamedType{"double", VoxelType::float64}};
// What neither says where the numbers lie nor what they are.
constexpr std::array meta_ignored{
    "ObjectType",        "BinaryData", "Offset",           "Position",
    "TransformMatrix",   "Comment",    "CenterOfRotation", "AnatomicalOrientation",
    "CompressedDataSize"};
constexpr std::array nrrd_ignored{"space",       "kinds",     "space origin", "space units",
                                  "centers",     "content",   "labels",       "units",
                                  "thicknesses", "axis mins", "axis maxs",    "space dimension"};

template <class Types>
VoxelType type_named(const Types& types, std::string_view name, const std::string& place) {
  const auto found = std::find_if(types.begin(), types.end(),
                                  [&](const NamedType& type) { return type.name == name; });
  if (found == types.end()) {
    refuse_volume(place, "the type of the numbers is not known", in_quotes(name),
                  "Save it as integers of at most 32 bits or as floats.");
  }
  return found->type;
}

template <class Types>
std::string_view name_among(const Types& types, VoxelType type) {
  return std::find_if(types.begin(), types.end(),
                      [&](const NamedType& known) { return known.type == type; })
      ->name;
}

template <class Names>
bool is_among(const Names& names, std::string_view name) {
  return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Three numbers; brackets and commas, as in NRRD's vectors, count as blanks.
std::vector<double> numbers_in(std::string_view text, const std::string& place) {
  std::string plain{text};
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  TextReader reader{plain, place};
  std::vector<double> numbers;
  reader.next_line();
  for (auto token = reader.next_token(); !token.empty(); token = reader.next_token()) {
    numbers.push_back(reader.to_double(token, "number of the header"));
  }
  return numbers;
}

void set_dims(VolumeHeader& header, std::string_view text, const std::string& place) {
  const auto numbers = numbers_in(text, place);
  if (numbers.size() != 3) {
    refuse_volume(place, "this is no volume", fmt::format("it has {} dimensions", numbers.size()),
                  "Give a volume of three dimensions.");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(numbers[axis] >= 1 && numbers[axis] <= 2147483647.0)) {
      refuse_volume(place, "the volume's dimensions are out of range",
                    fmt::format("{}", numbers[axis]), "Each is at least 1.");
    }
    header.dims[axis] = static_cast<std::int64_t>(numbers[axis]);
  }
}

/// One length per axis, or one vector per axis.
void set_spacing(VolumeHeader& header, std::string_view text, const std::string& place) {
  const auto numbers = numbers_in(text, place);
  std::array<double, 3> edges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (numbers.size() == 3) {
      edges[axis] = std::abs(numbers[axis]);
    } else if (numbers.size() == 9) {
      edges[axis] = std::hypot(numbers[3 * axis], numbers[3 * axis + 1], numbers[3 * axis + 2]);
    } else {
      refuse_volume(place, "the voxel's edges are not understood", in_quotes(text),
                    "Save it anew.");
    }
  }
  if (!(std::abs(edges[1] / edges[0] - 1) < 1e-3 && std::abs(edges[2] / edges[0] - 1) < 1e-3)) {
    refuse_volume(place, "the voxels are not cubes",
                  fmt::format("their edges are {}, {} and {}", edges[0], edges[1], edges[2]),
                  "Resample the volume to cubic voxels.");
  }
  header.spacing = edges[0];
}

void require_complete(const VolumeHeader& header, bool has_type, const std::string& place) {
  if (has_type && header.dims[0] > 0) return;
  refuse_volume(place, "the header is not whole", "type or dimensions are missing",
                "Copy it again.");
}

/// Calls take(line) for each line up to and including the one for which it returns true; returns
/// where the next begins.
template <class Take>
std::size_t for_each_line(std::string_view bytes, const std::string& place, Take&& take) {
  constexpr std::size_t longest_line = 1000;
  for (std::size_t begin = 0; begin < std::min(bytes.size(), longest_header);) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string_view::npos || end - begin > longest_line) break;
    if (take(trimmed(bytes.substr(begin, end - begin)))) return end + 1;
    begin = end + 1;
  }
  refuse_volume(place, "the header is not whole", "it does not end", "Copy the file again.");
}

}  // namespace

VolumeHeader parse_metaimage_header(std::string_view bytes, const std::string& place) {
  VolumeHeader header;
  bool has_type = false;
  header.data_start = for_each_line(bytes, place, [&](std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      refuse_volume(place, "the header is damaged", "a line has no =", "Copy the file again.");
    }
    const std::string_view key = trimmed(line.substr(0, equals));
    const std::string_view value = trimmed(line.substr(equals + 1));
    if (key == "DimSize") {
      set_dims(header, value, place);
    } else if (key == "ElementType") {
      header.type = type_named(meta_types, value, place);
      has_type = true;
    } else if (key == "ElementSpacing" || key == "ElementSize") {
      set_spacing(header, value, place);
    } else if (key == "ElementByteOrderMSB" || key == "BinaryDataByteOrderMSB") {
      header.big_endian = lower_case(value) == "true";
    } else if (key == "CompressedData") {
      header.compressed = lower_case(value) == "true";
    } else if (key == "NDims" || key == "ElementNumberOfChannels") {
      if (value != (key == "NDims" ? "3" : "1")) {
        refuse_volume(place, "this is no volume of one number a voxel",
                      fmt::format("{} is {}", key, value),
                      "Save three dimensions in shades of gray.");
      }
    } else if (key == "ElementDataFile") {
      if (lower_case(value) != "local") header.data_file = value;
      return true;
    } else if (!is_among(meta_ignored, key)) {
      refuse_volume(place, "a line of the header is not understood", in_quotes(key),
                    "Save the volume as plain MetaImage.");
    }
    return false;
  });
  require_complete(header, has_type, place);
  return header;
}

VolumeHeader parse_nrrd_header(std::string_view bytes, const std::string& place) {
  if (!bytes.starts_with("NRRD000")) {
    refuse_volume(place, "this is no NRRD file", "it does not begin with NRRD000",
                  "Check its name.");
  }
  VolumeHeader header;
  bool has_type = false;
  bool first = true;
  header.data_start = for_each_line(bytes, place, [&](std::string_view line) {
    if (line.empty()) return true;
    if (std::exchange(first, false) || line.starts_with('#')) return false;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      refuse_volume(place, "the header is damaged", "a line has no colon", "Copy the file again.");
    }
    if (line.substr(colon).starts_with(":=")) return false;  // a note
    const std::string_view key = trimmed(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (key == "sizes") {
      set_dims(header, value, place);
    } else if (key == "type") {
      header.type = type_named(nrrd_types, value, place);
      has_type = true;
    } else if (key == "spacings" || key == "space directions") {
      set_spacing(header, value, place);
    } else if (key == "endian") {
      header.big_endian = value == "big";
    } else if (key == "encoding") {
      header.compressed = value == "gzip" || value == "gz";
      if (!header.compressed && value != "raw") {
        refuse_volume(place, "the encoding is not read", in_quotes(value),
                      "Save it as raw or gzip.");
      }
    } else if (key == "dimension") {
      if (value != "3") {
        refuse_volume(place, "this is no volume", fmt::format("it has {} dimensions", value),
                      "Give a volume of three dimensions.");
      }
    } else if (key == "data file" || key == "datafile") {
      header.data_file = value;
    } else if (!is_among(nrrd_ignored, key)) {
      refuse_volume(place, "a line of the header is not understood", in_quotes(key),
                    "Save the volume as plain NRRD.");
    }
    return false;
  });
  require_complete(header, has_type, place);
  return header;
}

std::string metaimage_header(const VolumeOutline& what) {
  const auto& [nx, ny, nz] = what.dims;
  return fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = False\nElementSpacing = {0} {0} {0}\nDimSize = {1} {2} {3}\n"
      "ElementType = {4}\nElementDataFile = LOCAL\n",
      1e3 * what.spacing.value(), nx, ny, nz, name_among(meta_types, what.type));
}

std::string nrrd_header(const VolumeOutline& what) {
  const auto& [nx, ny, nz] = what.dims;
  return fmt::format(
      "NRRD0004\ntype: {4}\ndimension: 3\nsizes: {1} {2} {3}\nspacings: {0} {0} {0}\n"
      "endian: little\nencoding: raw\n\n",
      1e3 * what.spacing.value(), nx, ny, nz, name_among(nrrd_types, what.type));
}

}  // namespace reckon
