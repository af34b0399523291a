// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/scan/volume_formats.hpp"
#include "reckon/text/text_reader.hpp"

/// Common parts of the readers of the text headers of MetaImage and NRRD.
namespace reckon {

struct NamedType {
  std::string_view name;
  VoxelType type;
};

/// The type of a name in a table of NamedType. Throws Error when it is not there.
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

[[nodiscard]] std::string_view trimmed(std::string_view text);
/// The words of a line.
[[nodiscard]] std::vector<std::string> words_in(std::string_view text);
/// Numbers; brackets and commas, as in NRRD's vectors, count as blanks.
[[nodiscard]] std::vector<double> numbers_in(std::string_view text, const std::string& place);
[[nodiscard]] std::int64_t integer_in(std::string_view text, std::string_view key,
                                      const std::string& place);

/// The axes in a header, in the order of the file. Parts that it leaves out are empty.
struct HeaderAxes {
  std::vector<double> lengths;                  ///< in voxels
  std::vector<double> edges;                    ///< of a voxel; NaN: not known
  std::vector<std::vector<double>> directions;  ///< of an axis in space; an empty one: of none
  std::string edges_field;                      ///< names of the fields, for messages
  std::string directions_field;
};
/// Sets dimensions, spacing and mirrored axes. Throws Error, naming the field, when there are not
/// three axes that count, when voxels are no cubes, or when an axis is turned out of its direction.
void set_axes(VolumeHeader& header, const HeaderAxes& axes, const std::string& place);

/// The files of a pattern such as "slice%03d.raw" with the first number, the last and the step.
[[nodiscard]] std::vector<std::string> files_of_pattern(std::string_view pattern,
                                                        const std::vector<double>& range,
                                                        const std::string& place);

/// Throws Error unless a header gave its type and its dimensions.
void require_complete(const VolumeHeader& header, bool has_type, const HeaderAxes& axes,
                      const std::string& place);

/// Calls take(line) for each line up to and including the one for which it returns true; returns
/// where the next begins.
template <class Take>
std::size_t for_each_line(std::string_view bytes, const std::string& place, Take&& take) {
  constexpr std::size_t longest_line = 1000;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string_view::npos || end - begin > longest_line) break;
    if (take(trimmed(bytes.substr(begin, end - begin)))) return end + 1;
    begin = end + 1;
  }
  refuse_volume(place, "the header is not whole", "it does not end", "Copy the file again.");
}

/// The names of files in the lines from `start` to the end.
[[nodiscard]] std::vector<std::string> listed_files(std::string_view bytes, std::size_t start,
                                                    const std::string& place);

}  // namespace reckon
