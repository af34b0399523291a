// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
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
    HistoryFile file{path_, quantities_of({walls})};
    const Measurement measured = measurement_at(3);
    file.append({.measurement = measured, .energy_at_start = 0.25});
  }
  const HistoryTable table = read_history(path_);
  ASSERT_EQ(table.rows.size(), 1U);
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
    HistoryFile file{path_, quantities_of({walls})};
    for (const std::uint64_t step : {0U, 10U, 20U, 30U}) {
      const Measurement measured = measurement_at(step);
      file.append({.measurement = measured});
    }
  }
  const std::string whole = read_file(path_);
  std::ofstream{path_, std::ios::app} << "40,4.0,0.33";  // a row cut short by a power failure
  {
    HistoryFile file{path_, quantities_of({walls}), [](std::uint64_t step) { return step <= 20; }};
    const Measurement measured = measurement_at(30);
    file.append({.measurement = measured});
  }
  EXPECT_EQ(read_file(path_), whole);
}

TEST_F(HistoryTest, RefusesAnotherHeaderAndRaggedRows) {
  { HistoryFile file{path_, quantities_of({walls})}; }
  const auto all = [](std::uint64_t) { return true; };
  EXPECT_THROW((HistoryFile{path_, quantities_of({std::span{walls}.first(1)}), all}), Error);
  std::ofstream{path_, std::ios::app} << "1,2\n";
  EXPECT_THROW((void)read_history(path_), Error);
}

/// What is said of a history with this header.
std::string refusal_of(const std::string& header) {
  HistoryTable table;
  for (std::size_t begin = 0; begin <= header.size();) {
    const std::size_t end = std::min(header.find(',', begin), header.size());
    table.header.push_back(header.substr(begin, end - begin));
    begin = end + 1;
  }
  try {
    require_columns("run/history.csv", table, quantity_groups(walls));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(HistoryHeader, AColumnOfAnotherNameIsNamed) {
  const std::string good = history_header(quantities_of({walls, false, false, false, true, true}));
  const auto with = [&](const std::string& name, const std::string& other) {
    std::string header = good;
    const std::size_t at = header.find(',' + name + ',');
    EXPECT_NE(at, std::string::npos) << name;
    return header.replace(at + 1, name.size(), other);
  };
  EXPECT_EQ(refusal_of(good), "");
  EXPECT_EQ(refusal_of(good + ",my_column"), "");  // a user's own
  EXPECT_EQ(refusal_of("step,time_s"), "");        // a run of an earlier version may have less
  const auto says = [](const std::string& refusal, const std::string& part) {
    EXPECT_NE(refusal.find("run/history.csv: " + part), std::string::npos) << refusal;
  };
  says(refusal_of(with("strain_x", "strain_X")), R"(has no column "strain_x", but one "strain_X")");
  says(refusal_of(with("floor:fx_N", "floor_fx")), R"(has no column "floor:fx_N", but one)");
  says(refusal_of(with("strain_x", "strain_y")), R"(has two columns "strain_y")");
  says(refusal_of("schritt," + good.substr(5)), R"(has no column "step")");
}

TEST_F(HistoryTest, AByteOrderMarkIsNoPartOfAName) {
  std::ofstream{path_} << "\xef\xbb\xbfstep,time_s\n0,0\n";
  EXPECT_EQ(read_history(path_).header.front(), "step");
}

/// Everything that a run may measure.
const HistoryLayout everything{walls, true, true, true, true, true};

TEST(Quantities, EachHasAsManyNumbersAsColumns) {
  Measurement measurement = measurement_at(3);
  const SampleMeasurement sample;
  const CellState cell;
  const HistoryRow row{.measurement = measurement, .cell = &cell, .stage = 1, .sample = &sample};
  std::set<std::string> names;
  std::size_t columns = 0;
  for (const HistoryQuantity& quantity : quantities_of(everything)) {
    EXPECT_EQ(quantity.numbers(row).size(), quantity.columns().size()) << quantity.name;
    EXPECT_FALSE(quantity.meaning.empty()) << quantity.name;
    for (const std::string& column : quantity.columns()) names.insert(column);
    columns += quantity.columns().size();
  }
  EXPECT_EQ(names.size(), columns) << "two quantities have one name";
}

/// Header, rows, reference page and JSON all have a quantity that is added to the table, and
/// nothing else needs a change for it.
TEST(Quantities, OneEntryIsAllThatAQuantityNeeds) {
  std::vector<QuantityGroup> groups = quantity_groups(walls);
  groups[0].quantities.push_back(
      {{"porosity", "mm^2", "a new quantity", {"_x", "_y"}}, [](const HistoryRow& row) {
         return std::vector<Number>{row.measurement.contacts, 0.5};
       }});
  const std::vector<HistoryQuantity>& quantities = groups[0].quantities;
  EXPECT_TRUE(history_header(quantities).ends_with(",porosity_x_mm2,porosity_y_mm2"));
  const Measurement measurement = measurement_at(3);
  EXPECT_TRUE(history_row(quantities, {.measurement = measurement}).ends_with(",12,0.5"));
  const std::string page = history_reference_markdown(groups);
  EXPECT_NE(page.find("| `porosity_x_mm2` | mm^2 | a new quantity |\n"), std::string::npos);
  EXPECT_NE(page.find("| `porosity_y_mm2` | mm^2 | a new quantity |\n"), std::string::npos);
  JsonWriter json;
  json.begin_object();
  write_measured(json, measured(quantities, {.measurement = measurement}));
  json.end();
  EXPECT_NE(json.text().find("\"porosity_x_mm2\": 12,\n"), std::string::npos) << json.text();
  EXPECT_NE(json.text().find("\"porosity_y_mm2\": 0.5"), std::string::npos) << json.text();
}

/// Whatever a run writes can be looked up.
TEST(HistoryReference, HasEveryColumnThatARunMayHave) {
  const std::string page = read_file(RECKON_SOURCE_DIR "/docs/reference/history.md");
  std::string header = history_header(quantities_of(everything)) + ',';
  for (std::size_t end = header.find(','); end != std::string::npos; end = header.find(',')) {
    std::string column = header.substr(0, end);
    header.erase(0, end + 1);
    for (const Wall& wall : walls) {
      if (column.starts_with(wall.name + ':')) column.replace(0, wall.name.size(), "WALL");
    }
    EXPECT_NE(page.find("| `" + column + "` |"), std::string::npos) << column;
  }
}

TEST(HistoryReference, ThePrintedReferenceIsTheCommittedPage) {
  EXPECT_EQ(read_file(RECKON_SOURCE_DIR "/docs/reference/history.md"), history_reference_markdown())
      << "run: reckon reference history > docs/reference/history.md";
}

}  // namespace
}  // namespace reckon
