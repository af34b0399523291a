// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.hpp"
#include "mesh_writers.hpp"
#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

using test::expect_error;
using test::Ply;

TriangleMesh lopsided() {
  return test::tetrahedron({0.5, -0.25, 0}, {2, 0, 0.125}, {0, 3, 0}, {0, 0, 4.5});
}

void expect_same(const TriangleMesh& found, const TriangleMesh& expected) {
  ASSERT_EQ(found.triangles.size(), expected.triangles.size());
  EXPECT_EQ(found.vertices.size(), expected.vertices.size());
  for (std::size_t t = 0; t < expected.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(found.vertices[found.triangles[t][c]], expected.vertices[expected.triangles[t][c]]);
    }
  }
}

TEST(MeshReader, EveryFormatGivesTheSameMesh) {
  for (const TriangleMesh& mesh : {test::cube(-0.5, 1.75), lopsided()}) {
    expect_same(parse_stl(test::binary_stl(mesh), ""), mesh);
    expect_same(parse_stl(test::binary_stl(mesh, "solid exported by a rude program"), ""), mesh);
    expect_same(parse_stl(test::ascii_stl(mesh), ""), mesh);
    expect_same(parse_stl(test::ascii_stl(mesh, "\r\n"), ""), mesh);
    expect_same(parse_stl(test::ascii_stl(mesh, "\r"), ""), mesh);
    expect_same(parse_obj(test::obj(mesh), ""), mesh);
    expect_same(parse_ply(test::ply(mesh, Ply::ascii), ""), mesh);
    expect_same(parse_ply(test::ply(mesh, Ply::little_endian), ""), mesh);
    expect_same(parse_ply(test::ply(mesh, Ply::big_endian), ""), mesh);
  }
}

TEST(MeshReader, ReadsFilesInTheirUnit) {
  const auto folder = std::filesystem::path{testing::TempDir()} / "reckon_mesh_reader";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream{folder / name, std::ios::binary} << bytes;
    return folder / name;
  };
  for (const auto& path : {write("a.stl", test::binary_stl(test::cube(0, 2))),
                           write("b.OBJ", test::obj(test::cube(0, 2))),
                           write("c.ply", test::ply(test::cube(0, 2), Ply::big_endian))}) {
    EXPECT_NEAR(solid_properties(read_mesh(path, 1e-3)).volume, 8e-9, 1e-22);
  }
  const auto other = write("d.step", "");
  expect_error([&] { (void)read_mesh(other, 1); }, {"d.step", "'.step'", ".stl, .obj or .ply"});
  expect_error([&] { (void)read_mesh(folder / "e.stl", 1); }, {"e.stl", "No such file"});
  expect_error([&] { (void)read_mesh(folder / "a.stl", 0); }, {"a.stl", "unit"});
  const auto empty = write("f.stl", "");
  expect_error([&] { (void)read_mesh(empty, 1); }, {"f.stl", "not an STL file"});
  std::filesystem::create_directories(folder / "g.stl");
  expect_error([&] { (void)read_mesh(folder / "g.stl", 1); }, {"g.stl", "is a folder"});
  std::filesystem::remove_all(folder);
}

TEST(MeshReader, RealGrainsAreClosed) {
  const std::filesystem::path folder = RECKON_SOURCE_DIR "/../shared/data/aggregate57/stl";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no measured grains in " << folder;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    const TriangleMesh mesh = read_mesh(entry.path(), 1e-3);
    EXPECT_EQ(mesh.vertices.size(), 642U);
    const auto edges = sorted_half_edges(mesh);
    for (std::size_t e = 0; e < edges.size(); e += 2) ASSERT_TRUE(edges[e].same_edge(edges[e + 1]));
    EXPECT_GT(solid_properties(mesh).volume, 1e-7);
    ++count;
  }
  EXPECT_EQ(count, 30);
}

TEST(MeshReader, WeldsSeamsAndDropsCollapsedTriangles) {
  TriangleMesh mesh = test::cube();
  mesh.vertices.push_back({-0.0, 0.0, 0.0});  // vertex 0 again, with another sign of zero
  mesh.vertices.push_back({7, 7, 7});         // unused
  mesh.triangles[0][0] = 8;
  mesh.triangles.push_back({1, 1, 3});
  mesh.triangles.push_back({0, 8, 3});
  expect_same(welded(mesh), test::cube());
}

TEST(MeshReader, PolygonsBecomeFans) {
  const char* corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";
  const std::string text =
      std::string{corners} + "f 4 3 2 1 # base\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nl 1 2\n";
  const SolidProperties solid = solid_properties(parse_obj(text, ""));
  EXPECT_NEAR(solid.volume, 1.0 / 3, 1e-15);
  EXPECT_EQ(parse_obj(text, "").triangles.size(), 6U);
  const char* ply =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement face 5\nproperty list uchar uint vertex_index\nend_header\n"
      "0 0 0 1 0 0 1 1 0\n0 1 0\n0 0 1\n4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4";
  EXPECT_NEAR(solid_properties(parse_ply(ply, "")).volume, 1.0 / 3, 1e-15);
}

/// The prism over a polygon in the plane z = 0, as polygons: n corners below, n above.
std::string prism_obj(const std::vector<std::pair<double, double>>& outline, double height) {
  std::string text;
  const std::size_t n = outline.size();
  for (const double z : {0.0, height}) {
    for (const auto& [x, y] : outline) text += fmt::format("v {} {} {}\n", x, y, z);
  }
  std::string below = "f";
  std::string above = "f";
  for (std::size_t c = 0; c < n; ++c) {
    below += fmt::format(" {}", n - c);
    above += fmt::format(" {}", n + 1 + c);
  }
  text += below + "\n" + above + "\n";
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t d = (c + 1) % n;
    text += fmt::format("f {} {} {} {}\n", c + 1, d + 1, n + d + 1, n + c + 1);
  }
  return text;
}

double polygon_area(const std::vector<std::pair<double, double>>& outline) {
  double doubled = 0;
  for (std::size_t c = 0; c < outline.size(); ++c) {
    const auto& [x, y] = outline[c];
    const auto& [u, v] = outline[(c + 1) % outline.size()];
    doubled += x * v - u * y;
  }
  return doubled / 2;
}

// A fan from the first corner would cover the notch of a concave face, and make a triangle without
// area of a corner on a straight side.
TEST(MeshReader, ConcaveAndCollinearFacesAreSplitAlongTheirOutline) {
  using Outline = std::vector<std::pair<double, double>>;
  Outline comb;  // teeth, and a corner in the middle of every straight side
  for (int tooth = 0; tooth < 6; ++tooth) {
    comb.insert(comb.end(), {{2.0 * tooth, 1}, {2.0 * tooth, 4}, {2.0 * tooth, 7}});
    comb.insert(comb.end(), {{2.0 * tooth + 0.5, 7}, {2.0 * tooth + 1, 7}, {2.0 * tooth + 1, 1}});
  }
  comb.insert(comb.end(), {{11, 0}, {6, 0}, {0, 0}});
  std::reverse(comb.begin(), comb.end());
  Outline spiral;
  for (int n = 0; n <= 40; ++n) {
    spiral.emplace_back((1 + 0.1 * n) * std::cos(0.3 * n), (1 + 0.1 * n) * std::sin(0.3 * n));
  }
  for (int n = 40; n >= 0; --n) {
    spiral.emplace_back((0.5 + 0.1 * n) * std::cos(0.3 * n), (0.5 + 0.1 * n) * std::sin(0.3 * n));
  }
  const std::vector<Outline> outlines{
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
      {{0, 0}, {0.5, 0}, {1, 0}, {1, 2}, {0, 2}},
      {{0, 0}, {0.1, 0.1 / 3}, {0.3, 0.1}, {0.2, 2}, {0, 2}},  // straight up to rounding
      {{0, 0}, {3, 0}, {3, 3}, {1.5, 0.1}, {0, 3}},
      comb,
      spiral};
  for (const Outline& outline : outlines) {
    for (std::size_t turn = 0; turn < outline.size(); ++turn) {
      Outline turned = outline;
      std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turn), turned.end());
      if (polygon_area(turned) < 0) std::reverse(turned.begin(), turned.end());
      for (const double height : {0.7, 30.0}) {
        const TriangleMesh mesh = parse_obj(prism_obj(turned, height), "prism.obj");
        EXPECT_EQ(mesh.triangles.size(), 2 * (outline.size() - 2) + 2 * outline.size());
        ASSERT_NO_THROW(require_closed_surface(mesh, "prism")) << outline.size() << ", " << turn;
        EXPECT_NEAR(enclosed_volume(mesh) / (height * polygon_area(turned)), 1, 1e-12);
      }
    }
  }
  expect_error(
      [] { (void)parse_obj("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3 4\n", "g.obj"); },
      {"g.obj, line 5", "crosses or touches itself", "4 corners"});
  const char* bow =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar uint vertex_index\nend_header\n"
      "0 0 0 1 1 0 1 0 0 0 1.5 0 4 0 1 2 3";
  expect_error([&] { (void)parse_ply(bow, "g.ply"); }, {"g.ply, face 0", "crosses"});
}

TEST(MeshReader, FilesOfOtherProgramsHaveTheirVolumes) {
  const std::filesystem::path folder = RECKON_SOURCE_DIR "/../shared/cases/meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no cases in " << folder;
  for (const auto& [name, volume] :
       {std::pair{"concave0.obj", 3.0}, {"collinear_mid0.obj", 6.0}, {"bom.stl", 6.0}}) {
    const TriangleMesh mesh = read_mesh(folder / name, 1);
    ASSERT_NO_THROW(require_closed_surface(mesh, name));
    EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-12) << name;
  }
}

TEST(MeshReader, BackslashesContinueLines) {
  const std::string plain = test::obj(lopsided());
  std::string broken = "# a \\ in a comment ends nothing\n";
  for (const char c : plain) broken += c == ' ' ? std::string{" \\\r\n  "} : std::string{c};
  expect_same(parse_obj(broken, ""), lopsided());
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  EXPECT_EQ(parse_obj(corners + "f 1 2\\\n 3\nf 1 \\\n\\\n4 2\n", "").triangles.size(), 2U);
  expect_error([&] { (void)parse_obj(corners + "f 1 2 \\", "g.obj"); }, {"line 5", "it has 2"});
}

TEST(MeshReader, ByteOrderMarksAreSkipped) {
  const std::string mark = "\xef\xbb\xbf";
  expect_same(parse_stl(mark + test::ascii_stl(lopsided()), ""), lopsided());
  expect_same(parse_obj(mark + test::obj(lopsided()), ""), lopsided());
  expect_same(parse_ply(mark + test::ply(lopsided(), Ply::ascii), ""), lopsided());
  for (const char* other : {"\xff\xfe", "\xfe\xff"}) {
    expect_error([&] { (void)parse_obj(other + test::obj(lopsided()), "g.obj"); },
                 {"g.obj", "UTF-16", "UTF-8"});
  }
}

TEST(MeshReader, StlFaultsAreNamed) {
  const auto parse = [](std::string bytes) {
    return [bytes = std::move(bytes)] { (void)parse_stl(bytes, "g.stl"); };
  };
  const std::string good = test::binary_stl(test::cube());
  expect_error(parse(good.substr(0, good.size() - 7)),
               {"g.stl", "byte 80", "12 triangles", "684 bytes", "677"});
  expect_error(parse("solid " + good.substr(6, good.size() - 10)), {"whole binary STL"});
  expect_error(parse(good.substr(0, 50)), {"not an STL"});
  std::string huge = good;
  huge.replace(80, 4, "\xff\xff\xff\xff");
  expect_error(parse(huge), {"4294967295 triangles", "684"});
  std::string bad = good;
  bad.replace(84 + 12 + 4, 4, std::string{"\x00\x00\xc0\x7f", 4});
  expect_error(parse(bad), {"byte 100", "y coordinate", "not finite"});
  expect_error(parse(std::string(84, '\0')), {"no triangles"});

  const std::string text = test::ascii_stl(test::cube());
  expect_error(parse(text.substr(0, text.find("endsolid"))), {"before 'endsolid'"});
  expect_error(parse(text.substr(0, 200)), {"g.stl, line"});
  expect_error(parse("solid\nendsolid\n"), {"no triangles"});
  expect_error(parse("solid\nvertex 0 0 0\n"), {"line 2", "outside a facet"});
  expect_error(parse("solid\nfacet\nvertex 0 0 zero\n"), {"line 3", "z coordinate", "'zero'"});
  expect_error(parse("solid\nfacet\nvertex 0 inf 0\n"), {"line 3", "not finite"});
  expect_error(parse("solid\nfacet\nvertex 0 0 0\nendfacet\n"), {"line 4", "three", "it has 1"});
  expect_error(parse("solid\nfacet\nfacet\n"), {"line 3", "inside a facet"});
  expect_error(parse("solid\nnonsense\n"), {"line 2", "'nonsense'"});
}

TEST(MeshReader, ObjFaultsAreNamed) {
  const auto parse = [](std::string bytes) {
    return [bytes = std::move(bytes)] { (void)parse_obj(bytes, "g.obj"); };
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_error(parse(points), {"g.obj", "no faces"});
  expect_error(parse(points + "f 1 2\n"), {"line 4", "three corners", "it has 2"});
  expect_error(parse(points + "f 1 2 0\n"), {"line 4", "vertex 0", "begin at 1"});
  expect_error(parse(points + "f 1 2 -4\n"), {"line 4", "vertex -4", "3 vertices"});
  expect_error(parse(points + "f 1 2 3\nf 1 2 4\nf 3 2 1\n"), {"line 5", "vertex 4", "3 vertices"});
  expect_error(parse(points + "f 1 2 3/x\n"), {"line 4", "'3/x'"});
  expect_error(parse(points + "f 1 2 99999999999999999999\n"), {"line 4", "integer"});
  expect_error(parse(points + "f 1 2 4294967296\n"), {"line 4", "vertex 4294967296"});
  expect_error(parse("v 0 0\n"), {"line 1", "z coordinate", "line ends"});
  expect_error(parse("v 0 0 1e999\n"), {"line 1", "out of range"});
}

TEST(MeshReader, PlyFaultsAreNamed) {
  const auto parse = [](std::string bytes) {
    return [bytes = std::move(bytes)] { (void)parse_ply(bytes, "g.ply"); };
  };
  const auto edited = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string ascii = test::ply(test::cube(), Ply::ascii);
  const std::string binary = test::ply(test::cube(), Ply::big_endian);
  expect_error(parse("plot"), {"g.ply, line 1", "not a PLY"});
  expect_error(parse(""), {"not a PLY"});
  expect_error(parse(ascii.substr(0, ascii.find("element camera"))), {"end_header"});
  expect_error(parse(edited(ascii, "format ascii", "format utf8")), {"line 2", "'utf8'"});
  expect_error(parse(edited(ascii, "property double x", "property half x")), {"line 5", "'half'"});
  expect_error(parse(edited(ascii, "property double x", "property double w")), {"number 'x'"});
  expect_error(parse(edited(ascii, "vertex_indices", "corners")), {"vertex_indices"});
  expect_error(parse(edited(ascii, "int32 vertex_indices", "float vertex_indices")),
               {"list of integers"});
  expect_error(parse(edited(ascii, "element face 12", "element tristrips 12")),
               {"element 'face'", "triangle strips"});
  expect_error(parse(edited(ascii, "element vertex 8", "element vertex -8")), {"line 4", "-8"});
  for (const std::string& text : {ascii, binary}) {
    expect_error(parse(edited(text, "element vertex 8", "element vertex 4000000000")),
                 {"'vertex'", "4000000000", "remaining bytes"});
    expect_error(parse(edited(text, "element face 12", "element face 13")), {"file ends"});
    expect_error(parse(text.substr(0, text.size() - 4)), {"g.ply, "});
  }
  expect_error(
      parse(edited(ascii, "element camera 2\nproperty float focus", "element camera 2000000000")),
      {"'camera'", "no properties"});
  expect_error(parse(edited(ascii, "9 3 0 2 3", "9 3 0 2 8")),
               {"vertex 8", "8 vertices", "line 26"});
  expect_error(parse(edited(ascii, "9 3 0 2 3", "9 2 0 2")), {"face 0", "three corners"});
  expect_error(parse(edited(ascii, "9 3 0 2 3", "9 -3 0 2 3")), {"negative"});
  expect_error(parse(edited(ascii, "9 3 0 2 3", "9 3000 0 2 3")), {"3000", "remaining bytes"});
  expect_error(parse(edited(ascii, "0 200 0 0 2", "0 200 nan 0 2")),
               {"line 16", "y coordinate", "not finite"});
  expect_error(parse(edited(ascii, "element face 12", "element face 0")), {"no faces"});
}

// Damaged files must give an Error or a mesh that is safe to use, never anything else.
TEST(MeshReader, DamagedFilesGiveErrorsOnly) {
  const std::string numbers[] = {"-1", "0", "4294967295", "99999999999999999999", "nan", "1e999",
                                 "\n", "/", " "};
  const TriangleMesh mesh = lopsided();
  const std::string samples[] = {test::binary_stl(mesh),
                                 test::ascii_stl(mesh),
                                 test::obj(mesh),
                                 test::ply(mesh, Ply::ascii),
                                 test::ply(mesh, Ply::big_endian),
                                 test::ply(mesh, Ply::little_endian)};
  RandomStream random{1, RandomPurpose::other, 0};
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
  };
  int refused = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    std::string bytes = samples[below(std::size(samples))];
    for (std::size_t edits = 1 + below(4); edits > 0 && !bytes.empty(); --edits) {
      const std::size_t at = below(bytes.size());
      switch (below(4)) {
        case 0:
          bytes[at] = static_cast<char>(below(256));
          break;
        case 1:
          bytes.erase(at, below(30));
          break;
        case 2:
          bytes.insert(at, numbers[below(std::size(numbers))]);
          break;
        default:
          bytes.insert(at, bytes.substr(below(bytes.size()), below(60)));
      }
    }
    for (const auto parse : {parse_stl, parse_obj, parse_ply}) {
      try {
        const TriangleMesh read = parse(bytes, "damaged");
        for (const Vec3& v : read.vertices) ASSERT_TRUE(is_finite(v));
        for (const auto& t : read.triangles) {
          for (const std::uint32_t v : t) ASSERT_LT(v, read.vertices.size());
        }
      } catch (const Error& error) {
        ASSERT_FALSE(error.text().fix.empty()) << error.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 12000);
}

}  // namespace
}  // namespace reckon
