// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "grains_command.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/surface_files.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/xxhash64.hpp"
#include "reckon/scan/image_filters.hpp"

namespace reckon::app {
namespace {

class GrainsCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path{::testing::TempDir()} /
        (std::string{"grains_"} + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  /// Runs `reckon grains ARGUMENTS` and returns what it prints.
  static std::string grains(std::vector<std::string> arguments) {
    CLI::App app{"reckon"};
    CommandWords words{"reckon", "grains"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    add_grains_command(app, words);
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    arguments.emplace_back("grains");
    ::testing::internal::CaptureStdout();
    try {
      app.parse(arguments);
    } catch (...) {
      (void)::testing::internal::GetCapturedStdout();
      throw;
    }
    return ::testing::internal::GetCapturedStdout();
  }

  /// The text of the Error or usage error that the arguments cause.
  static std::string fault(const std::vector<std::string>& arguments) {
    try {
      (void)grains(arguments);
    } catch (const Error& error) {
      return error.what();
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "no fault";
  }

  std::filesystem::path folder_;
};

void expect_holds(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

TEST_F(GrainsCommand, SolidsHaveTheSizesAskedFor) {
  grains({"solid", "--sphere", "1mm", "--sphere", "2mm", "--ellipsoid", "3mm,2mm,1mm", "--box",
          "1mm,2mm,3mm", "--cylinder", "1mm,4mm", "--superellipsoid", "1mm,1mm,1mm,1,1",
          "--voxels-per-diameter", "12", "--nodes", "64", "-o", path("solids.h5")});
  const ShapeLibrary library = load_library(path("solids.h5"));
  ASSERT_EQ(library.size(), 6U);
  const double mm3 = 1e-9;
  const double pi = std::numbers::pi;
  const auto expect_volume = [&](const char* name, double expected) {
    const Shape& shape = find_shape(library, name);
    EXPECT_NEAR(shape.mass.volume / (expected * mm3), 1, 0.01) << name;
    EXPECT_EQ(shape.nodes.size(), 64U);
    EXPECT_NEAR(shape.descriptors.equivalent_diameter / shape.level_set.spacing, 12, 1e-9);
  };
  expect_volume("sphere_1", 4 * pi / 3);
  expect_volume("sphere_2", 32 * pi / 3);
  expect_volume("ellipsoid", 8 * pi);
  expect_volume("box", 6);
  expect_volume("cylinder", 4 * pi);
  expect_volume("superellipsoid", 4 * pi / 3);
}

TEST_F(GrainsCommand, TheSeedDecidesWhatIsGenerated) {
  const auto generate = [&](const std::string& seed, const std::string& name) {
    grains({"generate", "--count", "2", "--seed", seed, "--d50", "0.3mm", "--voxels-per-diameter",
            "10", "--nodes", "50", "--highest-degree", "6", "-o", path(name)});
    return read_file(path(name));
  };
  const std::string first = generate("5", "a.h5");
  EXPECT_TRUE(generate("5", "b.h5") == first);
  EXPECT_FALSE(generate("6", "c.h5") == first);
}

TEST_F(GrainsCommand, MeshesTakeTheirNameAndUnit) {
  write_stl(path("pebble.stl"), ellipsoid_mesh({3, 2, 2}, 0.4), "pebble");
  grains({"from-mesh", path("pebble.stl"), "--unit", "mm", "--voxel", "0.4mm", "-o",
          path("pebble.h5")});
  const Shape shape = load_library(path("pebble.h5")).at(0);
  EXPECT_EQ(shape.name, "pebble");
  EXPECT_EQ(shape.level_set.spacing, 0.4e-3);
  EXPECT_NEAR(shape.descriptors.length, 6e-3, 0.1e-3);
}

TEST_F(GrainsCommand, OneBadMeshOfManyIsNamedAndLeftOut) {
  write_stl(path("good.stl"), ellipsoid_mesh({3, 2, 2}, 0.4), "good");
  write_file(path("bad.stl"), "solid\nnonsense\n");
  write_file(path("worse.obj"), "v 0 0 0\n");
  const auto make = [&](const std::vector<std::string>& files, const std::string& library) {
    std::vector<std::string> arguments{"from-mesh"};
    for (const std::string& file : files) arguments.push_back(path(file));
    arguments.insert(arguments.end(), {"--unit", "mm", "--voxel", "0.4mm", "-o", path(library)});
    ::testing::internal::CaptureStderr();
    const std::string said = fault(arguments);
    return said + ::testing::internal::GetCapturedStderr();
  };
  const std::string said = make({"bad.stl", "good.stl", "worse.obj"}, "some.h5");
  expect_holds(said, "bad.stl, line 2: unknown word 'nonsense'");
  expect_holds(said, "worse.obj: holds no faces");
  expect_holds(said, "2 of 3 sources have faults; the others are in " + path("some.h5"));
  ASSERT_EQ(load_library(path("some.h5")).size(), 1U);
  EXPECT_EQ(load_library(path("some.h5"))[0].name, "good");
  expect_holds(make({"bad.stl", "worse.obj"}, "none.h5"), "none.h5 is not written");
  EXPECT_FALSE(std::filesystem::exists(path("none.h5")));
  expect_holds(make({"bad.stl"}, "none.h5"), "unknown word 'nonsense'");
}

TEST_F(GrainsCommand, MeshesAreMergedSplitAndRepairedOnRequest) {
  // Two balls in one file, one with a hole; every triangle has corners of its own, rounded apart.
  std::string text = "solid two\n";
  std::size_t count = 0;
  for (const double shift : {0.0, 5.0}) {
    const TriangleMesh ball = ellipsoid_mesh({2, 2, 2}, 0.4);
    for (std::size_t t = shift > 0 ? 1 : 0; t < ball.triangles.size(); ++t) {
      text += "facet\n";
      for (const std::uint32_t v : ball.triangles[t]) {
        const Vec3& p = ball.vertices[v];
        const double noise = 1e-6 * static_cast<double>(count++ % 7);
        text += fmt::format("vertex {:.7f} {:.7f} {:.7f}\n", p.x + shift + noise, p.y, p.z);
      }
      text += "endfacet\n";
    }
  }
  write_file(path("two.stl"), text + "endsolid\n");
  const auto make = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"from-mesh", path("two.stl"), "--unit", "mm",
                                       "--voxel",   "0.3mm",         "-o",     path("two.h5")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_holds(fault(make({})), "--merge joins them");
  expect_holds(fault(make({"--merge"})), "the surface is open: 3 edges");
  expect_holds(fault(make({"--merge", "0.1um"})), "open");
  expect_holds(fault(make({"--repair"})), "--parts split");
  expect_holds(fault(make({"--merge", "far"})), "far");
  const std::string said = grains(make({"--parts", "split", "--repair"}));
  expect_holds(said, "two.stl: joined ");
  expect_holds(said, "two.stl: closed 1 hole, the longest of 3 edges");
  expect_holds(said, "two.stl: found 2 parts");
  const ShapeLibrary library = load_library(path("two.h5"));
  ASSERT_EQ(library.size(), 2U);
  EXPECT_EQ(library[1].name, "two_2");
  EXPECT_NEAR(library[1].mass.volume / library[0].mass.volume, 1, 1e-5);
}

TEST_F(GrainsCommand, LibrariesRecordTheirCommandAndTheirSources) {
  write_stl(path("a pebble.stl"), ellipsoid_mesh({3, 2, 2}, 0.4), "pebble");
  const auto make = [&](const std::string& output, std::vector<std::string> more) {
    more.insert(more.begin(), {"from-mesh", path("a pebble.stl"), "--unit", "mm", "--voxel",
                               "0.4mm", "-o", path(output)});
    grains(more);
    return LibrarySource{path(output)}.provenance();
  };
  const Provenance made = make("one.h5", {});
  const std::vector<std::string> words{"reckon", "grains", "from-mesh", path("a pebble.stl"),
                                       "--unit", "mm",     "--voxel",   "0.4mm"};
  EXPECT_EQ(made.command, words);
  EXPECT_TRUE(made.program.starts_with("reckon 0.")) << made.program;
  const std::string bytes = read_file(path("a pebble.stl"));
  XxHash64 hash;
  hash.update(bytes);
  ASSERT_EQ(made.sources.size(), 1U);
  EXPECT_EQ(made.sources[0].path, path("a pebble.stl"));
  EXPECT_EQ(made.sources[0].bytes, bytes.size());
  EXPECT_EQ(made.sources[0].xxh64, hash.digest());
  // Neither the library's own name nor the threads change a byte of it.
  (void)make("two.h5", {"--threads", "1"});
  EXPECT_TRUE(read_file(path("one.h5")) == read_file(path("two.h5")));

  const std::string info = grains({"info", path("one.h5")});
  expect_holds(info, "made by    " + made.program);
  expect_holds(info, "command    reckon grains from-mesh '" + path("a pebble.stl") + "' --unit mm");
  expect_holds(info, fmt::format("{} bytes, xxh64 {:016x}", bytes.size(), hash.digest()));
  expect_holds(grains({"info", path("one.h5"), "--json"}),
               fmt::format("\"xxh64\": \"{:016x}\"", hash.digest()));

  grains({"spheres", path("one.h5"), "-o", path("balls.h5")});
  const Provenance balls = LibrarySource{path("balls.h5")}.provenance();
  ASSERT_EQ(balls.sources.size(), 1U);
  EXPECT_EQ(balls.sources[0].bytes, std::filesystem::file_size(path("one.h5")));
}

TEST_F(GrainsCommand, HarmonicsAreCutOffByOptionOrTable) {
  // A sphere of radius 2 with a bump of degree 2, which the cut removes.
  write_file(path("ball.dat"), "0 0 7.0898154 0\n1 0 0 0\n1 1 0 0\n2 0 1.5 0\n2 1 0 0\n2 2 0 0\n");
  write_file(path("table.txt"), "Name Nnn\nball.dat 1\n");
  const auto flatness = [&](const std::vector<std::string>& cut) {
    std::vector<std::string> arguments{
        "from-harmonics", path("ball.dat"), "--unit", "mm", "--voxels-per-diameter", "10", "-o",
        path("ball.h5")};
    arguments.insert(arguments.end(), cut.begin(), cut.end());
    grains(arguments);
    const Shape shape = load_library(path("ball.h5")).at(0);
    return shape.descriptors.thickness / shape.descriptors.length;
  };
  EXPECT_LT(flatness({}), 0.8);
  EXPECT_NEAR(flatness({"--degree", "1"}), 1, 1e-3);
  EXPECT_NEAR(flatness({"--degree-table", path("table.txt")}), 1, 1e-3);
  write_file(path("table.txt"), "Name Nnn\nother.dat 1\n");
  expect_holds(fault({"from-harmonics", path("ball.dat"), "--unit", "mm", "--degree-table",
                      path("table.txt"), "-o", path("no.h5")}),
               "has no line for");
}

TEST_F(GrainsCommand, LegacyFilesThereAndBack) {
  grains({"solid", "--box", "2m,3m,4m", "--voxel", "0.25m", "--nodes", "40", "-o", path("a.h5")});
  grains({"to-legacy", path("a.h5"), path("legacy")});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "legacy" / "morph_1.dat"));
  grains({"from-legacy", path("legacy"), "--voxel", "0.25m", "-o", path("b.h5")});
  const Shape before = load_library(path("a.h5")).at(0);
  const Shape after = load_library(path("b.h5")).at(0);
  EXPECT_EQ(after.name, "morph_1");
  EXPECT_DOUBLE_EQ(after.mass.volume, before.mass.volume);
  EXPECT_EQ(after.level_set.values, before.level_set.values);
  EXPECT_EQ(after.nodes.x, before.nodes.x);
  EXPECT_NEAR(after.bounding_radius, before.bounding_radius, 1e-9);
}

TEST_F(GrainsCommand, InfoAndExport) {
  grains({"solid", "--sphere", "1mm", "--box", "1mm,1mm,2mm", "--voxels-per-diameter", "12",
          "--nodes", "50", "-o", path("a.h5")});
  const std::string table = grains({"info", path("a.h5")});
  expect_holds(table, "sphere");
  expect_holds(table, "checksums good");
  const std::string json = grains({"info", path("a.h5"), "--json", "--shape", "box"});
  expect_holds(json, "\"name\": \"box\"");
  expect_holds(json, "\"nodes\": 50");
  EXPECT_EQ(json.find("\"name\": \"sphere\""), std::string::npos);
  grains({"export", path("a.h5"), "--out", path("vtp")});
  grains({"export", path("a.h5"), "--out", path("stl"), "--format", "stl", "--shape", "box"});
  for (const char* name :
       {"vtp/sphere.vtp", "vtp/sphere_nodes.vtp", "vtp/box.vtp", "stl/box.stl"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "stl" / "sphere.stl"));
}

TEST_F(GrainsCommand, ScansThereAndBack) {
  grains({"solid", "--ellipsoid", "0.6mm,0.5mm,0.4mm", "--voxels-per-diameter", "14", "--nodes",
          "80", "-o", path("a.h5")});
  write_file(path("poses.csv"), "0,0,0,0,1,0,0,0\n0,1.3e-3,0,0,0.6,0,0.8,0\n");
  write_file(path("scene.toml"),
             "[material]\ndensity = 2650\nfriction = 0.5\n[contact]\nlaw = \"area\"\n"
             "normal_stiffness = \"1 GN/m^3\"\n[[grains]]\nlibrary = \"a.h5\"\n"
             "table = { file = \"poses.csv\" }\n[time]\nsteps = 1\n");
  grains({"scan", path("scene.toml"), "--voxel", "60um", "--format", "npy", "--out", path("scan")});
  for (const char* name : {"volume.npy", "labels.h5", "library.h5", "placement.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "scan" / name)) << name;
  }
  expect_holds(grains({"statistics", path("scan/library.h5"), "-o", path("a.csv")}), "roundness");
  expect_holds(read_file(path("a.csv")), "ellipsoid,");
  grains({"statistics", path("scan/library.h5"), "-o", path("a.csv")});  // replaces its own
  expect_holds(fault({"statistics", path("scan/library.h5"), "-o", path("scene.toml")}),
               "no table of shapes");
  const std::vector<std::string> back{
      "from-scan", path("scan/volume.npy"), "--voxel", "60um", "--out", path("back"), "--truth",
      path("scan")};
  if (!has_ct_component()) {
    expect_holds(fault(back), "libinsighttoolkit5-dev");
    return;
  }
  expect_holds(grains(back), "2 of 2 grains found once");
  for (const char* name : {"library.h5", "placement.csv", "quality.csv", "contacts.csv",
                           "relax.toml", "report.json", "slice-grains.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "back" / name)) << name;
  }
  EXPECT_EQ(load_library(path("back/library.h5")).size(), 2U);
  expect_holds(fault({"from-scan", path("scan/volume.npy"), "--voxel", "60um", "--out",
                      path("none"), "--threshold", "1e9"}),
               "no grains were found");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none" / "library.h5"));
}

TEST_F(GrainsCommand, FaultsSayWhatToDo) {
  const std::string out = path("out.h5");
  expect_holds(fault({"solid", "--sphere", "1", "-o", out}), "has no unit");
  expect_holds(fault({"solid", "--sphere", "2s", "-o", out}), "not a length");
  expect_holds(fault({"solid", "--sphere=-2mm", "-o", out}), "above zero");
  expect_holds(fault({"solid", "--box", "1mm,2mm", "-o", out}), "3 are needed");
  expect_holds(fault({"solid", "-o", out}), "no solid is given");
  expect_holds(fault({"solid", "--sphere", "1mm"}), "--output");
  expect_holds(fault({"solid", "--sphere", "1mm", "-o", path("no/out.h5")}), "does not exist");
  expect_holds(fault({"solid", "--sphere", "1mm", "--voxels-per-diameter", "3", "-o", out}), "10");
  expect_holds(fault({"from-mesh", path("missing.stl"), "--unit", "mm", "-o", out}), "missing.stl");
  write_file(path("bad.stl"), "solid bad\nendsolid\n");
  expect_holds(fault({"from-mesh", path("bad.stl"), "--unit", "mm", "-o", out}), "bad.stl");
  expect_holds(fault({"from-mesh", path("bad.stl"), "--unit", "kg", "-o", out}), "unit of length");
  expect_holds(fault({"generate", "--count", "1", "--roundness", "3", "-o", out}), "roundness");
  expect_holds(fault({"info", path("bad.stl")}), "not a shape library");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(GrainsCommand, SpheresHaveTheNamesAndVolumesOfTheGrains) {
  (void)grains({"generate", "--count", "3", "--seed", "2", "--d50", "1mm", "-o", path("sand.h5")});
  (void)grains({"spheres", path("sand.h5"), "-o", path("spheres.h5")});
  const ShapeLibrary sand = load_library(path("sand.h5"));
  const ShapeLibrary spheres = load_library(path("spheres.h5"));
  ASSERT_EQ(spheres.size(), sand.size());
  for (std::size_t n = 0; n < sand.size(); ++n) {
    EXPECT_EQ(spheres[n].name, sand[n].name);
    EXPECT_NEAR(spheres[n].mass.volume / sand[n].mass.volume, 1, 2e-3);
    const Vec3& inertia = spheres[n].mass.inertia;
    EXPECT_NEAR(inertia.x / inertia.z, 1, 1e-2);
    EXPECT_LT(spheres[n].bounding_radius, sand[n].bounding_radius);
  }
}

}  // namespace
}  // namespace reckon::app
