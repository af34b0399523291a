// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/library_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "expect_error.hpp"
#include "grids.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

const ShapeLibrary& example() {
  static const ShapeLibrary library = [] {
    const ShapeResolution coarse{.voxels_per_diameter = 12, .node_count = 50};
    return ShapeLibrary{build_shape(geodesic_sphere(4), coarse, "ball"),
                        build_shape(test::cube(), coarse, "cube"),
                        build_shape(test::stretched(geodesic_sphere(4), {1, 2, 3}),
                                    {.voxels_per_diameter = 14, .node_count = 33}, "egg")};
  }();
  return library;
}

class LibraryFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path{::testing::TempDir()} /
        (std::string{"library_"} + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "shapes.h5";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  std::filesystem::path file_;
};

void expect_equal(const Shape& a, const Shape& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.level_set.dims, b.level_set.dims);
  EXPECT_EQ(a.level_set.spacing, b.level_set.spacing);
  EXPECT_EQ(a.level_set.origin_body, b.level_set.origin_body);
  EXPECT_EQ(a.level_set.values, b.level_set.values);
  EXPECT_EQ(a.nodes.x, b.nodes.x);
  EXPECT_EQ(a.nodes.y, b.nodes.y);
  EXPECT_EQ(a.nodes.z, b.nodes.z);
  EXPECT_EQ(a.nodes.area, b.nodes.area);
  EXPECT_EQ(a.mass.volume, b.mass.volume);
  EXPECT_EQ(a.mass.inertia, b.mass.inertia);
  EXPECT_EQ(a.bounding_radius, b.bounding_radius);
  EXPECT_EQ(a.lipschitz, b.lipschitz);
  EXPECT_EQ(a.descriptors.length, b.descriptors.length);
  EXPECT_EQ(a.descriptors.surface_area, b.descriptors.surface_area);
  EXPECT_EQ(a.descriptors.roundness, b.descriptors.roundness);
  EXPECT_EQ(a.descriptors.convexity, b.descriptors.convexity);
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  for (std::size_t c = 0; c < a.clusters.size(); ++c) {
    EXPECT_EQ(a.clusters[c].center_body, b.clusters[c].center_body);
    EXPECT_EQ(a.clusters[c].radius, b.clusters[c].radius);
  }
}

TEST_F(LibraryFile, EveryBitComesBack) {
  save_library(file_, example());
  const ShapeLibrary loaded = load_library(file_);
  ASSERT_EQ(loaded.size(), example().size());
  for (std::size_t s = 0; s < loaded.size(); ++s) expect_equal(loaded[s], example()[s]);
  EXPECT_EQ(find_shape(loaded, "egg").name, "egg");
  test::expect_error([&] { (void)find_shape(loaded, "spoon"); }, {"spoon", "3 shapes"});
}

TEST_F(LibraryFile, ProvenanceComesBack) {
  const std::vector<std::string> command{"reckon",  "grains", "from-mesh",
                                         "a b.stl", "--unit", "mm"};
  save_library(file_, example(), {"", command, {{"a b.stl", 684, 0xfedcba9876543210}}});
  const Provenance made = LibrarySource{file_}.provenance();
  EXPECT_TRUE(made.program.starts_with("reckon ")) << made.program;
  EXPECT_EQ(made.command, command);
  ASSERT_EQ(made.sources.size(), 1U);
  EXPECT_EQ(made.sources[0].path, "a b.stl");
  EXPECT_EQ(made.sources[0].bytes, 684U);
  EXPECT_EQ(made.sources[0].xxh64, 0xfedcba9876543210);
  save_library(file_, example());
  EXPECT_TRUE(LibrarySource{file_}.provenance().command.empty());
}

TEST_F(LibraryFile, SourcesAreHashedOneByOneOrByTheFolder) {
  write_file(folder_ / "abc.txt", "abc");
  write_file(folder_ / "none.txt", "");
  const auto files = source_files(folder_);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].path, (folder_ / "abc.txt").string());
  EXPECT_EQ(files[0].bytes, 3U);
  EXPECT_EQ(files[0].xxh64, 0x44bc2cf5ad770999) << "as xxhsum -H1 prints it";
  EXPECT_EQ(files[1].xxh64, 0xef46db3751d8e999);
  test::expect_error([&] { (void)source_files(folder_ / "missing"); }, {"missing", "read"});
}

TEST_F(LibraryFile, AFolderStandsForTheLibraryInIt) {
  save_library(folder_ / "library.h5", example());
  const ShapeLibrary loaded = load_library(folder_);
  ASSERT_EQ(loaded.size(), 3U);
  expect_equal(loaded[2], example()[2]);
  EXPECT_EQ(LibrarySource{folder_}.entry(1).name, example()[1].name);
}

TEST_F(LibraryFile, SomeShapesCanBeLoadedAlone) {
  save_library(file_, example());
  const std::vector<ShapeId> wanted{ShapeId{2}, ShapeId{0}, ShapeId{2}};
  const ShapeLibrary loaded = load_shapes(file_, wanted);
  ASSERT_EQ(loaded.size(), 3U);
  expect_equal(loaded[0], example()[2]);
  expect_equal(loaded[1], example()[0]);
  expect_equal(loaded[2], example()[2]);
  const std::vector<ShapeId> missing{ShapeId{3}};
  test::expect_error([&] { (void)load_shapes(file_, missing); }, {"no shape 3"});
}

TEST_F(LibraryFile, BandsComeBackAsTheyWereRounded) {
  ShapeLibrary bands = example();
  for (Shape& shape : bands) round_to_band(shape);
  save_library(folder_ / "full.h5", example());
  save_library(file_, bands);
  const ShapeLibrary loaded = load_library(file_);
  ASSERT_EQ(loaded.size(), bands.size());
  const LibrarySource source{file_};
  for (std::size_t s = 0; s < loaded.size(); ++s) {
    expect_equal(loaded[s], bands[s]);
    EXPECT_EQ(loaded[s].storage, ShapeStorage::band);
    EXPECT_EQ(source.summary(s).outline.memory(), outline_of(bands[s]).memory());
    EXPECT_EQ(source.summary(s).digest, shape_digest(bands[s]));
  }
  EXPECT_LT(2 * std::filesystem::file_size(file_),
            std::filesystem::file_size(folder_ / "full.h5") + 2 * 20000);
  bands[1] = example()[1];
  test::expect_error([&] { save_library(file_, bands); }, {"stored in another way"});
}

TEST_F(LibraryFile, EqualLibrariesGiveEqualFiles) {
  save_library(file_, example());
  const std::string first = read_file(file_);
  save_library(file_, example());
  EXPECT_EQ(read_file(file_), first);
}

TEST_F(LibraryFile, DigestSeesEveryMechanicalNumberAndNoOther) {
  const Shape& original = example()[0];
  const std::uint64_t digest = shape_digest(original);
  const auto changed = [&](const std::function<void(Shape&)>& change) {
    Shape shape = original;
    change(shape);
    return shape_digest(shape) != digest;
  };
  const auto nudge = [](double& value) { value = std::nextafter(value, 1e9); };
  EXPECT_TRUE(changed([](Shape& s) { s.level_set.values[100] += 1e-6F; }));
  EXPECT_TRUE(changed([](Shape& s) { std::swap(s.level_set.dims[0], ++s.level_set.dims[1]); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.level_set.spacing); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.level_set.origin_body.y); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.nodes.z[7]); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.nodes.area[7]); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.mass.volume); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.mass.inertia.z); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.bounding_radius); }));
  EXPECT_TRUE(changed([&](Shape& s) { nudge(s.lipschitz); }));
  EXPECT_FALSE(changed([](Shape& s) { s.name = "other"; }));
}

TEST_F(LibraryFile, RefusesToSaveWhatCouldNotBeUsed) {
  const auto refused = [&](const std::function<void(Shape&)>& spoil,
                           std::initializer_list<std::string> parts) {
    ShapeLibrary library = example();
    spoil(library[1]);
    test::expect_error([&] { save_library(file_, library); }, parts);
    EXPECT_FALSE(std::filesystem::exists(file_));
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](Shape& s) { s.name = "ball"; }, {"two shapes are named ball"});
  refused([](Shape& s) { s.name = ""; }, {"no name"});
  refused([](Shape& s) { s.level_set.values.pop_back(); }, {"cube", "disagree"});
  refused([](Shape& s) { s.level_set.dims = {1 << 30, 1 << 30, 1 << 30}; }, {"disagree"});
  refused([](Shape& s) { s.level_set.dims[0] = -3; }, {"too few"});
  refused([](Shape& s) { s.level_set.values[3] = std::numeric_limits<float>::infinity(); },
          {"not finite"});
  refused([&](Shape& s) { s.level_set.spacing = nan; }, {"spacing"});
  refused([](Shape& s) { s.level_set.spacing = 1e-300; }, {"spacing"});
  // A band is encoded only after its grid was found good.
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    refused(
        [&](Shape& s) {
          s.storage = ShapeStorage::band;
          s.level_set.values[3] = bad;
        },
        {"not finite"});
  }
  refused(
      [](Shape& s) {
        s.storage = ShapeStorage::band;
        s.level_set.dims[2] += 1;
      },
      {"disagree"});
  refused([](Shape& s) { s.nodes = {}; }, {"no nodes"});
  refused([](Shape& s) { s.nodes.area.pop_back(); }, {"different lengths"});
  refused([&](Shape& s) { s.nodes.x[4] = nan; }, {"node 4"});
  refused([](Shape& s) { s.nodes.area[5] = -1; }, {"node 5"});
  refused([](Shape& s) { s.mass.volume = 0; }, {"must be positive"});
  refused([&](Shape& s) { s.mass.inertia.y = nan; }, {"must be positive"});
  test::expect_error([&] { save_library(file_, {}); }, {"at least one shape"});
  test::expect_error([&] { save_library(folder_ / "no" / "a.h5", example()); }, {"does not exist"});
}

TEST_F(LibraryFile, DamagedAndForeignFilesAreRefused) {
  save_library(file_, example());
  const std::string good = read_file(file_);
  RandomStream random{1, RandomPurpose::other, 0};
  for (int trial = 0; trial < 100; ++trial) {
    std::string bad = good;
    const auto at =
        static_cast<std::size_t>(512 + random.uniform() * static_cast<double>(good.size() - 512));
    if (trial % 2 == 0) {
      bad[at] = static_cast<char>(bad[at] + 1);
    } else {
      bad.resize(at);
    }
    write_file(file_, bad);
    test::expect_error([&] { (void)load_library(file_); }, {"shapes.h5", "damaged"});
  }
  write_file(file_, "solid ascii stl");
  test::expect_error([&] { (void)load_library(file_); }, {"is not a shape library"});
  test::expect_error([&] { (void)load_library(folder_ / "missing.h5"); }, {"cannot be read"});
  test::expect_error([&] { (void)load_library(folder_); }, {"no morphology files"});
}

// Files with a good seal whose datasets do not fit together: each fault is found before use.
TEST_F(LibraryFile, SealedNonsenseIsRefused) {
  struct Fault {
    std::vector<std::int32_t> dims{3, 3, 3};
    std::vector<std::uint64_t> first_value{0, 27};
    std::vector<std::uint64_t> first_node{0, 2};
    std::size_t values{27};
    std::size_t nodes{2};
    std::size_t z_nodes{2};
    double spacing{0.1};
    std::vector<std::string> names{"a"};
    std::vector<LevelSetBand::Word> band{};
  };
  const auto load = [&](const Fault& fault) {
    Hdf5Writer file{file_, {"shape library", fault.band.empty() ? 1U : 3U}};
    file.write_texts("/shape/name", fault.names);
    file.write("/shape/dims", fault.dims, {fault.dims.size() / 3, 3}, "1");
    file.write<std::uint64_t>("/shape/digest", {0}, {1}, "1");
    for (const char* name :
         {"/shape/volume", "/shape/bounding_radius", "/shape/lipschitz", "/descriptor/length",
          "/descriptor/width", "/descriptor/thickness", "/descriptor/surface_area",
          "/descriptor/equivalent_diameter", "/descriptor/elongation", "/descriptor/flatness",
          "/descriptor/sphericity", "/descriptor/convexity", "/descriptor/roundness"}) {
      file.write<double>(name, {1}, {1}, "m");
    }
    file.write<double>("/shape/spacing", {fault.spacing}, {1}, "m");
    file.write<double>("/shape/origin", {0, 0, 0}, {1, 3}, "m");
    file.write<double>("/shape/inertia", {1, 1, 1}, {1, 3}, "m^5");
    file.write("/shape/first_value", fault.first_value, {fault.first_value.size()}, "1");
    file.write("/shape/first_node", fault.first_node, {fault.first_node.size()}, "1");
    if (!fault.band.empty()) {
      file.write("/grid/band", fault.band, {fault.band.size()}, "1");
      file.write<double>("/shape/sphere_radius", {0}, {1}, "m");
      for (const char* name : {"/node/x", "/node/y", "/node/z", "/node/area"}) {
        file.write(name, std::vector<float>(fault.nodes, 1.0F), {fault.nodes}, "m");
      }
      file.finish();
      (void)load_library(file_);
      return;
    }
    file.write("/grid/values", std::vector<float>(fault.values, 1.0F), {fault.values}, "m");
    for (const char* name : {"/node/x", "/node/y", "/node/area"}) {
      file.write(name, std::vector<double>(fault.nodes, 1.0), {fault.nodes}, "m");
    }
    file.write("/node/z", std::vector<double>(fault.z_nodes, 1.0), {fault.z_nodes}, "m");
    file.finish();
    (void)load_library(file_);
  };
  // Without a fault only the digest is wrong.
  test::expect_error([&] { load({}); }, {"digest"});
  test::expect_error([&] { load({.dims = {3, 3, 4}}); }, {"disagree"});
  test::expect_error([&] { load({.dims = {-3, -3, 3}}); }, {"too few"});
  test::expect_error([&] { load({.dims = {1 << 30, 1 << 30, 1 << 30}}); }, {"disagree"});
  EXPECT_THROW(load({.dims = {3, 3, 3, 3, 3, 3}}), Error);
  test::expect_error([&] { load({.first_value = {0, 28}}); }, {"first_value"});
  test::expect_error([&] { load({.first_value = {27, 0}}); }, {"first_value"});
  EXPECT_THROW(load({.first_value = {0, 27, 27}}), Error);
  test::expect_error([&] { load({.first_node = {1, 2}}); }, {"first_node"});
  test::expect_error([&] { load({.first_node = {0, 0}, .nodes = 0, .z_nodes = 0}); }, {"no nodes"});
  test::expect_error([&] { load({.z_nodes = 3}); }, {"/node/z"});
  test::expect_error([&] { load({.spacing = -1}); }, {"spacing"});
  EXPECT_THROW(load({.names = {"a", "b"}}), Error);

  LevelSet grid{{3, 3, 3}, 0.1, {}, std::vector<float>(27, 0.05F)};
  const auto words = encode_band(grid);
  const std::uint64_t count = words.size();
  test::expect_error([&] { load({.first_value = {0, count}, .band = words}); }, {"digest"});
  auto wrong = words;
  wrong[0] = 7;
  test::expect_error([&] { load({.first_value = {0, count}, .band = wrong}); }, {"not a band"});
  for (const std::vector<std::int32_t>& dims : {std::vector<std::int32_t>{3, 3, 4},
                                                {3, 1 << 14, 1 << 14},
                                                {1 << 30, 1 << 30, 1 << 30},
                                                {-3, 3, 3}}) {
    EXPECT_THROW(load({.dims = dims, .first_value = {0, count}, .band = words}), Error);
  }
}

}  // namespace
}  // namespace reckon
