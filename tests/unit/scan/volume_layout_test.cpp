// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "../avatar/expect_error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/scan/volume_file.hpp"
#include "support/packed_files.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

using test::expect_error;

/// How files lay their volumes out: where the numbers begin, which way axes run, how large voxels
/// are. The volume is 4 x 3 x 2 and holds 0 to 23.
class VolumeLayout : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::vector<float> values(const std::string& name, double voxel = 2e-6) const {
    const StoredVolume volume = read_volume({path(name), voxel, {}});
    EXPECT_EQ(volume.dims, (VoxelDims{4, 3, 2}));
    return volume.gray.values;
  }
  void write(const std::string& name, const std::string& text) const {
    write_file(path(name), text);
  }

  static std::string numbers() {
    std::string bytes;
    for (char n = 0; n < 24; ++n) bytes += n;
    return bytes;
  }
  static std::vector<float> counted() {
    std::vector<float> list;
    for (int n = 0; n < 24; ++n) list.push_back(static_cast<float>(n));
    return list;
  }
  /// As they would be with axes turned round.
  static std::vector<float> counted_mirrored(bool x, bool y, bool z) {
    std::vector<float> list;
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) {
          list.push_back(
              static_cast<float>((x ? 3 - i : i) + 4 * (y ? 2 - j : j) + 12 * (z ? 1 - k : k)));
        }
      }
    }
    return list;
  }
  static std::string nrrd(const std::string& fields) {
    return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n" + fields;
  }
  static std::string meta(const std::string& fields, const std::string& data = "LOCAL") {
    return "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nElementType = MET_UCHAR\n" + fields +
           "ElementDataFile = " + data + "\n";
  }

  std::filesystem::path folder_{testing::test_path()};
};

TEST_F(VolumeLayout, NrrdSaysWhereTheNumbersBegin) {
  write("plain.raw", numbers());
  write("headed.raw", "one\ntwo\nHEAD" + numbers());
  write("0.raw", numbers().substr(0, 12));
  write("1.raw", numbers().substr(12));
  for (const std::string& fields :
       {std::string{"data file: plain.raw"}, std::string{"datafile: plain.raw\n\n"},
        std::string{"byte skip: 12\ndata file: headed.raw\n"},
        std::string{"byteskip: -1\ndata file: headed.raw\n"},
        std::string{"line skip: 2\nbyte skip: 4\ndata file: headed.raw\n"},
        std::string{"data file: LIST\n0.raw\n1.raw\n"}, std::string{"data file: %d.raw 0 1 1\n"},
        "\n" + numbers(),
        std::string{"old min: 0\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\nnumber: 24\n\n"} +
            numbers()}) {
    SCOPED_TRACE(fields);
    write("a.nrrd", nrrd(fields));
    EXPECT_EQ(values("a.nrrd"), counted());
  }
  write("a.nrrd", nrrd("data file: LIST\n0.raw\nplain.raw\n"));
  expect_error([&] { (void)values("a.nrrd"); }, {"plain.raw", "disagree"});
  write("a.nrrd", nrrd("data file: LIST\n0.raw\n1.raw\n0.raw\n"));
  expect_error([&] { (void)values("a.nrrd"); }, {"3 files for 2 layers"});
  write("a.nrrd", nrrd("data file: LIST\n0.raw\nabsent.raw\n"));
  expect_error([&] { (void)values("a.nrrd"); }, {"absent.raw"});
}

TEST_F(VolumeLayout, MetaImageSaysWhereTheNumbersBegin) {
  write("plain.raw", numbers());
  write("headed.raw", "HEAD" + numbers());
  write("01.raw", numbers().substr(0, 12));
  write("02.raw", numbers().substr(12));
  for (const auto& [fields, data] :
       {std::pair{"", "plain.raw"}, std::pair{"HeaderSize = 4\n", "headed.raw"},
        std::pair{"HeaderSize = -1\n", "headed.raw"}, std::pair{"", "LIST\n01.raw\n02.raw"},
        std::pair{"", "%02d.raw 1 2 1"},
        std::pair{"Modality = MET_MOD_CT\nElementMin = 0\nElementMax = 23\nName = sand\n"
                  "ID = 3\nSequenceID = 1 2 3 4\nElementNBits = 8\nOfMyOwn = 7\n",
                  "plain.raw"}}) {
    SCOPED_TRACE(fmt::format("{}{}", fields, data));
    write("a.mhd", meta(fields, data));
    EXPECT_EQ(values("a.mhd"), counted());
  }
  const auto remarks = open_volume({path("a.mhd"), 2e-6, {}})->outline.remarks;
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("OfMyOwn"), std::string::npos);
}

TEST_F(VolumeLayout, AxesThatRunBackwardsAreMirrored) {
  for (const bool x : {false, true}) {
    for (const bool y : {false, true}) {
      for (const bool z : {false, true}) {
        const auto sign = [](bool backwards) { return backwards ? -1 : 1; };
        write("a.nrrd", nrrd(fmt::format("space directions: ({},0,0) (0,{},0) (0,0,{})\n\n",
                                         2 * sign(x), 2 * sign(y), 2 * sign(z))) +
                            numbers());
        EXPECT_EQ(values("a.nrrd"), counted_mirrored(x, y, z));
        write("a.mha", meta(fmt::format("TransformMatrix = {} 0 0 0 {} 0 0 0 {}\n", sign(x),
                                        sign(y), sign(z))) +
                           numbers());
        EXPECT_EQ(values("a.mha"), counted_mirrored(x, y, z));
        const auto reader = open_volume({path("a.mha"), 2e-6, {}});
        const auto layer = reader->read_layers(1, 1).values;
        const auto whole = counted_mirrored(x, y, z);
        EXPECT_TRUE(std::equal(layer.begin(), layer.end(), whole.begin() + 12));
      }
    }
  }
  write("a.nrrd", nrrd("space directions: (0,2,0) (2,0,0) (0,0,2)\n\n") + numbers());
  expect_error([&] { (void)values("a.nrrd"); }, {"space directions turns the axes"});
  write("a.mha", meta("TransformMatrix = 0.8 0.6 0 -0.6 0.8 0 0 0 1\n") + numbers());
  expect_error([&] { (void)values("a.mha"); }, {"TransformMatrix turns the axes"});
}

TEST_F(VolumeLayout, SpacingsMustFitTheGivenVoxel) {
  const auto expect_fit = [&](const std::string& name, const std::string& text,
                              const std::string& field) {
    SCOPED_TRACE(text);
    write(name, text + numbers());
    EXPECT_EQ(values(name, 3e-6), counted());
    expect_error([&] { (void)values(name, 2e-6); }, {name, field, "--voxel"});
  };
  expect_fit("a.nrrd", nrrd("spacings: 3 3 3\n\n"), "spacings");
  expect_fit("a.nrrd", nrrd("space directions: (3,0,0) (0,3,0) (0,0,3)\n\n"), "space directions");
  expect_fit("a.nrrd", nrrd("axis mins: 0 0 0\naxis maxs: 12 9 6\n\n"), "axis maxs");
  expect_fit("a.nrrd", nrrd("spacings: 3 3 3\nunits: \"um\" \"um\" \"um\"\n\n"), "spacings");
  expect_fit("a.mha", meta("ElementSpacing = 0.003 0.003 0.003\n"), "ElementSpacing");
  expect_fit("a.mha", meta("ElementSpacing = 3 3 3\nDistanceUnits = um\n"), "ElementSpacing");
  // With a unit, 1 is a length like any other; without a unit it is unknown.
  write("a.nrrd", nrrd("spacings: 1 1 1\nunits: \"mm\" \"mm\" \"mm\"\n\n") + numbers());
  expect_error([&] { (void)values("a.nrrd"); }, {"spacings", "0.001 m in the file"});
  write("a.nrrd", nrrd("spacings: 1 1 1\n\n") + numbers());
  EXPECT_EQ(values("a.nrrd"), counted());
  EXPECT_EQ(open_volume({path("a.nrrd"), 2e-6, {}})->outline.remarks.size(), 1U);
  write("a.nrrd", nrrd("space directions: (3,0,0) (0,3,0) (0,0,6)\n\n") + numbers());
  expect_error([&] { (void)values("a.nrrd", 3e-6); }, {"not cubes", "space directions"});
}

TEST_F(VolumeLayout, AxesOfLengthOneDoNotCount) {
  const auto write_hdf5 = [&](const std::vector<hsize_t>& extents) {
    const hid_t file = H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    const hid_t data =
        H5Dcreate2(file, "d", H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers().data());
    H5Dclose(data);
    H5Sclose(space);
    H5Fclose(file);
  };
  for (const auto& extents : {std::vector<hsize_t>{2, 3, 4}, std::vector<hsize_t>{2, 3, 4, 1},
                              std::vector<hsize_t>{1, 2, 3, 4}, std::vector<hsize_t>{1, 2, 1, 3, 4},
                              std::vector<hsize_t>{1, 1, 2, 3, 4, 1}}) {
    write_hdf5(extents);
    EXPECT_EQ(values("a.h5"), counted());
    EXPECT_EQ(open_volume({path("a.h5"), 2e-6, {}})->read_layers(1, 1).values[0], 12);
  }
  write_hdf5({2, 3, 2, 2});
  expect_error([&] { (void)values("a.h5"); }, {"a.h5"});
  std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2, 3, 4, 1), }\n";
  write("a.npy", std::string{"\x93NUMPY\x01\x00", 8} + static_cast<char>(header.size()) +
                     std::string{"\0", 1} + header + numbers());
  EXPECT_EQ(values("a.npy"), counted());
  write("a.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 1 4 3 2\nencoding: raw\n"
        "space directions: none (2,0,0) (0,2,0) (0,0,-2)\n\n" +
            numbers());
  EXPECT_EQ(values("a.nrrd"), counted_mirrored(false, false, true));
}

TEST_F(VolumeLayout, ImageJsStacksOfOneDirectoryAreRead) {
  const std::string description = "ImageJ=1.53t\nimages=2\nslices=2\nunit=\\u00B5m\nspacing=3.0\n";
  for (const bool big_endian : {false, true}) {
    write("a.tif", testing::imagej_stack(numbers(), 4, 3, description, 3, big_endian));
    EXPECT_EQ(values("a.tif", 3e-6), counted());
    expect_error([&] { (void)values("a.tif", 2e-6); }, {"ImageJ's description", "--voxel"});
  }
  write("a.tif", testing::imagej_stack(numbers() + "and more", 4, 3, description, 3, false));
  EXPECT_EQ(values("a.tif", 3e-6), counted());
  write("a.tif", testing::imagej_stack(numbers().substr(1), 4, 3, description, 3, false));
  expect_error([&] { (void)values("a.tif", 3e-6); }, {"a.tif", "cut short"});
}

TEST_F(VolumeLayout, DescriptionsOfTiffStacksCount) {
  testing::TiffLayout layout{};
  const auto read = [&](const std::string& description, double pixels_per_unit) {
    layout.description = description;
    layout.pixels_per_unit = pixels_per_unit;
    testing::write_tiff(path("a.tif"), numbers(), 4, 3, layout);
    return values("a.tif", 5e-6);
  };
  EXPECT_EQ(read("ImageJ=1\nimages=2\nslices=2\nspacing=5\nunit=um\n", 0.2), counted());
  expect_error([&] { (void)read("ImageJ=1\nimages=2\nslices=2\nspacing=10\nunit=um\n", 0.2); },
               {"not cubes", "ImageJ", "10"});
  expect_error([&] { (void)read("ImageJ=1\nimages=2\nslices=2\nspacing=2\n", 1); },
               {"not cubes", "ImageJ"});
  expect_error([&] { (void)read("ImageJ=1\nimages=2\nslices=2\nspacing=6\nunit=um\n", 1.0 / 6); },
               {"ImageJ", "--voxel"});
  expect_error([&] { (void)read("ImageJ=1\nimages=4\nchannels=2\nslices=2\n", 1); },
               {"alternate", "2 channels, 2 slices"});
  expect_error(
      [&] {
        (void)read(
            "<OME><Pixels PhysicalSizeX=\"5\" PhysicalSizeY=\"5\" "
            "PhysicalSizeZ=\"9\"/></OME>",
            1);
      },
      {"not cubes", "OME"});
  EXPECT_EQ(read("scanned on a Monday", 72), counted());
}

}  // namespace
}  // namespace reckon
