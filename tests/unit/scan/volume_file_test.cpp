// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/volume_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "../avatar/expect_error.hpp"
#include "reckon/core/file.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

using test::expect_error;

class VolumeFile : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] StoredVolume read(const std::string& name, double voxel = 2e-6) const {
    return read_volume({path(name), voxel, {}});
  }

  std::filesystem::path folder_{testing::test_path()};
};

GrayVolume counted(std::int32_t nx, std::int32_t ny, std::int32_t nz) {
  GrayVolume volume{{nx, ny, nz}, 2e-6};
  for (std::size_t v = 0; v < volume.values.size(); ++v) {
    volume.values[v] = static_cast<float>((7 * v) % 127);
  }
  return volume;
}

TEST_F(VolumeFile, EveryFormatGivesBackWhatWasWritten) {
  const GrayVolume volume = counted(7, 5, 3);
  for (const std::string ending : {"raw", "npy", "h5", "mha", "nrrd", "tif"}) {
    for (const VoxelType type :
         {VoxelType::uint8, VoxelType::int8, VoxelType::uint16, VoxelType::int16, VoxelType::uint32,
          VoxelType::int32, VoxelType::float32, VoxelType::float64}) {
      SCOPED_TRACE(ending + " " + std::string{name_of(type)});
      write_volume(path("volume." + ending), volume, type);
      const StoredVolume back = read("volume." + ending);
      EXPECT_EQ(back.gray.dims, volume.dims);
      EXPECT_EQ(back.gray.values, volume.values);
      EXPECT_EQ(back.gray.voxel, 2e-6);
      EXPECT_EQ(back.type, type);
    }
  }
}

TEST_F(VolumeFile, LayersAreReadAlone) {
  const GrayVolume volume = counted(7, 5, 4);
  std::filesystem::create_directories(path("slices"));
  for (std::int32_t k = 0; k < 4; ++k) {
    GrayVolume slice{{7, 5, 1}, 2e-6};
    std::copy_n(volume.values.begin() + 35 * k, 35, slice.values.begin());
    write_volume(path("slices/" + std::to_string(k) + ".tif"), slice, VoxelType::uint16);
  }
  for (const std::string name : {"a.raw", "a.npy", "a.h5", "a.mha", "a.nrrd", "a.tif", "slices"}) {
    SCOPED_TRACE(name);
    if (name != "slices") write_volume(path(name), volume, VoxelType::uint16);
    const auto reader = open_volume({path(name), 2e-6, {}});
    EXPECT_EQ(reader->outline.dims, volume.dims);
    const GrayVolume layers = reader->read_layers(1, 2);
    EXPECT_EQ(layers.box(), (Box{{0, 0, 1}, {7, 5, 2}}));
    EXPECT_TRUE(std::equal(layers.values.begin(), layers.values.end(), volume.values.begin() + 35));
  }
}

TEST_F(VolumeFile, IsWrittenInPartsAsInOne) {
  const GrayVolume volume = counted(7, 5, 4);
  for (const std::string ending : {"raw", "npy", "h5", "mha", "nrrd", "tif"}) {
    SCOPED_TRACE(ending);
    write_volume(path("whole." + ending), volume, VoxelType::uint16);
    const auto writer =
        create_volume(path("parts." + ending), volume.dims, 2e-6, VoxelType::uint16);
    for (const auto& [first, count] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{3, 1}}) {
      GrayVolume part{Box{{0, 0, first}, {7, 5, count}}, 2e-6};
      std::copy_n(volume.values.begin() + 35 * first, 35 * count, part.values.begin());
      writer->write_layers(part);
      EXPECT_FALSE(std::filesystem::exists(path("parts." + ending)));
    }
    writer->finish();
    EXPECT_TRUE(read("whole." + ending).gray.values == read("parts." + ending).gray.values);
    EXPECT_EQ(read_file(path("whole." + ending)).size(), read_file(path("parts." + ending)).size());
  }
}

TEST_F(VolumeFile, IntegersAreRoundedAndClamped) {
  GrayVolume volume{{4, 1, 1}, 1};
  volume.values = {-3, 0.6F, 254.4F, 1000};
  write_volume(path("a.npy"), volume, VoxelType::uint8);
  EXPECT_EQ(read("a.npy").gray.values, (std::vector<float>{0, 1, 254, 255}));
}

TEST_F(VolumeFile, BigEndianNumbersAreTurned) {
  write_file(path("a.raw"), std::string_view{"\x01\x02\x00\x03", 4});
  write_file(path("a.raw.txt"), "# from the scanner\ndims 2 1 1\ntype uint16\norder big\n");
  EXPECT_EQ(read("a.raw").gray.values, (std::vector<float>{258, 3}));
}

TEST_F(VolumeFile, NrrdTypesHaveSeveralNames) {
  for (const std::string name : {"ushort", "unsigned short", "uint16", "uint16_t"}) {
    write_file(path("a.nrrd"), "NRRD0004\ntype: " + name +
                                   "\ndimension: 3\nsizes: 2 1 1\nendian: big\nencoding: raw\n\n" +
                                   std::string{"\x01\x02\x00\x03", 4});
    EXPECT_EQ(read("a.nrrd").gray.values, (std::vector<float>{258, 3})) << name;
  }
}

TEST_F(VolumeFile, LabelsAreWholeNumbers) {
  EXPECT_EQ(to_labels(counted(3, 1, 1), "labels").values, (std::vector<std::uint32_t>{0, 7, 14}));
  GrayVolume gray{{2, 1, 1}, 1};
  gray.values = {1, 2.5F};
  expect_error([&] { (void)to_labels(gray, "labels.npy"); }, {"labels.npy", "no labels", "2.5"});
  gray.values = {1, -2};
  expect_error([&] { (void)to_labels(gray, "labels.npy"); }, {"no labels"});
}

TEST_F(VolumeFile, WrongVoxelIsFoundWhereTheFileKnowsBetter) {
  write_volume(path("a.h5"), counted(3, 3, 3), VoxelType::uint8);
  EXPECT_NO_THROW((void)read("a.h5", 2e-6));
  expect_error([&] { (void)read("a.h5", 3e-6); }, {"a.h5", "another voxel", "2e-06"});
  write_volume(path("a.mha"), counted(3, 3, 3), VoxelType::uint8);
  expect_error([&] { (void)read("a.mha", 3e-6); }, {"a.mha", "another voxel", "0.002"});
}

TEST_F(VolumeFile, WhatIsCutShortIsRefused) {
  write_volume(path("a.npy"), counted(6, 6, 6), VoxelType::uint16);
  const std::string whole = read_file(path("a.npy"));
  write_file(path("cut.npy"), whole.substr(0, whole.size() - 5));
  expect_error([&] { (void)read("cut.npy"); }, {"cut.npy"});
  write_volume(path("a.h5"), counted(6, 6, 6), VoxelType::uint16);
  write_file(path("cut.h5"), read_file(path("a.h5")).substr(0, 900));
  expect_error([&] { (void)read("cut.h5"); }, {"cut.h5", "HDF5"});
  write_volume(path("a.raw"), counted(6, 6, 6), VoxelType::uint16);
  write_file(path("a.raw"), read_file(path("a.raw")).substr(0, 100));
  expect_error([&] { (void)read("a.raw"); }, {"a.raw", "cut short"});
  write_file(path("lonely.raw"), "abc");
  expect_error([&] { (void)read("lonely.raw"); }, {"lonely.raw.txt"});
  for (const std::string ending : {"mha", "nrrd", "tif"}) {
    write_volume(path("a." + ending), counted(40, 40, 40), VoxelType::uint16);
    const std::string all = read_file(path("a." + ending));
    write_file(path("cut." + ending), all.substr(0, all.size() / 3));
    expect_error([&] { (void)read("cut." + ending); }, {"cut." + ending});
  }
}

TEST_F(VolumeFile, FaultsNameTheFileAndTheCure) {
  expect_error([&] { (void)read("none.npy"); }, {"none.npy", "no such file"});
  write_file(path("a.jpg"), "x");
  expect_error([&] { (void)read("a.jpg"); }, {"a.jpg", "not known"});
  GrayVolume bad = counted(2, 2, 2);
  bad.values[3] = std::numeric_limits<float>::quiet_NaN();
  write_volume(path("nan.npy"), bad, VoxelType::float32);
  expect_error([&] { (void)read("nan.npy"); }, {"not finite", "voxel 3"});
  std::string turned = read_file(path("nan.npy"));
  turned.replace(turned.find("(2, 2, 2)"), 9, "(-2, 2, 2");
  write_file(path("turned.npy"), turned);
  expect_error([&] { (void)read("turned.npy"); }, {"turned.npy", "shape cannot be read", "-2"});
  write_file(path("bad.raw"), "12345678");
  write_file(path("bad.raw.txt"), "dims 2 2 2\ntype colour\n");
  expect_error([&] { (void)read("bad.raw"); }, {"bad.raw.txt", "colour", "uint8"});
}

TEST_F(VolumeFile, StacksMustBeOfOneSize) {
  std::filesystem::create_directories(path("stack"));
  expect_error([&] { (void)read("stack"); }, {"no TIFF slices"});
  // A folder's slices have two dimensions; those of one layer are written so.
  write_volume(path("stack/a1.tif"), counted(6, 4, 1), VoxelType::uint8);
  write_volume(path("stack/a2.tif"), counted(6, 4, 1), VoxelType::uint8);
  const StoredVolume stack = read("stack");
  EXPECT_EQ(stack.gray.dims, (std::array<std::int32_t, 3>{6, 4, 2}));
  EXPECT_EQ(stack.gray.values[24], stack.gray.values[0]);
  write_volume(path("stack/a3.tif"), counted(6, 4, 2), VoxelType::uint8);
  expect_error([&] { (void)read("stack"); }, {"a3.tif", "several pages"});
  write_volume(path("stack/a3.tif"), counted(5, 4, 1), VoxelType::uint8);
  expect_error([&] { (void)read("stack"); }, {"a3.tif", "differ"});
}

TEST_F(VolumeFile, NothingIsLeftHalfWritten) {
  const GrayVolume volume = counted(3, 3, 3);
  expect_error([&] { write_volume(path("no/such/a.npy"), volume, VoxelType::uint8); }, {"no/such"});
  write_volume(path("a.npy"), volume, VoxelType::uint8);
  write_volume(path("a.mha"), volume, VoxelType::uint8);
  for (const auto& entry : std::filesystem::directory_iterator{folder_}) {
    EXPECT_TRUE(entry.path().filename().string().starts_with("a.")) << entry.path();
  }
}

}  // namespace
}  // namespace reckon
