// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <string>

#include "reckon/avatar/byte_reader.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

constexpr std::size_t header_size = 84;  // 80 bytes of free text and the number of triangles
constexpr std::size_t record_size = 50;  // normal, three vertices, two bytes of attributes

void add_triangle(TriangleMesh& soup) {
  const auto end = static_cast<std::uint32_t>(soup.vertices.size());
  soup.triangles.push_back({end - 3, end - 2, end - 1});
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < header_size) {
    throw Error{{.place = name,
                 .problem = "is not an STL file",
                 .reason = "it neither begins with 'solid' as text does, nor has the " +
                           std::to_string(header_size) + " bytes of a binary header",
                 .fix = "Write the mesh again."}};
  }
  ByteReader reader{bytes, name};
  reader.skip(header_size - 4);
  const std::uint64_t count = reader.unsigned_integer(4);
  const std::uint64_t expected = header_size + record_size * count;
  if (bytes.size() != expected) {
    throw Error{{.place = name + ", byte 80",
                 .problem = "is not a whole binary STL file",
                 .reason = "its header announces " + std::to_string(count) + " triangles in " +
                           std::to_string(expected) + " bytes, the file has " +
                           std::to_string(bytes.size()),
                 .fix = "Copy or write the file again."}};
  }
  TriangleMesh soup;
  soup.vertices.reserve(3 * count);
  soup.triangles.reserve(count);
  for (std::uint64_t t = 0; t < count; ++t) {
    reader.skip(12);  // the normal
    for (int corner = 0; corner < 3; ++corner) {
      const double x = reader.finite_real(4, "x coordinate");
      const double y = reader.finite_real(4, "y coordinate");
      soup.vertices.push_back({x, y, reader.finite_real(4, "z coordinate")});
    }
    reader.skip(2);
    add_triangle(soup);
  }
  return soup;
}

/// Checks the order facet - three vertices - endfacet. The words 'outer loop' and 'endloop' add
/// nothing and are only skipped, as are normals, which some programs write as nan.
TriangleMesh parse_ascii(std::string_view text, const std::string& name) {
  constexpr const char* rewrite = "Write the mesh again, best as binary STL.";
  TextReader reader{text, name};
  TriangleMesh soup;
  bool in_solid = false;
  bool in_facet = false;
  std::size_t facet_start = 0;
  while (reader.next_line()) {
    const std::string word = lower_case(reader.next_token());
    if (word.empty() || word == "outer" || word == "endloop") continue;
    if (word == "solid" || word == "endsolid") {
      if (in_facet) reader.fail("'" + word + "' inside a facet", "", rewrite);
      in_solid = word == "solid";
    } else if (word == "facet") {
      if (in_facet) reader.fail("a facet begins inside a facet", "", rewrite);
      in_facet = true;
      facet_start = soup.vertices.size();
    } else if (word == "vertex") {
      if (!in_facet) reader.fail("a vertex stands outside a facet", "", rewrite);
      const double x = reader.next_double("x coordinate");
      const double y = reader.next_double("y coordinate");
      soup.vertices.push_back({x, y, reader.next_double("z coordinate")});
    } else if (word == "endfacet") {
      const std::size_t corners = soup.vertices.size() - facet_start;
      if (!in_facet || corners != 3) {
        reader.fail("a facet does not have three vertices",
                    in_facet ? "it has " + std::to_string(corners) : "it never began", rewrite);
      }
      in_facet = false;
      add_triangle(soup);
    } else {
      reader.fail("unknown word " + in_quotes(word), "expected facet, vertex, endfacet or endsolid",
                  rewrite);
    }
  }
  if (in_solid || in_facet) {
    reader.fail("the file ends before 'endsolid'", "it is cut short", rewrite);
  }
  return soup;
}

bool has_binary_size(std::string_view bytes) {
  if (bytes.size() < header_size) return false;
  ByteReader reader{bytes, ""};
  reader.skip(header_size - 4);
  return bytes.size() == header_size + record_size * reader.unsigned_integer(4);
}

bool looks_like_text(std::string_view bytes) {
  const std::string_view start = without_byte_order_mark(bytes).substr(0, 1024);
  const bool has_control_codes = start.find_first_of(std::string_view{
                                     "\0\1\2\3\4\5\6\7\x0e\x0f", 10}) != std::string_view::npos;
  const std::size_t word = start.find_first_not_of(" \t\r\n");
  return !has_control_codes && word != std::string_view::npos &&
         lower_case(start.substr(word, 5)) == "solid";
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& name) {
  // The size decides first: no ASCII file can look like a binary file of its size, since any four
  // printable bytes announce more than 25 GB.
  const TriangleMesh soup = !has_binary_size(bytes) && looks_like_text(bytes)
                                ? parse_ascii(bytes, name)
                                : parse_binary(bytes, name);
  if (soup.triangles.empty()) {
    throw Error{{.place = name,
                 .problem = "holds no triangles",
                 .reason = "",
                 .fix = "Check what wrote the file."}};
  }
  return welded(soup);
}

}  // namespace reckon
