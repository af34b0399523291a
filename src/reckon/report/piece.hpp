// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/core/vtk_xml.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {

/// A part of what the page shows: JSON text and arrays of numbers, as one deflated block.
///
///   bytes 0 to 3   length of the text, little-endian
///   text           {..., "arrays": [{"name": "position", "type": "Float32", "components": 3,
///                   "offset": 0, "count": 1500}, ...]}, blanks to a multiple of 8 with the length
///   arrays         little-endian numbers; offsets are multiples of 8 and count from here
///
/// all of it in zlib's format (RFC 1950), which browsers inflate themselves.
class Piece {
 public:
  Piece() { json_.begin_object(); }

  /// Further content of the text; every begin must be ended before finish().
  [[nodiscard]] JsonWriter& json() { return json_; }

  template <VtkNumber Number>
  void add(const std::string& name, const std::vector<Number>& numbers,
           std::uint32_t components = 1) {
    add_bytes(name, vtk_type_name<Number>(), components, numbers.size(),
              {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)});
  }

  /// The deflated block. To be called once.
  [[nodiscard]] std::string finish();

 private:
  struct Array {
    std::string name;
    std::string_view type;
    std::uint32_t components;
    std::size_t offset;
    std::size_t count;
  };
  void add_bytes(const std::string& name, std::string_view type, std::uint32_t components,
                 std::size_t count, std::string_view bytes);

  JsonWriter json_;
  std::vector<Array> arrays_;
  std::string bytes_;
};

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace reckon
