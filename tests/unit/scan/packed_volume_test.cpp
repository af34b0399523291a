// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "../avatar/expect_error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/scan/volume_file.hpp"
#include "reckon/scan/volume_formats.hpp"
#include "support/hdf5_at_exit.hpp"
#include "support/packed_files.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

using test::expect_error;
using testing::Packing;
using testing::TiffLayout;

constexpr VoxelDims dims{70, 50, 12};
constexpr double voxel = 2e-6;

/// Numbers that do not pack to nothing.
GrayVolume volume_of(VoxelType type) {
  GrayVolume volume{dims, voxel};
  for (std::size_t v = 0; v < volume.values.size(); ++v) {
    volume.values[v] = static_cast<float>((v * v + 7 * v) % 249);
    if (type == VoxelType::float32) volume.values[v] += 0.25F;
  }
  return volume;
}

class PackedVolumes : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  /// The volume as files of every kind that is packed.
  std::vector<std::string> write_all(const GrayVolume& volume, VoxelType type) {
    const VolumeOutline what{dims, type, {voxel, 1.0, {}}, {}};
    const std::string numbers = encode_numbers(volume.values, type);
    write_file(path("a.mha"), testing::packed_metaimage(metaimage_header(what), numbers));
    write_file(path("a.nrrd"), testing::packed_nrrd(nrrd_header(what), numbers));
    // The numbers in a file of their own; of several members, as programs that pack in parallel
    // leave them.
    std::string header = testing::packed_metaimage(metaimage_header(what), "");
    header.resize(header.find("LOCAL"));
    write_file(path("b.mhd"), header + "b.zraw\n");
    write_file(path("b.zraw"), testing::packed(numbers.substr(0, 1001), Packing::gzip) +
                                   testing::packed(numbers.substr(1001), Packing::gzip) +
                                   testing::packed("", Packing::gzip));
    TiffLayout layout{.bits = static_cast<int>(8 * size_of(type))};
    if (type == VoxelType::float32) layout.format = SAMPLEFORMAT_IEEEFP;
    const auto write_tiff = [&](const std::string& name) {
      testing::write_tiff(path(name), numbers, 70, 50, layout);
    };
    write_tiff("lzw.tif");
    layout.compression = COMPRESSION_ADOBE_DEFLATE;
    layout.mode = "wb8";  // big-endian, places of 64 bits
    write_tiff("deflate.tif");
    layout.compression = COMPRESSION_PACKBITS;
    layout.mode = "wl";
    layout.tile = 16;
    write_tiff("tiles.tif");
    return {"a.mha", "a.nrrd", "b.mhd", "lzw.tif", "deflate.tif", "tiles.tif"};
  }

  std::filesystem::path folder_{testing::test_path()};
};

TEST_F(PackedVolumes, GiveTheSameBitsAsPlainOnesWholeAndInLayers) {
  for (const VoxelType type :
       {VoxelType::uint8, VoxelType::uint16, VoxelType::uint32, VoxelType::float32}) {
    const GrayVolume volume = volume_of(type);
    for (const std::string& name : write_all(volume, type)) {
      SCOPED_TRACE(name + " " + std::string{name_of(type)});
      const VolumeRequest request{path(name), voxel, {}};
      const StoredVolume whole = read_volume(request);
      EXPECT_EQ(whole.type, type);
      EXPECT_EQ(whole.gray.dims, dims);
      EXPECT_TRUE(whole.gray.values == volume.values);
      for (const std::uint64_t memory : {1U, 40U * 70 * 50 * 5}) {
        const Workspace work{folder_, memory, 0};
        const GrayOnDisk stored = load_volume(request, work).volume;
        EXPECT_TRUE(stored.read(stored.box()).values == volume.values);
      }
      const auto reader = open_volume(request);
      for (const std::int32_t k : {11, 11, 3, 7}) {
        const GrayVolume layer = reader->read_layers(k, 1);
        EXPECT_TRUE(
            std::equal(layer.values.begin(), layer.values.end(), volume.values.begin() + 3500 * k))
            << k;
      }
    }
  }
}

TEST_F(PackedVolumes, TiffRowsAreReadFromTheTopAndNumbersAsTheyAre) {
  const GrayVolume volume = volume_of(VoxelType::uint16);
  const std::string numbers = encode_numbers(volume.values, VoxelType::uint16);
  testing::write_tiff(
      path("a.tif"), numbers, 70, 50,
      {.bits = 16, .meaning = PHOTOMETRIC_MINISWHITE, .orientation = ORIENTATION_BOTLEFT});
  const StoredVolume turned = read_volume({path("a.tif"), voxel, {}});
  for_each_voxel(Box{dims}, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    EXPECT_EQ(turned.gray.values[volume.index(i, dims[1] - 1 - j, k)],
              volume.values[volume.index(i, j, k)]);
  });
}

TEST_F(PackedVolumes, WhatIsCutShortIsRefusedAndLeavesNothing) {
  const auto names = write_all(volume_of(VoxelType::uint16), VoxelType::uint16);
  for (std::string name : names) {
    if (name == "b.mhd") name = "b.zraw";
    const std::string whole = read_file(path(name));
    for (const std::size_t kept : {whole.size() / 2, whole.size() - 1}) {
      SCOPED_TRACE(name + " of " + std::to_string(kept) + " bytes");
      write_file(path(name), whole.substr(0, kept));
      const std::string header = name == "b.zraw" ? "b.mhd" : name;
      expect_error(
          [&] {
            (void)load_volume({path(header), voxel, {}}, {folder_, 1, 0});
          },
          {name, "cut short", "Copy it again"});
    }
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator{folder_},
                          std::filesystem::directory_iterator{}),
            7);
}

TEST_F(PackedVolumes, WhatIsDamagedOrOfAnotherLengthIsRefused) {
  const VolumeOutline what{dims, VoxelType::uint8, {voxel, 1.0, {}}, {}};
  const std::string numbers = encode_numbers(volume_of(VoxelType::uint8).values, what.type);
  const auto expect_refused = [&](const std::string& content,
                                  std::initializer_list<std::string> parts) {
    write_file(path("a.nrrd"), content);
    expect_error([&] { (void)read_volume({path("a.nrrd"), voxel, {}}); }, parts);
  };
  const std::string good = testing::packed_nrrd(nrrd_header(what), numbers);
  std::string bad = good;
  bad[bad.size() - 6] = static_cast<char>(bad[bad.size() - 6] ^ 1);  // in the checksum
  expect_refused(bad, {"a.nrrd", "damaged", "incorrect data check"});
  expect_refused(good + "more", {"a.nrrd", "damaged", "incorrect header check"});
  expect_refused(testing::packed_nrrd(nrrd_header(what), numbers + "more"),
                 {"a.nrrd", "go on behind the 12 layers"});
  expect_refused(testing::packed_nrrd(nrrd_header(what), numbers.substr(0, 3500 * 8)),
                 {"a.nrrd", "end in layer 9 of 12"});
  expect_refused(testing::packed_nrrd(nrrd_header(what), ""),
                 {"a.nrrd", "cut short", "70 x 50 x 12"});
  testing::write_tiff(path("one.tif"), numbers.substr(0, 3500), 70, 50, {});
  expect_error([&] { (void)read_volume({path("one.tif"), voxel, {}}); }, {"one.tif", "one slice"});
  testing::write_tiff(path("mask.tif"), numbers, 70, 50, {.meaning = PHOTOMETRIC_MASK});
  expect_error([&] { (void)read_volume({path("mask.tif"), voxel, {}}); }, {"mask.tif", "colours"});
}

TEST_F(PackedVolumes, FullDiskIsSaidAndLeavesNothing) {
  const GrayVolume volume = volume_of(VoxelType::uint8);
  const auto names = write_all(volume, VoxelType::uint8);
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator{folder_},
                         std::filesystem::directory_iterator{});
  };
  const auto before = files();
  // A limit on the length of files stands for the disk's.
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{20000, limit.rlim_max};
  const auto on_signal = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    expect_error(
        [&] {
          (void)load_volume({path(name), voxel, {}}, {folder_, 1, 0});
        },
        {folder_.string(), "scratch", "ulimit -f"});
  }
  for (const std::string name : {"o.npy", "o.raw", "o.mha", "o.tif", "o.h5"}) {
    SCOPED_TRACE(name);
    expect_error([&] { write_volume(path(name), volume, VoxelType::uint8); }, {name, "ulimit -f"});
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  (void)std::signal(SIGXFSZ, on_signal);
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace reckon
