// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/header_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace reckon {
namespace {

constexpr std::size_t most_files = 1000000;
constexpr double same_edge = 1e-3;       // relative
constexpr double same_direction = 1e-4;  // 1 - cosine

/// Whether an axis lies along its own direction in space, and backwards.
bool runs_backwards(const std::vector<double>& direction, std::size_t axis, double length,
                    const std::string& field, const std::string& place) {
  const double along = axis < direction.size() ? direction[axis] / length : 0;
  if (std::abs(along) < 1 - same_direction) {
    refuse_volume(place, fmt::format("{} turns the axes of the volume", field),
                  fmt::format("axis {} of the numbers does not lie along axis {} of space",
                              axis + 1, axis + 1),
                  "Resample the volume along its own axes, or remove the field: then grains keep "
                  "the directions of the voxels.");
  }
  return along < 0;
}

double length_of(const std::vector<double>& vector) {
  double squares = 0;
  for (const double part : vector) squares += part * part;
  return std::sqrt(squares);
}

[[noreturn]] void refuse_count(const std::string& field, std::size_t found, std::size_t wanted,
                               const std::string& place) {
  refuse_volume(place, fmt::format("{} does not fit the volume", field),
                fmt::format("it holds {} entries for {} axes", found, wanted), "Save it anew.");
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> words_in(std::string_view text) {
  TextReader reader{text, {}};
  std::vector<std::string> words;
  reader.next_line();
  for (auto token = reader.next_token(); !token.empty(); token = reader.next_token()) {
    words.emplace_back(token);
  }
  return words;
}

std::vector<double> numbers_in(std::string_view text, const std::string& place) {
  std::string plain{text};
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  TextReader reader{plain, place};
  std::vector<double> numbers;
  reader.next_line();
  for (auto token = reader.next_token(); !token.empty(); token = reader.next_token()) {
    const bool unknown = lower_case(token) == "nan";
    numbers.push_back(unknown ? std::nan("") : reader.to_double(token, "number of the header"));
  }
  return numbers;
}

std::int64_t integer_in(std::string_view text, std::string_view key, const std::string& place) {
  TextReader reader{text, place};
  reader.next_line();
  return reader.next_integer(key);
}

void set_axes(VolumeHeader& header, const HeaderAxes& axes, const std::string& place) {
  std::vector<std::int64_t> lengths;
  for (const double length : axes.lengths) {
    if (!(length >= 1 && length <= 2147483647.0)) {
      refuse_volume(place, "the volume's dimensions are out of range", fmt::format("{}", length),
                    "Each is at least 1.");
    }
    lengths.push_back(static_cast<std::int64_t>(length));
  }
  const auto counted = axes_that_count(lengths, place);
  for (std::size_t axis = 0; axis < 3; ++axis) header.dims[axis] = lengths[counted[axis]];
  if (!axes.edges.empty()) {
    if (axes.edges.size() != lengths.size()) {
      refuse_count(axes.edges_field, axes.edges.size(), lengths.size(), place);
    }
    std::array<double, 3> edges{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      edges[axis] = std::abs(axes.edges[counted[axis]]);
      header.mirrored[axis] = axes.edges[counted[axis]] < 0;
    }
    set_spacing(header.spacing, edges, axes.edges_field, place);
  }
  if (axes.directions.empty()) return;
  if (axes.directions.size() != lengths.size()) {
    refuse_count(axes.directions_field, axes.directions.size(), lengths.size(), place);
  }
  std::array<double, 3> edges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double>& direction = axes.directions[counted[axis]];
    edges[axis] = length_of(direction);
    if (!(edges[axis] > 0) || !std::isfinite(edges[axis])) {
      refuse_volume(place, fmt::format("{} gives no direction for an axis", axes.directions_field),
                    fmt::format("axis {}", counted[axis] + 1), "Save the volume anew.");
    }
    header.mirrored[axis] =
        runs_backwards(direction, axis, edges[axis], axes.directions_field, place);
  }
  // MetaImage's matrix has unit vectors beside a spacing; NRRD's vectors hold both.
  if (axes.edges.empty()) set_spacing(header.spacing, edges, axes.directions_field, place);
}

void set_spacing(FileSpacing& spacing, const std::array<double, 3>& edges, std::string field,
                 const std::string& place) {
  if (std::isnan(edges[0]) && std::isnan(edges[1]) && std::isnan(edges[2])) return;
  const bool good = edges[0] > 0 && std::isfinite(edges[0]) &&
                    std::abs(edges[1] / edges[0] - 1) < same_edge &&
                    std::abs(edges[2] / edges[0] - 1) < same_edge;
  if (!good) {
    refuse_volume(
        place, "the voxels are not cubes",
        fmt::format("{} gives them edges of {}, {} and {}", field, edges[0], edges[1], edges[2]),
        "Resample the volume to cubic voxels.");
  }
  spacing.edge = edges[0];
  spacing.field = std::move(field);
}

std::vector<std::string> files_of_pattern(std::string_view pattern,
                                          const std::vector<double>& range,
                                          const std::string& place) {
  const auto fail = [&](const std::string& reason) {
    refuse_volume(place, "the names of the data files are not understood", reason,
                  "Write a pattern such as slice%03d.raw with the first number, the last and the "
                  "step, or list the files.");
  };
  const std::size_t percent = pattern.find('%');
  std::size_t end = percent == std::string_view::npos ? percent : percent + 1;
  std::size_t width = 0;
  const bool zeros = end < pattern.size() && pattern[end] == '0';
  while (end < pattern.size() && pattern[end] >= '0' && pattern[end] <= '9' && width < 100) {
    width = 10 * width + static_cast<std::size_t>(pattern[end++] - '0');
  }
  if (end >= pattern.size() || pattern[end] != 'd' || width > 20) fail(std::string{pattern});
  if (range.size() != 3 || !(range[2] >= 1) || !(range[1] >= range[0]) ||
      !(std::abs(range[0]) < 1e15) || !(std::abs(range[1]) < 1e15) ||
      !((range[1] - range[0]) / range[2] < static_cast<double>(most_files))) {
    fail("three whole numbers follow the pattern: the first, the last and the step above zero");
  }
  std::vector<std::string> files;
  const auto step = static_cast<std::int64_t>(range[2]);
  for (auto n = static_cast<std::int64_t>(range[0]); n <= static_cast<std::int64_t>(range[1]);
       n += step) {
    files.push_back(
        fmt::format("{}{}{}", pattern.substr(0, percent),
                    zeros ? fmt::format("{:0{}}", n, width) : fmt::format("{:{}}", n, width),
                    pattern.substr(end + 1)));
  }
  return files;
}

void require_complete(const VolumeHeader& header, bool has_type, const HeaderAxes& axes,
                      const std::string& place) {
  if (!has_type || axes.lengths.empty()) {
    refuse_volume(place, "the header is not whole", "type or dimensions are missing",
                  "Copy it again.");
  }
  if (header.compressed && (header.data_files.size() > 1 || header.at_end)) {
    refuse_volume(place, "compressed numbers are read from one file, from its beginning",
                  "the header names several files, or a beginning counted from the end",
                  "Save the volume in one file.");
  }
}

std::vector<std::string> listed_files(std::string_view bytes, std::size_t start,
                                      const std::string& place) {
  std::vector<std::string> files;
  while (start < bytes.size()) {
    const std::size_t end = std::min(bytes.find('\n', start), bytes.size());
    const std::string_view line = trimmed(bytes.substr(start, end - start));
    if (!line.empty() && !line.starts_with('#')) files.emplace_back(line);
    start = end + 1;
  }
  if (bytes.size() >= longest_header || files.empty()) {
    refuse_volume(place, "the list of data files is not whole",
                  files.empty() ? "it names none" : "the header is too long",
                  "List the files behind the header, a line each.");
  }
  return files;
}

}  // namespace reckon
