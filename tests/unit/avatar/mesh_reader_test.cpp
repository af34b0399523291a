// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "expect_error.hpp"
#include "mesh_writers.hpp"
#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
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
