// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/legacy_morphology.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>

#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

double next_number(TextReader& reader, std::string_view what) {
  return reader.to_double(reader.next_token_anywhere(), what);
}
double next_positive(TextReader& reader, std::string_view what) {
  const double value = next_number(reader, what);
  if (!(value > 0)) {
    reader.fail(fmt::format("the {} must be positive", what), fmt::format("{} was found", value),
                "Make the file anew.");
  }
  return value;
}
Vec3 next_vector(TextReader& reader, std::string_view what) {
  const double x = next_number(reader, what);
  const double y = next_number(reader, what);
  const double z = next_number(reader, what);
  return {x, y, z};
}
std::int64_t next_count(TextReader& reader, std::string_view what, std::int64_t least) {
  const std::int64_t value = reader.to_integer(reader.next_token_anywhere(), what);
  if (value < least || value > std::numeric_limits<std::int32_t>::max()) {
    reader.fail(fmt::format("the {} is out of range", what),
                fmt::format("{} was found, at least {} is needed", value, least),
                "Make the file anew.");
  }
  return value;
}
/// A number takes at least two characters, so a count that the text cannot hold is found before
/// memory is reserved for it.
void check_room(TextReader& reader, std::string_view text, std::uint64_t numbers,
                std::string_view what) {
  if (numbers > text.size() / 2) {
    reader.fail(fmt::format("the file is too short for its {}", what),
                fmt::format("{} numbers are announced", numbers),
                "The file may be cut short: copy it again.");
  }
}

std::array<std::int32_t, 3> next_dims(TextReader& reader, std::string_view text) {
  std::array<std::int32_t, 3> dims{};
  std::uint64_t values = 1;
  for (std::int32_t& dim : dims) {
    dim = static_cast<std::int32_t>(next_count(reader, "grid dimension", 2));
    values *= static_cast<std::uint64_t>(dim);
    check_room(reader, text, values, "grid values");
  }
  return dims;
}

float next_float(TextReader& reader, std::string_view what) {
  const double value = next_number(reader, what);
  if (std::abs(value) > std::numeric_limits<float>::max()) {
    reader.fail(fmt::format("the {} is too large", what), fmt::format("{} was found", value),
                "Make the file anew.");
  }
  return static_cast<float>(value);
}

void append_vector(std::string& out, const Vec3& v) {
  fmt::format_to(std::back_inserter(out), "{} {} {}", v.x, v.y, v.z);
}

}  // namespace

LegacyMorphology parse_legacy_morphology(std::string_view text, const std::string& name) {
  TextReader reader{text, name};
  LegacyMorphology m;
  m.mass = next_positive(reader, "mass");
  for (int axis = 0; axis < 3; ++axis) m.moments[axis] = next_positive(reader, "moment of inertia");
  m.center_of_mass = next_vector(reader, "centre of mass");
  const auto node_count = static_cast<std::uint64_t>(next_count(reader, "number of nodes", 1));
  check_room(reader, text, 3 * node_count, "nodes");
  m.nodes.reserve(node_count);
  for (std::uint64_t n = 0; n < node_count; ++n) {
    m.nodes.push_back(next_vector(reader, "node coordinate"));
  }
  m.bounding_radius = next_positive(reader, "bounding radius");
  m.dims = next_dims(reader, text);
  const auto value_count = static_cast<std::size_t>(m.dims[0]) *
                           static_cast<std::size_t>(m.dims[1]) *
                           static_cast<std::size_t>(m.dims[2]);
  m.values.reserve(value_count);
  for (std::size_t v = 0; v < value_count; ++v)
    m.values.push_back(next_float(reader, "grid value"));
  if (const std::string_view rest = reader.next_token_anywhere(); !rest.empty()) {
    reader.fail("there is more after the last grid value", "found " + in_quotes(rest),
                "Check the grid's dimensions.");
  }
  return m;
}

std::string format_legacy_morphology(const LegacyMorphology& m) {
  std::string out = fmt::format("{}\n", m.mass);
  append_vector(out, m.moments);
  out += '\n';
  append_vector(out, m.center_of_mass);
  fmt::format_to(std::back_inserter(out), "\n{}\n", m.nodes.size());
  for (std::size_t n = 0; n < m.nodes.size(); ++n) {
    if (n > 0) out += ' ';
    append_vector(out, m.nodes[n]);
  }
  fmt::format_to(std::back_inserter(out), "\n{}\n{} {} {}\n", m.bounding_radius, m.dims[0],
                 m.dims[1], m.dims[2]);
  for (std::size_t v = 0; v < m.values.size(); ++v) {
    if (v > 0) out += ' ';
    fmt::format_to(std::back_inserter(out), "{}", m.values[v]);
  }
  out += '\n';
  return out;
}

std::vector<Vec3> parse_legacy_positions(std::string_view text, const std::string& name) {
  TextReader reader{text, name};
  std::vector<Vec3> positions;
  while (reader.next_line()) {
    const std::string_view first = reader.next_token();
    if (first.empty()) continue;
    const double x = reader.to_double(first, "position");
    const double y = reader.next_double("position");
    const double z = reader.next_double("position");
    if (!reader.next_token().empty()) {
      reader.fail("a position has three numbers", "more were found", "Correct the line.");
    }
    positions.push_back({x, y, z});
  }
  return positions;
}

std::vector<Quaternion> parse_legacy_rotations(std::string_view text, const std::string& name) {
  TextReader reader{text, name};
  std::vector<Quaternion> rotations;
  while (reader.next_line()) {
    const std::string_view first = reader.next_token();
    if (first.empty()) continue;
    const double a = reader.to_double(first, "rotation");
    const double b = reader.next_double("rotation");
    const double c = reader.next_double("rotation");
    const double d = reader.next_double("rotation");
    if (!reader.next_token().empty()) {
      reader.fail("a rotation has four numbers", "more were found", "Correct the line.");
    }
    if (!(std::abs(std::sqrt(a * a + b * b + c * c + d * d) - 1) <= 1e-3)) {
      reader.fail("a rotation must be a unit quaternion",
                  fmt::format("its length is {:.6g}", std::sqrt(a * a + b * b + c * c + d * d)),
                  "Check the column order.");
    }
    rotations.push_back({d, -b, a, -c});
  }
  return rotations;
}

}  // namespace reckon
