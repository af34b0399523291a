// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "reckon/scan/header_text.hpp"

namespace reckon {
namespace {

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
// Fields that give neither the place, nor the type, nor the axes of the numbers.
constexpr std::array nrrd_ignored{
    "space",        "kinds",       "space origin", "centers",     "centerings",
    "content",      "labels",      "number",       "thicknesses", "measurement frame",
    "sample units", "sampleunits", "min",          "max",         "old min",
    "oldmin",       "old max",     "oldmax",       "dimension",   "axismins",
    "axismaxs"};

/// One vector per axis, or "none".
std::vector<std::vector<double>> vectors_in(std::string_view text, const std::string& place) {
  std::vector<std::vector<double>> vectors;
  while (!(text = trimmed(text)).empty()) {
    if (text.starts_with("none")) {
      vectors.emplace_back();
      text.remove_prefix(4);
      continue;
    }
    const std::size_t close = text.find(')');
    if (!text.starts_with('(') || close == std::string_view::npos) {
      refuse_volume(place, "space directions are not understood", in_quotes(text),
                    "Write a vector in brackets for each axis.");
    }
    vectors.push_back(numbers_in(text.substr(0, close), place));
    text.remove_prefix(close + 1);
  }
  return vectors;
}

/// The first length among units in quotation marks, one per axis.
std::optional<double> unit_among(std::string_view text) {
  while (!text.empty()) {
    const std::size_t open = text.find('"');
    if (open == std::string_view::npos) return std::nullopt;
    const std::size_t close = text.find('"', open + 1);
    if (close == std::string_view::npos) return std::nullopt;
    if (const auto unit = file_unit(text.substr(open + 1, close - open - 1))) return unit;
    text.remove_prefix(close + 1);
  }
  return std::nullopt;
}

/// "LIST", a pattern with its range, or a name. A list begins behind the line, at `next`.
void set_data_files(VolumeHeader& header, std::string_view value, std::string_view bytes,
                    std::size_t next, const std::string& place) {
  const std::vector<std::string> words = words_in(value);
  const auto require_slices = [&](std::size_t word) {
    if (words.size() <= word || words[word] == "2") return;
    refuse_volume(place, "data file lists files of another kind than slices", in_quotes(value),
                  "Give files of one slice each.");
  };
  if (!words.empty() && words.front() == "LIST") {
    require_slices(1);
    header.data_files = listed_files(bytes, next, place);
  } else if (words.size() >= 4 && words.front().find('%') != std::string::npos) {
    require_slices(4);
    auto range = numbers_in(value.substr(words.front().size()), place);
    range.resize(3);
    header.data_files = files_of_pattern(words.front(), range, place);
  } else {
    header.data_files = {std::string{value}};
  }
}

/// Fields that give the place of the numbers in their file.
bool set_place(VolumeHeader& header, std::string_view key, std::string_view value,
               const std::string& place) {
  if (key == "line skip" || key == "lineskip") {
    const std::int64_t lines = integer_in(value, key, place);
    header.skip_lines = lines > 0 ? static_cast<std::uint64_t>(lines) : 0;
    return true;
  }
  if (key != "byte skip" && key != "byteskip") return false;
  const std::int64_t bytes = integer_in(value, key, place);
  if (bytes < -1) {
    refuse_volume(place, "byte skip is out of range", fmt::format("{}", bytes),
                  "It is a count of bytes, or -1.");
  }
  header.at_end = bytes == -1;
  header.skip_bytes = bytes > 0 ? static_cast<std::uint64_t>(bytes) : 0;
  return true;
}

bool set_encoding(VolumeHeader& header, std::string_view value, const std::string& place) {
  header.compressed = value == "gzip" || value == "gz";
  if (!header.compressed && value != "raw") {
    refuse_volume(place, "the encoding is not read", in_quotes(value), "Save it as raw or gzip.");
  }
  return true;
}

}  // namespace

VolumeHeader parse_nrrd_header(std::string_view bytes, const std::string& place) {
  if (!bytes.starts_with("NRRD000")) {
    refuse_volume(place, "this is no NRRD file", "it does not begin with NRRD000",
                  "Check its name.");
  }
  VolumeHeader header;
  HeaderAxes axes;
  axes.directions_field = "space directions";
  std::string data_file;
  std::vector<double> lows;
  std::vector<double> highs;
  bool has_type = false;
  bool first = true;
  const auto take = [&](std::string_view line) {
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
      axes.lengths = numbers_in(value, place);
    } else if (key == "type") {
      header.type = type_named(nrrd_types, value, place);
      has_type = true;
    } else if (key == "spacings") {
      axes.edges = numbers_in(value, place);
      axes.edges_field = key;
    } else if (key == "space directions") {
      axes.directions = vectors_in(value, place);
    } else if (key == "space units" || key == "units") {
      header.spacing.unit = unit_among(value);
    } else if (key == "axis mins") {
      lows = numbers_in(value, place);
    } else if (key == "axis maxs") {
      highs = numbers_in(value, place);
    } else if (key == "endian") {
      header.big_endian = value == "big";
    } else if (key == "encoding") {
      return !set_encoding(header, value, place);
    } else if (key == "data file" || key == "datafile") {
      data_file = value;
      return value.starts_with("LIST");  // which ends the header
    } else if (key == "space dimension") {
      if (value != "3") {
        refuse_volume(place, "space dimension is not 3", in_quotes(value), "Save it anew.");
      }
    } else if (!set_place(header, key, value, place) && !is_among(nrrd_ignored, key)) {
      refuse_volume(place, "a line of the header is not understood", in_quotes(key),
                    "Save the volume as plain NRRD.");
    }
    return false;
  };
  // A header beside its data may end with its file.
  const std::string whole = fmt::format("{}\n\n", bytes);
  const std::size_t end = for_each_line(whole, place, take);
  if (!data_file.empty()) set_data_files(header, data_file, bytes, end, place);
  header.data_start = header.data_files.empty() ? end : 0;
  if (header.compressed && header.skip_bytes > 0) {
    refuse_volume(place, "byte skip counts unpacked bytes here, which is not read",
                  "the numbers are compressed", "Save the volume without other data before it.");
  }
  if (axes.edges.empty() && axes.directions.empty() && !highs.empty() &&
      lows.size() == highs.size() && lows.size() == axes.lengths.size()) {
    axes.edges_field = "axis maxs";
    for (std::size_t axis = 0; axis < lows.size(); ++axis) {
      axes.edges.push_back((highs[axis] - lows[axis]) / axes.lengths[axis]);
    }
  }
  require_complete(header, has_type, axes, place);
  set_axes(header, axes, place);
  return header;
}

std::string nrrd_header(const VolumeOutline& what) {
  const auto& [nx, ny, nz] = what.dims;
  return fmt::format(
      "NRRD0004\ntype: {4}\ndimension: 3\nsizes: {1} {2} {3}\nspacings: {0} {0} {0}\n"
      "endian: little\nencoding: raw\n\n",
      1e3 * what.spacing.edge.value(), nx, ny, nz, name_among(nrrd_types, what.type));
}

}  // namespace reckon
