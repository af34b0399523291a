// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/tiff_description.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace reckon {
namespace {

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end == text.data() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::uint64_t count_in(std::string_view text, std::uint64_t otherwise) {
  std::uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc{} && end != text.data() ? value : otherwise;
}

/// The value of an attribute of XML, the first that is there.
std::string_view attribute(std::string_view text, std::string_view name) {
  const std::string begin = std::string{name} + "=\"";
  const std::size_t at = text.find(begin);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + begin.size());
  return text.substr(0, text.find('"'));
}

TiffDescription parse_ome(std::string_view text) {
  TiffDescription found;
  found.x_edge = number_in(attribute(text, "PhysicalSizeX"));
  found.y_edge = number_in(attribute(text, "PhysicalSizeY"));
  found.z_edge = number_in(attribute(text, "PhysicalSizeZ"));
  const std::string_view unit = attribute(text, "PhysicalSizeXUnit");
  found.unit = unit.empty() ? "um" : std::string{unit};  // as the schema has it
  return found;
}

}  // namespace

TiffDescription parse_tiff_description(std::string_view text) {
  if (text.find("<OME") != std::string_view::npos) return parse_ome(text);
  TiffDescription found;
  found.by_imagej = text.starts_with("ImageJ=");
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || !found.by_imagej) continue;
    const std::string_view key = line.substr(0, equals);
    const std::string_view value = line.substr(equals + 1);
    if (key == "images") found.images = count_in(value, 0);
    if (key == "channels") found.per_axis[0] = count_in(value, 1);
    if (key == "slices") found.per_axis[1] = count_in(value, 1);
    if (key == "frames") found.per_axis[2] = count_in(value, 1);
    if (key == "spacing") found.z_edge = number_in(value);
    if (key == "unit") found.unit = value;
  }
  return found;
}

}  // namespace reckon
