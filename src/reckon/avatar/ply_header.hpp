// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/text/text_reader.hpp"

/// The layout of the data of a PLY file, from its header.
namespace reckon::ply {

enum class Encoding : std::uint8_t { ascii, little_endian, big_endian };

struct NumberType {
  enum class Kind : std::uint8_t { signed_integer, unsigned_integer, real } kind;
  std::size_t size;  // bytes
};

struct Property {
  std::string name;
  NumberType type;
  std::optional<NumberType> count_type;  // set for a list
};

/// Things of one kind, such as vertices or faces, with the same properties each.
struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;

  /// The fewest bytes that one of them takes in a binary file.
  [[nodiscard]] std::size_t least_size() const;
};

struct Header {
  Encoding encoding;
  std::vector<Element> elements;
};

/// Reads up to and with the line 'end_header'. Throws Error naming file and line.
[[nodiscard]] Header parse_header(TextReader& reader);

/// Whether this is the list of a face's vertices, which goes by two names.
[[nodiscard]] bool is_face_list(const Property& property);

/// Checks that vertices and faces are described once, with what a mesh needs, and that no element
/// takes no space; gives the number of vertices. Throws Error naming the file `name`.
[[nodiscard]] std::uint64_t require_mesh(const Header& header, const std::string& name);

}  // namespace reckon::ply
