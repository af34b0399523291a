// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace reckon {

/// Where in a .vtp file an array lies.
enum class VtkSection : std::uint8_t {
  field_data,
  point_data,
  cell_data,
  points,
  verts,
  lines,
  polys
};

/// A .vtp file as write_vtp makes it (core/vtk_xml.hpp): one piece, raw appended data,
/// little-endian, 64-bit headers. The whole file is held in memory; arrays are taken out by name.
/// Every failure throws Error with the file's name.
class VtkReader {
 public:
  explicit VtkReader(std::filesystem::path path);

  [[nodiscard]] bool has(VtkSection section, std::string_view name) const;
  /// Tuples of an array; 0 where there is none.
  [[nodiscard]] std::size_t tuples(VtkSection section, std::string_view name) const;
  /// An array of any number type as doubles, which hold every number that write_vtp's callers
  /// store. It must have `components` numbers in each of `expected` tuples.
  [[nodiscard]] std::vector<double> numbers(VtkSection section, std::string_view name,
                                            std::uint32_t components, std::size_t expected) const;

 private:
  struct Array {
    VtkSection section;
    std::string name;
    std::string type;
    std::uint32_t components;
    std::string_view bytes;
  };
  void read_tag(std::string_view tag, std::size_t data);
  [[nodiscard]] std::string_view appended(std::size_t data, std::uint64_t offset) const;
  [[nodiscard]] const Array* find(VtkSection section, std::string_view name) const;
  [[noreturn]] void refuse(const std::string& reason) const;

  std::filesystem::path path_;
  std::string content_;
  std::vector<Array> arrays_;  // views into content_
  VtkSection section_{VtkSection::field_data};
};

}  // namespace reckon
