// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/polygon_mesh.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

constexpr const char* correct_face = "Correct the face, or write the file again.";

/// Walks through an OBJ file and gathers its polygons.
class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name) : reader_{text, name}, name_{name} {}

  TriangleMesh parse() {
    while (reader_.next_line()) {
      const std::string_view word = next_token();
      if (word == "v") {
        add_vertex();
      } else if (word == "f" || word == "fo") {  // fo: an old spelling of f
        add_face();
      }
    }
    if (mesh_.faces() == 0) {
      throw Error{{.place = name_,
                   .problem = "holds no faces",
                   .reason = "no line begins with 'f'",
                   .fix = "Export the mesh with its faces."}};
    }
    if (highest_index_ >= mesh_.vertices.size()) {
      throw Error{{.place = name_ + ", line " + std::to_string(highest_index_line_),
                   .problem = "a face uses vertex " + std::to_string(highest_index_ + 1) +
                              ", which does not exist",
                   .reason = "the file has " + std::to_string(mesh_.vertices.size()) + " vertices",
                   .fix = correct_face}};
    }
    return welded(triangulated(std::move(mesh_), [&](std::size_t face) {
      return name_ + ", line " + std::to_string(face_line_[face]);
    }));
  }

 private:
  /// The next token of this line and of those that go on from it: a backslash at the end of a line
  /// joins the next one to it.
  std::string_view next_token() {
    for (;;) {
      if (joins_next_line_ && !reader_.next_line()) return {};
      joins_next_line_ = false;
      std::string_view token = reader_.next_token();
      if (!token.ends_with('\\') || !reader_.rest_of_line_is_blank()) return token;
      joins_next_line_ = true;
      token.remove_suffix(1);
      if (!token.empty()) return token;
    }
  }
  double next_double(const char* what) { return reader_.to_double(next_token(), what); }

  void add_vertex() {
    if (mesh_.vertices.size() == std::numeric_limits<std::uint32_t>::max()) {
      reader_.fail("there are too many vertices", "the limit is 4294967295", "Simplify the mesh.");
    }
    const double x = next_double("x coordinate");
    const double y = next_double("y coordinate");
    mesh_.vertices.push_back({x, y, next_double("z coordinate")});
  }

  void add_face() {
    std::vector<std::uint32_t> corners;
    for (;;) {
      const std::string_view token = next_token();
      if (token.empty() || token.front() == '#') break;
      corners.push_back(vertex_of(token));
    }
    if (corners.size() < 3) {
      reader_.fail("a face needs at least three corners",
                   "it has " + std::to_string(corners.size()), correct_face);
    }
    mesh_.add_face(corners);
    face_line_.push_back(reader_.line_number());
  }

  /// A corner reads v, v/vt, v//vn or v/vt/vn; only v matters here.
  std::uint32_t vertex_of(std::string_view corner) {
    const std::size_t slash = corner.find('/');
    const std::int64_t number = reader_.to_integer(corner.substr(0, slash), "vertex of a face");
    if (slash != std::string_view::npos &&
        corner.find_first_not_of("-0123456789/", slash) != std::string_view::npos) {
      reader_.fail("a face has a corner " + in_quotes(corner),
                   "expected v, v/vt, v//vn or v/vt/vn with integers", correct_face);
    }
    const auto defined = static_cast<std::int64_t>(mesh_.vertices.size());
    const std::int64_t index = number < 0 ? defined + number : number - 1;
    if (number == 0 || index < 0 || index >= std::numeric_limits<std::uint32_t>::max()) {
      reader_.fail("a face uses vertex " + std::to_string(number) + ", which does not exist",
                   "indices begin at 1, negative ones count back from the last of " +
                       std::to_string(defined) + " vertices",
                   correct_face);
    }
    // A vertex may follow its face, so this can only be judged at the end of the file.
    const auto place = static_cast<std::uint32_t>(index);
    if (place >= highest_index_) {
      highest_index_ = place;
      highest_index_line_ = reader_.line_number();
    }
    return place;
  }

  TextReader reader_;
  const std::string& name_;
  PolygonMesh mesh_;
  std::vector<std::size_t> face_line_;
  bool joins_next_line_{false};
  std::uint32_t highest_index_{0};
  std::size_t highest_index_line_{0};
};

}  // namespace

TriangleMesh parse_obj(std::string_view bytes, const std::string& name) {
  return ObjParser{bytes, name}.parse();
}

}  // namespace reckon
