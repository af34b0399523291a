// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/ply_header.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "reckon/core/error.hpp"

namespace reckon::ply {
namespace {

constexpr const char* rewrite = "Correct the header, or write the file again.";

NumberType number_type(TextReader& reader) {
  using Kind = NumberType::Kind;
  struct Named {
    std::string_view name;
    NumberType type;
  };
  static constexpr std::array types{Named{"char", {Kind::signed_integer, 1}},
                                    Named{"int8", {Kind::signed_integer, 1}},
                                    Named{"uchar", {Kind::unsigned_integer, 1}},
                                    Named{"uint8", {Kind::unsigned_integer, 1}},
                                    Named{"short", {Kind::signed_integer, 2}},
                                    Named{"int16", {Kind::signed_integer, 2}},
                                    Named{"ushort", {Kind::unsigned_integer, 2}},
                                    Named{"uint16", {Kind::unsigned_integer, 2}},
                                    Named{"int", {Kind::signed_integer, 4}},
                                    Named{"int32", {Kind::signed_integer, 4}},
                                    Named{"uint", {Kind::unsigned_integer, 4}},
                                    Named{"uint32", {Kind::unsigned_integer, 4}},
                                    Named{"float", {Kind::real, 4}},
                                    Named{"float32", {Kind::real, 4}},
                                    Named{"double", {Kind::real, 8}},
                                    Named{"float64", {Kind::real, 8}}};
  const std::string_view name = reader.next_token();
  for (const Named& type : types) {
    if (type.name == name) return type.type;
  }
  reader.fail("unknown number type " + in_quotes(name),
              "expected char ... double or int8 ... float64", rewrite);
}

Property parse_property(TextReader& reader) {
  Property property;
  TextReader ahead = reader;
  if (ahead.next_token() == "list") {
    (void)reader.next_token();
    property.count_type = number_type(reader);
    if (property.count_type->kind == NumberType::Kind::real) {
      reader.fail("the length of a list must be an integer", "", rewrite);
    }
  }
  property.type = number_type(reader);
  property.name = std::string{reader.next_token()};
  if (property.name.empty()) reader.fail("a property has no name", "", rewrite);
  return property;
}

Encoding parse_format(TextReader& reader) {
  const std::string_view format = reader.next_token();
  if (format == "ascii") return Encoding::ascii;
  if (format == "binary_little_endian") return Encoding::little_endian;
  if (format == "binary_big_endian") return Encoding::big_endian;
  reader.fail("unknown format " + in_quotes(format),
              "expected ascii, binary_little_endian or binary_big_endian", rewrite);
}

Element parse_element(TextReader& reader) {
  Element element;
  element.name = std::string{reader.next_token()};
  const std::int64_t count = reader.next_integer("number of elements");
  if (count < 0 || count >= std::numeric_limits<std::uint32_t>::max()) {
    reader.fail("the number of elements is " + std::to_string(count),
                "it must lie in 0 ... 4294967294", rewrite);
  }
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

[[noreturn]] void fail(const std::string& name, std::string problem, std::string reason) {
  throw Error{{.place = name,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = "Export a triangle or polygon mesh."}};
}

}  // namespace

std::size_t Element::least_size() const {
  std::size_t size = 0;
  for (const Property& p : properties) size += p.count_type ? p.count_type->size : p.type.size;
  return size;
}

Header parse_header(TextReader& reader) {
  if (!reader.next_line() || reader.next_token() != "ply") {
    reader.fail("is not a PLY file", "it does not begin with 'ply'",
                "Check the file and its extension.");
  }
  Header header{};
  std::optional<Encoding> encoding;
  while (reader.next_line()) {
    const std::string_view word = reader.next_token();
    if (word == "end_header") {
      if (!encoding) reader.fail("the header has no 'format' line", "", rewrite);
      header.encoding = *encoding;
      return header;
    }
    if (word == "format") {
      encoding = parse_format(reader);
    } else if (word == "element") {
      header.elements.push_back(parse_element(reader));
    } else if (word == "property") {
      if (header.elements.empty()) reader.fail("a property belongs to no element", "", rewrite);
      header.elements.back().properties.push_back(parse_property(reader));
    } else if (!word.empty() && word != "comment" && word != "obj_info") {
      reader.fail("unknown word " + in_quotes(word) + " in the header", "", rewrite);
    }
  }
  reader.fail("the file ends inside its header", "'end_header' is missing",
              "Copy or write the file again.");
}

bool is_face_list(const Property& property) {
  return property.name == "vertex_indices" || property.name == "vertex_index";
}

std::uint64_t require_mesh(const Header& header, const std::string& name) {
  const auto count = [&](std::string_view element) {
    return std::count_if(header.elements.begin(), header.elements.end(),
                         [&](const Element& e) { return e.name == element; });
  };
  if (count("vertex") != 1) fail(name, "needs one element 'vertex'", "");
  if (count("face") != 1) {
    fail(name, "needs one element 'face'",
         count("tristrips") > 0 ? "triangle strips cannot be read" : "");
  }
  std::uint64_t vertices = 0;
  for (const Element& element : header.elements) {
    if (element.count > 0 && element.properties.empty()) {
      fail(name, "element '" + element.name + "' has no properties", "");
    }
    const auto has = [&](auto&& wanted) {
      return std::count_if(element.properties.begin(), element.properties.end(), wanted) == 1;
    };
    if (element.name == "vertex") {
      vertices = element.count;
      for (const std::string axis : {"x", "y", "z"}) {
        if (has([&](const Property& p) { return p.name == axis && !p.count_type; })) continue;
        fail(name, "vertices need one number '" + axis + "'", "");
      }
    } else if (element.name == "face" && !has([](const Property& p) {
                 return is_face_list(p) && p.count_type && p.type.kind != NumberType::Kind::real;
               })) {
      fail(name, "faces need one list of integers 'vertex_indices'", "");
    }
  }
  return vertices;
}

}  // namespace reckon::ply
