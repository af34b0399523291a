// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/history.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

const std::vector<Wall> walls{{.name = "floor", .surface = PlaneSurface{}, .law = LinearLaw{}},
                              {.name = "box.x-", .surface = PlaneSurface{}, .law = LinearLaw{}}};

Measurement measurement_at(std::uint64_t step) {
  Measurement m;
  m.step = step;
  m.time = 0.1 * static_cast<double>(step);
  m.energy.translation = 1.0 / 3;
  m.energy.friction = 2e-300;
  m.contacts = 12;
  m.wall_force = {{1, 2, 3}, {-0.1, 0, 1e22}};
  return m;
}

class HistoryTest : public ::testing::Test {
 protected:
  void SetUp() override { path_ = testing::test_path(); }
  void TearDown() override { std::filesystem::remove(path_); }
  std::filesystem::path path_;
};

TEST_F(HistoryTest, NumbersReadBackAsTheSameBits) {
  {
    HistoryFile file{path_, {walls}};
    const Measurement measured = measurement_at(3);
    file.append({.measurement = measured, .energy_at_start = 0.25});
  }
  const HistoryTable table = read_history(path_);
  ASSERT_EQ(table.rows.size(), 1U);
  ASSERT_EQ(table.header.size(), history_columns({walls}).size());
  const auto cell = [&](const std::string& name) {
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      if (table.header[c] != name) continue;
      const std::string& text = table.rows[0][c];
      double value = 0;
      std::from_chars(text.data(), text.data() + text.size(), value);
      return value;
    }
    ADD_FAILURE() << "no column " << name;
    return 0.0;
  };
  EXPECT_EQ(cell("step"), 3);
  EXPECT_EQ(cell("time_s"), 0.1 * 3.0);
  EXPECT_EQ(cell("translation_J"), 1.0 / 3);
  EXPECT_EQ(cell("friction_J"), 2e-300);
  EXPECT_EQ(cell("balance_error_J"), 1.0 / 3 + 2e-300 - 0.25);
  EXPECT_EQ(cell("contacts"), 12);
  EXPECT_EQ(cell("floor:fz_N"), 3);
  EXPECT_EQ(cell("box.x-:fz_N"), 1e22);
}

TEST_F(HistoryTest, GoesOnFromTheRowsThatAreKept) {
  {
    HistoryFile file{path_, {walls}};
    for (const std::uint64_t step : {0U, 10U, 20U, 30U}) {
      const Measurement measured = measurement_at(step);
      file.append({.measurement = measured});
    }
  }
  const std::string whole = read_file(path_);
  std::ofstream{path_, std::ios::app} << "40,4.0,0.33";  // a row cut short by a power failure
  {
    HistoryFile file{path_, {walls}, [](std::uint64_t step) { return step <= 20; }};
    const Measurement measured = measurement_at(30);
    file.append({.measurement = measured});
  }
  EXPECT_EQ(read_file(path_), whole);
}

TEST_F(HistoryTest, RefusesAnotherHeaderAndRaggedRows) {
  { HistoryFile file{path_, {walls}}; }
  const auto all = [](std::uint64_t) { return true; };
  EXPECT_THROW((HistoryFile{path_, {std::span{walls}.first(1)}, all}), Error);
  std::ofstream{path_, std::ios::app} << "1,2\n";
  EXPECT_THROW((void)read_history(path_), Error);
}

TEST(HistoryReference, ThePrintedReferenceIsTheCommittedPage) {
  EXPECT_EQ(read_file(RECKON_SOURCE_DIR "/docs/reference/history.md"), history_reference_markdown())
      << "run: reckon reference history > docs/reference/history.md";
}

}  // namespace
}  // namespace reckon
