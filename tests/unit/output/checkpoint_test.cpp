// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/checkpoint.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/seal.hpp"
#include "reckon/results/run_diff.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

/// A state with awkward numbers in every place.
Checkpoint awkward_checkpoint() {
  Checkpoint checkpoint;
  checkpoint.state.step = (std::uint64_t{1} << 53) + 1;
  checkpoint.time_step = 1.0 / 3;
  checkpoint.energy_at_start = -0.0;
  checkpoint.scene = "title = \"é\"\n";
  checkpoint.shape_digests = {std::numeric_limits<std::uint64_t>::max(), 7};
  checkpoint.acceleration_digest = 42;
  double next = 0.1;
  const auto number = [&] { return next = std::fma(next, 1.37, -0.01); };
  const auto vector = [&] { return Vec3{number(), -number(), number()}; };
  for (const std::uint32_t id : {0U, 1U, 4294967295U}) {
    GrainState grain;
    grain.id = GrainId{id};
    grain.shape = ShapeId{id == 1 ? 1U : 0U};
    grain.prescribed = id == 1;
    grain.position = vector();
    grain.orientation = {number(), number(), number(), number()};
    grain.velocity = {-0.0, std::numeric_limits<double>::denorm_min(), 1e308};
    grain.angular_velocity_body = vector();
    grain.angular_increment_body = vector();
    grain.ledger = {number(), number(), number(), number(), number(), number()};
    checkpoint.state.grains.push_back(grain);
  }
  const auto spring = [&](std::uint32_t node, bool b) {
    return NodeSpring{node, b, vector(), vector(), vector().x, vector().z};
  };
  checkpoint.state.pair_springs = {
      {GrainId{0}, GrainId{1}, {spring(3, false), spring(9, false), spring(2, true)}},
      {GrainId{0}, GrainId{4294967295U}, {}, Bond{vector(), vector(), {1, 2, 3, 4}, vector(), 5}},
      {GrainId{1}, GrainId{4294967295U}, {spring(5, true)}, Bond{.radius = number()}}};
  checkpoint.state.broken_bonds = {7, 18446744073709551615U};
  checkpoint.state.wall_springs = {{GrainId{1}, WallId{2}, {spring(8, false)}}};
  checkpoint.state.membrane = {.start = {vector(), vector(), number(), number()},
                               .floor = WallId{1},
                               .lid = WallId{2},
                               .floor_start = vector(),
                               .lid_start = vector(),
                               .nodes = {{vector(), vector(), {number(), 0, number(), 0, number()}},
                                         {vector(), vector(), {}}},
                               .springs = {{1, GrainId{1}, vector(), vector(), number()}},
                               .pressure_before = number(),
                               .volume_at_stage_start = number(),
                               .height_at_stage_start = number()};
  const auto upper = [&] { return UpperMat3{vector(), number(), -number(), number()}; };
  const UpperMat3 edges{{1.0 / 3, 2, 3e300}, number(), number(), -0.0};
  checkpoint.state.cell = {edges, upper(), edges, vector(), vector(), number()};
  return checkpoint;
}

class CheckpointTest : public ::testing::Test {
 protected:
  void SetUp() override { path_ = testing::test_path(); }
  void TearDown() override { std::filesystem::remove(path_); }
  std::filesystem::path path_;
};

TEST_F(CheckpointTest, ReadsBackTheSameBits) {
  const Checkpoint written = awkward_checkpoint();
  write_checkpoint(path_, written);
  const Checkpoint read = read_checkpoint(path_);
  EXPECT_EQ(first_difference(written.state, read.state), std::nullopt);
  EXPECT_EQ(read.state.step, written.state.step);
  EXPECT_EQ(read.state.grains, written.state.grains);
  ASSERT_EQ(read.state.pair_springs.size(), 3U);
  EXPECT_EQ(read.state.pair_springs, written.state.pair_springs);
  EXPECT_EQ(read.state.broken_bonds, written.state.broken_bonds);
  EXPECT_EQ(read.state.wall_springs[0].springs, written.state.wall_springs[0].springs);
  EXPECT_EQ(read.state.membrane, written.state.membrane);
  EXPECT_EQ(read.state.cell, written.state.cell);
  EXPECT_EQ(read.time_step, written.time_step);
  EXPECT_TRUE(std::signbit(read.energy_at_start));
  EXPECT_EQ(read.scene, written.scene);
  EXPECT_EQ(read.shape_digests, written.shape_digests);
  EXPECT_EQ(read.acceleration_digest, written.acceleration_digest);
}

TEST_F(CheckpointTest, OneOfVersion5LacksOnlyTheLastPushOfDashpotsAndTheStiffnessOfSprings) {
  Checkpoint checkpoint = awkward_checkpoint();
  {
    Hdf5Writer file{path_, Hdf5Kind{"checkpoint", 5}};
    file.write<std::uint64_t>("/run/step", {checkpoint.state.step}, {1}, "1");
    file.write<double>("/run/time_step", {checkpoint.time_step}, {1}, "s");
    file.write<double>("/run/energy_at_start", {checkpoint.energy_at_start}, {1}, "J");
    file.write("/run/shape_digest", checkpoint.shape_digests, {2}, "1");
    file.write<std::uint64_t>("/run/acceleration_digest", {42}, {1}, "1");
    file.write<std::uint8_t>("/run/scene", {'x'}, {1}, "UTF-8");
    for (const CheckpointColumn& column : to_columns(checkpoint.state)) {
      if (column.name.ends_with("/dashpot_push")) continue;
      if (!column.name.ends_with("/shear_stiffness")) write_column(file, column);
    }
    file.finish();
  }
  const auto forget = [](std::vector<NodeSpring>& springs) {
    for (NodeSpring& spring : springs) spring.dashpot_push = spring.shear_stiffness = 0;
  };
  for (PairSprings& pair : checkpoint.state.pair_springs) forget(pair.springs);
  for (WallSprings& contact : checkpoint.state.wall_springs) forget(contact.springs);
  for (MembraneSpring& spring : checkpoint.state.membrane.springs) spring.dashpot_push = 0;
  EXPECT_EQ(first_difference(checkpoint.state, read_checkpoint(path_).state), std::nullopt);
}

TEST_F(CheckpointTest, EqualCheckpointsAreEqualFiles) {
  write_checkpoint(path_, awkward_checkpoint());
  const std::string first = read_file(path_);
  write_checkpoint(path_, awkward_checkpoint());
  EXPECT_TRUE(read_file(path_) == first);
}

TEST_F(CheckpointTest, AStateWithoutContactsOrGrains) {
  Checkpoint empty;
  empty.scene = "x";
  empty.shape_digests = {1};
  write_checkpoint(path_, empty);
  const Checkpoint read = read_checkpoint(path_);
  EXPECT_TRUE(read.state.grains.empty());
  EXPECT_TRUE(read.state.pair_springs.empty());
  EXPECT_TRUE(read.state.wall_springs.empty());
}

/// Every dataset in turn claims rows that the file does not have, under a valid seal.
TEST_F(CheckpointTest, RefusesCountsThatTheFileCannotHold) {
  write_checkpoint(path_, awkward_checkpoint());
  const std::string whole = read_file(path_);
  const auto version =
      static_cast<std::uint32_t>(std::stoul(whole.substr(whole.find("version ") + 8)));
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5O_info_t* info, void* to) -> herr_t {
    if (info->type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  const hid_t original = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  H5Ovisit2(original, H5_INDEX_NAME, H5_ITER_INC, collect, &names, H5O_INFO_BASIC);
  H5Fclose(original);
  std::size_t refused = 0;
  for (const std::string& name : names) {
    for (const hsize_t rows : {hsize_t{1} << 33U, hsize_t{1} << 56U}) {
      write_file(path_, whole);
      const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
      const hid_t before = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
      const hid_t type = H5Dget_type(before);
      const hid_t old_space = H5Dget_space(before);
      std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(old_space)));
      H5Sget_simple_extent_dims(old_space, extents.data(), nullptr);
      H5Sclose(old_space);
      H5Dclose(before);
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      extents[0] = rows;
      const hid_t space =
          H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
      H5Dclose(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
      H5Sclose(space);
      H5Tclose(type);
      H5Fclose(file);
      write_seal(path_, "checkpoint", version, path_);
      try {
        (void)read_checkpoint(path_);
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100U);  // all but columns of tables whose first column is empty
}

TEST_F(CheckpointTest, RefusesDamageAnywhere) {
  write_checkpoint(path_, awkward_checkpoint());
  const std::string good = read_file(path_);
  for (std::size_t at = 0; at < good.size(); at += 997) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    write_file(path_, bad);
    EXPECT_THROW((void)read_checkpoint(path_), Error) << "byte " << at;
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{100}, good.size() - 1}) {
    write_file(path_, good.substr(0, length));
    EXPECT_THROW((void)read_checkpoint(path_), Error) << "length " << length;
  }
}

TEST(StateDifference, NamesAOneUlpChange) {
  const SimulationState a = awkward_checkpoint().state;
  SimulationState b = a;
  b.grains[2].velocity.z = std::nextafter(b.grains[2].velocity.z, 0);
  const auto grain = first_difference(a, b);
  ASSERT_TRUE(grain.has_value());
  EXPECT_EQ(grain->what, "/grain/velocity");
  EXPECT_EQ(grain->where, "grain 4294967295, z");
  EXPECT_EQ(grain->ulps, 1U);

  b = a;
  Vec3& force = b.pair_springs[0].springs[2].shear_force;
  force.x = std::nextafter(force.x, 1e300);
  const auto spring = first_difference(a, b);
  ASSERT_TRUE(spring.has_value());
  EXPECT_EQ(spring->what, "/pair_spring/shear_force");
  EXPECT_EQ(spring->where, "pair of grains 0 and 1, node 2, x");

  b = a;
  b.pair_springs[2].bond->radius *= 2;
  const auto bond = first_difference(a, b);
  ASSERT_TRUE(bond.has_value());
  EXPECT_EQ(bond->what, "/bond/radius");
  EXPECT_EQ(bond->where, "bond of grains 1 and 4294967295");

  b = a;
  b.grains[0].velocity.x = 0.0;  // was -0.0
  const auto zero = first_difference(a, b);
  ASSERT_TRUE(zero.has_value());
  EXPECT_EQ(zero->ulps, 0U);

  b = a;
  b.wall_springs.clear();
  const auto rows = first_difference(a, b);
  ASSERT_TRUE(rows.has_value());
  EXPECT_EQ(rows->where, "number of rows");
}

TEST(Ulps, CountsDoublesInBetween) {
  EXPECT_EQ(ulps_between(1.0, std::nextafter(1.0, 2)), 1U);
  EXPECT_EQ(ulps_between(-std::numeric_limits<double>::denorm_min(),
                         std::numeric_limits<double>::denorm_min()),
            2U);
  EXPECT_EQ(ulps_between(0.0, -0.0), 0U);
  EXPECT_EQ(ulps_between(1.0, NAN), std::nullopt);
}

}  // namespace
}  // namespace reckon
