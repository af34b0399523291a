// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_sources.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "expect_error.hpp"
#include "grids.hpp"
#include "reckon/avatar/degree_table.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/avatar/surface_files.hpp"
#include "reckon/core/file.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

class ShapeSources : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path{::testing::TempDir()} /
        (std::string{"sources_"} + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(ShapeSources, ExportedStlComesBackAsTheSameGrain) {
  const Shape egg = build_shape(test::stretched(geodesic_sphere(16), {1, 0.8, 0.7}), {}, "egg");
  const TriangleMesh surface = extract_surface(egg.level_set);
  write_stl(folder_ / "egg.stl", surface, "egg");
  const TriangleMesh read = read_mesh(folder_ / "egg.stl", 1);
  EXPECT_EQ(read.triangles.size(), surface.triangles.size());
  EXPECT_EQ(read.vertices.size(), surface.vertices.size());

  const std::vector<ShapeSource> sources{mesh_file_source(folder_ / "egg.stl", 1e-3)};
  const Shape again = build_library(sources, {})[0];
  EXPECT_EQ(again.name, "egg");
  EXPECT_NEAR(again.mass.volume / (1e-9 * egg.mass.volume), 1, 0.01);  // the grid's chords
}

TEST_F(ShapeSources, LevelSetTextBecomesAGrain) {
  const LevelSet grid = test::cube_grid(1.5, 30, {0.5, 0, 0}, [](const Vec3& p) {
    return norm(p - Vec3{0.5, 0, 0}) - 1;
  });
  std::string text = "a ball\n31 31 31\n0.1\n-1 -1.5 -1.5\n";
  for (const float value : grid.values) text += std::to_string(value) + "\n";
  write_file(folder_ / "ball.txt", text);
  const std::vector<ShapeSource> sources{level_set_file_source(folder_ / "ball.txt", 1e-3)};
  const Shape ball = build_library(sources, {})[0];
  EXPECT_NEAR(ball.mass.volume / (4e-9 * std::numbers::pi / 3), 1, 0.01);
  EXPECT_NEAR(ball.descriptors.length, 2e-3, 2e-5);

  write_file(folder_ / "short.txt", text.substr(0, text.size() / 2));
  write_file(folder_ / "huge.txt", "c\n99999 99999 99999\n0.1\n0 0 0\n1\n");
  write_file(folder_ / "flat.txt", "c\n31 31 1\n0.1\n0 0 0\n1\n");
  for (const auto& [name, problem] : {std::pair{"short.txt", "grid value"},
                                      {"huge.txt", "too short for its grid"},
                                      {"flat.txt", "dimension"}}) {
    const std::vector<ShapeSource> bad{level_set_file_source(folder_ / name, 1)};
    test::expect_error([&] { (void)build_library(bad, {}); }, {name, problem});
  }
}

TEST_F(ShapeSources, SolidsAreMeshedForTheirGrid) {
  std::size_t coarse_size = 0;
  const ShapeSource sphere =
      solid_source("sphere", 2, [](double edge) { return sphere_mesh(1, edge); });
  coarse_size = sphere.surface({.voxels_per_diameter = 10}).triangles.size();
  const TriangleMesh fine = sphere.surface({.voxels_per_diameter = 40});
  EXPECT_GT(fine.triangles.size(), 10 * coarse_size);
  EXPECT_NEAR(solid_properties(fine).volume / (4 * std::numbers::pi / 3), 1, 5e-4);
}

TEST_F(ShapeSources, DegreeTable) {
  const auto degrees = parse_degree_table("Name volume Nnn\na.dat 3.5 26\n\nb.dat 1 12\n", "table");
  EXPECT_EQ(degrees, (std::map<std::string, std::uint32_t>{{"a.dat", 26}, {"b.dat", 12}}));
  test::expect_error([] { (void)parse_degree_table("Name degree\na 3\n", "table"); },
                     {"table", "Nnn"});
  test::expect_error([] { (void)parse_degree_table("Name Nnn\na\n", "table"); }, {"too short"});
  test::expect_error([] { (void)parse_degree_table("Name Nnn\na x\n", "table"); }, {"degree"});
  test::expect_error([] { (void)parse_degree_table("Name Nnn\na 9999\n", "table"); },
                     {"out of range"});
  test::expect_error([] { (void)parse_degree_table("Name Nnn\na 3\na 4\n", "table"); },
                     {"line 3", "two lines"});
}

TEST_F(ShapeSources, DegreeTablesTakeCommasAndAByteOrderMark) {
  const std::map<std::string, std::uint32_t> expected{{"a.dat", 26}, {"b, c.dat", 12}};
  const auto parsed = [](const std::string& text) { return parse_degree_table(text, "table"); };
  EXPECT_EQ(parsed("Name,volume,Nnn\na.dat,3.5,26\n\"b, c.dat\", 1 , 12\n"), expected);
  EXPECT_EQ(parsed("\xef\xbb\xbfName;volume;Nnn\r\na.dat;3,5;26\r\n\r\nb, c.dat;1;12\r\n"),
            expected);
  EXPECT_EQ(parsed("\"Name\",\"volume\",\"Nnn\"\na.dat,,26\n\"b, c.dat\",,12"), expected)
      << "an empty cell moves no column";
  test::expect_error([&] { (void)parsed("Name,Nnn\na.dat\n"); }, {"line 2", "too short"});
  test::expect_error([&] { (void)parsed("Name,x,Nnn\na.dat,26\n"); }, {"line 2"});
  test::expect_error([&] { (void)parsed("Name,Nnn,x\na.dat,3\n"); }, {"2 cells, the header 3"});
  test::expect_error([&] { (void)parsed("Name,Nnn\na.dat,\n"); }, {"line 2", "degree"});
  test::expect_error([&] { (void)parsed("Name,Nnn\n\"a.dat,3\n"); }, {"line 2", "double quote"});
}

TEST_F(ShapeSources, OneBadSourceLeavesTheOthers) {
  write_stl(folder_ / "a.stl", test::cube(0, 1), "a");
  write_stl(folder_ / "c.stl", test::cube(0, 2), "c");
  TriangleMesh open = test::cube(0, 3);
  open.triangles.pop_back();
  write_stl(folder_ / "b.stl", open, "b");
  std::vector<ShapeSource> sources;
  for (const char* name : {"a.stl", "b.stl", "c.stl"}) {
    sources.push_back(mesh_file_source(folder_ / name, 1e-3));
  }
  const ShapeResolution coarse{.voxels_per_diameter = 12, .node_count = 50};
  const auto file = folder_ / "boxes.h5";
  std::size_t last = 0;
  const auto faults =
      build_library_file(file, sources, coarse, {}, [&](std::size_t done) { last = done; });
  EXPECT_EQ(last, 3U);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(std::string{faults[0].what()}.find("b.stl: the surface is open"), std::string::npos);
  const ShapeLibrary library = load_library(file);
  ASSERT_EQ(library.size(), 2U);
  EXPECT_EQ(library[0].name, "a");
  EXPECT_EQ(library[1].name, "c");
  // Without a good one nothing is written, and what stood there stays.
  EXPECT_EQ(build_library_file(file, std::span{sources}.subspan(1, 1), coarse).size(), 1U);
  EXPECT_EQ(load_library(file).size(), 2U);
  // In memory a library is whole or not there.
  test::expect_error([&] { (void)build_library(sources, coarse); }, {"b.stl", "open"});
}

TEST_F(ShapeSources, MeshesAreMergedRepairedAndSplitOnRequest) {
  const TriangleMesh two = test::together(test::cube(0, 1), test::cube(2, 4));
  write_stl(folder_ / "two.stl", two, "two");
  const ShapeResolution coarse{.voxels_per_diameter = 12, .node_count = 50};
  const auto made = mesh_file_sources(folder_ / "two.stl", 1e-3, {.split = true});
  const ShapeLibrary split = build_library(made.sources, coarse);
  ASSERT_EQ(split.size(), 2U);
  EXPECT_EQ(split[0].name, "two_1");
  EXPECT_NEAR(split[1].mass.volume, 8e-9, 1e-20);
  const auto refused = mesh_file_sources(folder_ / "two.stl", 1e-3, {.repair = true});
  test::expect_error([&] { (void)build_library(refused.sources, coarse); }, {"2 separate parts"});

  TriangleMesh hole = test::cube(0, 2);
  hole.triangles.pop_back();
  write_stl(folder_ / "hole.stl", hole, "hole");
  const auto repaired = mesh_file_sources(folder_ / "hole.stl", 1e-3, {.repair = true});
  ASSERT_EQ(repaired.notes.size(), 1U);
  EXPECT_TRUE(repaired.notes[0].starts_with("closed 1 hole")) << repaired.notes[0];
  EXPECT_NEAR(build_library(repaired.sources, coarse)[0].mass.volume, 8e-9, 1e-20);
}

TEST_F(ShapeSources, VtpFilesHoldSurfaceAndNodes) {
  const Shape cube = build_shape(test::cube(), {.voxels_per_diameter = 12, .node_count = 40}, "c");
  write_surface_vtp(folder_ / "c.vtp", cube);
  write_nodes_vtp(folder_ / "c_nodes.vtp", cube);
  const std::string nodes = read_file(folder_ / "c_nodes.vtp");
  EXPECT_NE(nodes.find("NumberOfPoints=\"40\" NumberOfVerts=\"40\""), std::string::npos);
  EXPECT_NE(nodes.find("Name=\"area\""), std::string::npos);
  const TriangleMesh surface = extract_surface(cube.level_set);
  EXPECT_NE(read_file(folder_ / "c.vtp")
                .find("NumberOfPolys=\"" + std::to_string(surface.triangles.size()) + "\""),
            std::string::npos);
}

}  // namespace
}  // namespace reckon
