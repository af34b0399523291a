// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reckon/avatar/byte_reader.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/text_reader.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr const char* rewrite = "Correct the header, or write the file again.";

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

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;

  [[nodiscard]] std::size_t least_size() const {
    std::size_t size = 0;
    for (const Property& p : properties) size += p.count_type ? p.count_type->size : p.type.size;
    return size;
  }
};

struct Header {
  Encoding encoding;
  std::vector<Element> elements;
};

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

/// The numbers after the header, whatever their encoding.
class Body {
 public:
  Body(const TextReader& text, std::string_view bytes, const std::string& name, Encoding encoding)
      : text_{text},
        bytes_{bytes, name,
               encoding == Encoding::big_endian ? ByteReader::Order::big_endian
                                                : ByteReader::Order::little_endian,
               bytes.size() - text.remaining_text().size()},
        is_text_{encoding == Encoding::ascii} {}

  [[noreturn]] void fail(const std::string& problem, const std::string& reason) const {
    constexpr const char* fix = "Check what wrote the file, or write it again.";
    if (is_text_) text_.fail(problem, reason, fix);
    bytes_.fail(problem, reason, fix);
  }

  /// Refuses a number of things, each of at least `size` bytes, that the file has no room for.
  void require_room(std::uint64_t count, std::size_t size, const std::string& what) const {
    // As text, a number and what separates it from the next take at least two characters.
    const std::size_t least = is_text_ ? 2 : size;
    const std::size_t room = is_text_ ? room_in_text() : bytes_.remaining();
    if (count <= room / least) return;
    fail(what + ": the file ends too early", std::to_string(count) + " are announced, which " +
                                                 std::to_string(room) +
                                                 " remaining bytes cannot hold");
  }

  double real(const NumberType& type, const std::string& what) {
    if (is_text_) return text_.to_double(token(), what);
    if (type.kind == NumberType::Kind::real) return bytes_.finite_real(type.size, what);
    return static_cast<double>(integer(type, what));
  }

  std::int64_t integer(const NumberType& type, const std::string& what) {
    if (is_text_) return text_.to_integer(token(), what);
    if (type.kind == NumberType::Kind::unsigned_integer) {
      return static_cast<std::int64_t>(bytes_.unsigned_integer(type.size));
    }
    return bytes_.signed_integer(type.size);
  }

  void skip(const NumberType& type, std::uint64_t count) {
    if (!is_text_) return bytes_.skip(type.size * count);
    for (std::uint64_t n = 0; n < count; ++n) {
      if (token().empty()) fail("the file ends too early", "");
    }
  }

  /// The length of a list that fits into what remains.
  std::uint64_t list_length(const Property& list) {
    const std::int64_t length = integer(*list.count_type, "length of list '" + list.name + "'");
    if (length < 0) {
      fail("the length of list '" + list.name + "' is negative", std::to_string(length));
    }
    require_room(static_cast<std::uint64_t>(length), list.type.size, "list '" + list.name + "'");
    return static_cast<std::uint64_t>(length);
  }

 private:
  std::string_view token() { return text_.next_token_anywhere(); }
  [[nodiscard]] std::size_t room_in_text() const {
    // The end of the current line is in neither part, and the last line may lack its end.
    return text_.remaining_text().size() + text_.remaining_line().size() + 2;
  }

  TextReader text_;
  ByteReader bytes_;
  bool is_text_;
};

void read_vertices(Body& body, const Element& element, TriangleMesh& mesh) {
  for (std::uint64_t n = 0; n < element.count; ++n) {
    Vec3 vertex;
    for (const Property& property : element.properties) {
      if (property.count_type) {
        body.skip(property.type, body.list_length(property));
      } else if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
        vertex[property.name[0] - 'x'] = body.real(property.type, property.name + " coordinate");
      } else {
        body.skip(property.type, 1);
      }
    }
    mesh.vertices.push_back(vertex);
  }
}

bool is_face_list(const Property& property) {
  return property.name == "vertex_indices" || property.name == "vertex_index";
}

void read_faces(Body& body, const Element& element, std::uint64_t vertices, TriangleMesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (std::uint64_t n = 0; n < element.count; ++n) {
    for (const Property& property : element.properties) {
      if (!is_face_list(property)) {
        body.skip(property.type, property.count_type ? body.list_length(property) : 1);
        continue;
      }
      const std::uint64_t length = body.list_length(property);
      if (length < 3) {
        body.fail("face " + std::to_string(n) + " needs at least three corners",
                  "it has " + std::to_string(length));
      }
      corners.clear();
      for (std::uint64_t c = 0; c < length; ++c) {
        const std::int64_t index = body.integer(property.type, "vertex of a face");
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
          body.fail("face " + std::to_string(n) + " uses vertex " + std::to_string(index) +
                        ", which does not exist",
                    "the file has " + std::to_string(vertices) + " vertices");
        }
        corners.push_back(static_cast<std::uint32_t>(index));
      }
      for (std::size_t c = 2; c < corners.size(); ++c) {
        mesh.triangles.push_back({corners[0], corners[c - 1], corners[c]});
      }
    }
  }
}

[[noreturn]] void fail(const std::string& name, std::string problem, std::string reason) {
  throw Error{{.place = name,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = "Export a triangle or polygon mesh."}};
}

/// Checks that vertices and faces are described once, with what is needed; gives the vertex count.
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

}  // namespace

TriangleMesh parse_ply(std::string_view bytes, const std::string& name) {
  TextReader reader{bytes, name};
  const Header header = parse_header(reader);
  const std::uint64_t vertices = require_mesh(header, name);
  Body body{reader, bytes, name, header.encoding};
  TriangleMesh mesh;
  for (const Element& element : header.elements) {
    if (element.count == 0) continue;
    body.require_room(element.count, element.least_size(), "element '" + element.name + "'");
    if (element.name == "vertex") {
      read_vertices(body, element, mesh);
    } else if (element.name == "face") {
      read_faces(body, element, vertices, mesh);
    } else {
      for (std::uint64_t n = 0; n < element.count; ++n) {
        for (const Property& p : element.properties) {
          body.skip(p.type, p.count_type ? body.list_length(p) : 1);
        }
      }
    }
  }
  if (mesh.triangles.empty()) fail(name, "holds no faces", "");
  return welded(mesh);
}

}  // namespace reckon
