// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "reckon/avatar/byte_reader.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/ply_header.hpp"
#include "reckon/avatar/polygon_mesh.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

using ply::Element;
using ply::Encoding;
using ply::NumberType;
using ply::Property;

/// The numbers after the header, in any encoding.
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

void read_vertices(Body& body, const Element& element, PolygonMesh& mesh) {
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

void read_faces(Body& body, const Element& element, std::uint64_t vertices, PolygonMesh& mesh) {
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
      mesh.add_face(corners);
    }
  }
}

}  // namespace

TriangleMesh parse_ply(std::string_view bytes, const std::string& name) {
  TextReader reader{bytes, name};
  const ply::Header header = ply::parse_header(reader);
  const std::uint64_t vertices = ply::require_mesh(header, name);
  Body body{reader, bytes, name, header.encoding};
  PolygonMesh mesh;
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
  if (mesh.faces() == 0) {
    throw Error{{.place = name,
                 .problem = "holds no faces",
                 .reason = "",
                 .fix = "Export a triangle or polygon mesh."}};
  }
  return welded(triangulated(
      std::move(mesh), [&](std::size_t face) { return name + ", face " + std::to_string(face); }));
}

}  // namespace reckon
