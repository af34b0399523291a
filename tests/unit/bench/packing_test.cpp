// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "packing.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/test_path.hpp"

namespace reckon::bench {
namespace {

constexpr double time_step = 3e-4;  // [s]
constexpr double skin = 0.1;        // [m]

Packing squeezed(double diameter, const std::string& file) {
  return squeeze(make_shapes({{diameter, 8, 100, 10}}, 2, ShapeStorage::full),
                 {.law = LinearLaw{1e8, 0.9e8, 0, 0}}, 1e5, time_step, skin, file);
}

std::string bytes_of(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

class PackingTest : public ::testing::Test {
 protected:
  ~PackingTest() override { std::filesystem::remove(file_); }

  const std::string file_{testing::test_path().string()};
};

TEST_F(PackingTest, AKeptOneIsReadAgain) {
  const Packing made = squeezed(2, file_);
  const auto written = std::filesystem::last_write_time(file_);
  const Packing read = squeezed(2, file_);
  EXPECT_EQ(read.state.grains, made.state.grains);
  EXPECT_EQ(read.low, made.low);
  EXPECT_EQ(read.high, made.high);
  EXPECT_EQ(read.pressure, made.pressure);
  EXPECT_EQ(std::filesystem::last_write_time(file_), written);
}

TEST_F(PackingTest, OneOfOtherShapesOrCutShortIsMadeAnew) {
  const Packing made = squeezed(2, {});
  (void)squeezed(2.5, file_);
  EXPECT_EQ(squeezed(2, file_).state.grains, made.state.grains);

  const std::string whole = bytes_of(file_);
  std::ofstream{file_, std::ios::binary}.write(whole.data(),
                                               static_cast<std::streamsize>(whole.size() - 8));
  EXPECT_EQ(squeezed(2, file_).state.grains, made.state.grains);
  EXPECT_EQ(bytes_of(file_), whole);
}

}  // namespace
}  // namespace reckon::bench
