// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files that claim more than they hold, or that would have other files read.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/seal.hpp"
#include "reckon/scan/volume_file.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

using Extents = std::array<hsize_t, 3>;

class HostileHdf5 : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::test_path();
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "volume.h5";
    write_file(folder_ / "secret", std::string(8 * 8 * 8, 's'));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A file with room for a seal, filled by `fill`.
  static void make(const std::filesystem::path& file, const std::function<void(hid_t)>& fill) {
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, seal_size);
    const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
    fill(id);
    H5Fclose(id);
    H5Pclose(creation);
  }
  static void add(hid_t file, const Extents& extents, const std::function<void(hid_t)>& set) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    set(creation);
    const hid_t space = H5Screate_simple(3, extents.data(), nullptr);
    H5Dclose(H5Dcreate2(file, "v", H5T_STD_U8LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(creation);
  }
  [[nodiscard]] std::string refusal() const {
    try {
      const auto reader = open_volume({file_, 1e-5, "v"});
      (void)reader->read_layers(0, 1);
      return "it was read";
    } catch (const Error& error) {
      return error.what();
    }
  }
  void expect_refused(const std::string& part) const {
    EXPECT_NE(refusal().find(part), std::string::npos) << refusal();
  }

  std::filesystem::path folder_;
  std::filesystem::path file_;
};

TEST_F(HostileHdf5, MoreVoxelsThanTheFileCanHold) {
  make(file_, [](hid_t file) { add(file, {3000, 3000, 3000}, [](hid_t) {}); });
  ASSERT_LT(std::filesystem::file_size(file_), 5000U);
  expect_refused("claims more voxels than the file can hold");
  const Extents chunk{1000, 1000, 1000};
  make(file_, [&](hid_t file) {
    add(file, {3000, 3000, 3000}, [&](hid_t list) { H5Pset_chunk(list, 3, chunk.data()); });
  });
  expect_refused("claims more voxels than the file can hold");
}

TEST_F(HostileHdf5, ExternalStorageReadsOtherFiles) {
  make(file_, [&](hid_t file) {
    add(file, {8, 8, 8},
        [&](hid_t list) { H5Pset_external(list, (folder_ / "secret").c_str(), 0, H5F_UNLIMITED); });
  });
  expect_refused("external storage");
  write_seal(file_, "example", 1, file_);
  const Hdf5Reader sealed{file_, {"example", 1}};
  EXPECT_THROW((void)sealed.extents("v"), Error);
  std::vector<std::uint8_t> values(512);
  EXPECT_THROW(sealed.read_rows<std::uint8_t>("v", 0, values), Error);
}

TEST_F(HostileHdf5, LinksAndVirtualDatasetsReadOtherFiles) {
  const std::filesystem::path other = folder_ / "other.h5";
  make(other, [](hid_t file) { add(file, {8, 8, 8}, [](hid_t) {}); });
  make(file_, [&](hid_t file) {
    H5Lcreate_external(other.c_str(), "v", file, "v", H5P_DEFAULT, H5P_DEFAULT);
  });
  expect_refused("leads to another file");
  make(file_, [&](hid_t file) {
    add(file, {8, 8, 8}, [&](hid_t list) {
      const Extents extents{8, 8, 8};
      const hid_t space = H5Screate_simple(3, extents.data(), nullptr);
      H5Pset_virtual(list, space, other.c_str(), "v", space);
      H5Sclose(space);
    });
  });
  expect_refused("virtual dataset");
}

TEST_F(HostileHdf5, ASealedFileClaimsNoMoreThanItHolds) {
  make(file_, [](hid_t file) { add(file, {3000, 3000, 3000}, [](hid_t) {}); });
  write_seal(file_, "example", 1, file_);
  const Hdf5Reader sealed{file_, {"example", 1}};
  EXPECT_THROW((void)sealed.extents("v"), Error);
}

}  // namespace
}  // namespace reckon
