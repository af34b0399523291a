// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/vtk_xml.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"

namespace reckon {
namespace {

struct Point {
  double x, y, z;
};

class VtkXml : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path{::testing::TempDir()} /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

/// The block that a DataArray's offset attribute points at, decoded as T.
template <class T>
std::vector<T> appended_array(const std::string& file, const std::string& name) {
  const std::size_t element = file.find("Name=\"" + name + "\"");
  const std::size_t attribute = file.find("offset=\"", element) + 8;
  const std::size_t offset = std::stoul(file.substr(attribute));
  const std::size_t data = file.find("\n_", file.find("<AppendedData")) + 2;
  std::uint64_t length = 0;
  std::memcpy(&length, file.data() + data + offset, sizeof length);
  std::vector<T> values(length / sizeof(T));
  std::memcpy(values.data(), file.data() + data + offset + sizeof length, length);
  return values;
}

TEST_F(VtkXml, EveryArrayIsFoundAtItsOffset) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<float> heat{1, 2, 3, 4};
  const std::vector<std::int32_t> face{7, 8};
  const std::vector<double> time{0.25};
  VtkPolyData data;
  data.points = vtk_array("Points", points);
  data.polygons = {{0, 1, 2, 0, 3, 1}, {3, 6}};
  data.point_data = {vtk_array("heat & <light>", heat)};
  data.cell_data = {vtk_array("face", face)};
  data.field_data = {vtk_array("TimeValue", time)};
  write_vtp(folder_ / "a.vtp", data);

  const std::string file = read_file(folder_ / "a.vtp");
  EXPECT_NE(file.find(R"(NumberOfPoints="4")"), std::string::npos);
  EXPECT_NE(file.find(R"(NumberOfPolys="2")"), std::string::npos);
  EXPECT_EQ(appended_array<double>(file, "Points"),
            (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(appended_array<float>(file, "heat &amp; &lt;light&gt;"), heat);
  EXPECT_EQ(appended_array<std::int32_t>(file, "face"), face);
  EXPECT_EQ(appended_array<double>(file, "TimeValue"), time);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator{folder_}, {}), 1)
      << "a temporary file was left behind";
}

TEST_F(VtkXml, RefusesWhatDoesNotFitTogether) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}};
  const std::vector<float> three{1, 2, 3};
  VtkPolyData data;
  data.points = vtk_array("Points", points);
  data.vertices = consecutive_cells(2, 1);
  write_vtp(folder_ / "good.vtp", data);
  VtkPolyData wrong_length = data;
  wrong_length.point_data = {vtk_array("three", three)};
  EXPECT_THROW(write_vtp(folder_ / "bad.vtp", wrong_length), Error);
  VtkPolyData wrong_point = data;
  wrong_point.lines = {{0, 2}, {2}};
  EXPECT_THROW(write_vtp(folder_ / "bad.vtp", wrong_point), Error);
  EXPECT_THROW((void)vtk_array("three", three, 2), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bad.vtp"));
  EXPECT_THROW(write_vtp(folder_ / "nowhere" / "a.vtp", data), Error);
}

TEST_F(VtkXml, CollectionListsFilesWithTheirTimes) {
  const std::vector<PvdEntry> entries{{0, "a.vtp", "grains"}, {0.1, "b.vtp", "grains"}};
  write_pvd(folder_ / "series.pvd", entries);
  const std::string file = read_file(folder_ / "series.pvd");
  EXPECT_NE(file.find(R"(timestep="0.1" group="" part="grains" file="b.vtp")"), std::string::npos);
}

TEST_F(VtkXml, PendingFileLeavesTheOldFileUntilItIsCommitted) {
  write_file(folder_ / "a", "old");
  {
    PendingFile pending{folder_ / "a"};
    write_file(pending.temporary(), "half");
  }
  EXPECT_EQ(read_file(folder_ / "a"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator{folder_}, {}), 1);
  EXPECT_THROW((void)read_file(folder_ / "missing"), Error);
  EXPECT_THROW((void)read_file(folder_), Error);
}

}  // namespace
}  // namespace reckon
