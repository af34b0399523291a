// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/run_verdict.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "reckon/output/quantities.hpp"
#include "reckon/run/overlap_forecast.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

/// A stage under servos, then one that is driven, and a sound history of both: twenty rows each.
struct Story {
  struct Row {
    Measurement measurement;
    SampleMeasurement sample;
    std::uint64_t stage{1};
  };
  SceneConfig scene;
  std::vector<Row> rows;

  Story() {
    scene.stages = {{.name = "press", .until = StageGoal{.unbalanced_ratio = 0.01}},
                    {.name = "shear"}};
    scene.output.sample = true;
    scene.stages[1].controls = {{.wall = "box.z", .target = WallTarget::strain_rate, .value = 1}};
    for (std::uint64_t n = 0; n <= 40; ++n) {
      Row row;
      row.measurement.step = 100 * n;
      row.measurement.unbalanced_ratio = 0.005;
      row.measurement.carried_share = 0.95;
      row.measurement.kinetic_ratio = 1e-4;
      row.measurement.overlap_ratio = 0.02;
      row.stage = n <= 20 ? 1 : 2;
      row.sample.enclosed = true;
      row.sample.volume = 1e-6;
      row.sample.void_ratio = 0.6;
      row.sample.axial_strain = n <= 20 ? 0.1 : 0.1 + 0.001 * static_cast<double>(n - 20);
      row.sample.invariants.mean = 1e5;
      row.sample.invariants.friction_angle = 30;
      row.sample.inertial_number = 5e-4;
      rows.push_back(row);
    }
  }

  [[nodiscard]] HistoryTable table() const {
    const auto quantities = quantities_of({.walls = {}, .stages = true, .sample = true});
    const auto cells = [](const std::string& line) {
      std::vector<std::string> found{""};
      for (const char letter : line) {
        if (letter == ',') {
          found.emplace_back();
        } else {
          found.back() += letter;
        }
      }
      return found;
    };
    HistoryTable table{cells(history_header(quantities)), {}};
    for (const Row& row : rows) {
      table.rows.push_back(cells(history_row(
          quantities,
          {.measurement = row.measurement, .stage = row.stage, .sample = &row.sample})));
    }
    return table;
  }
  [[nodiscard]] RunVerdict verdict(const std::string& status = "complete") const {
    return verdict_on({scene, table(), status});
  }
  /// The codes of all reasons, then how many notes.
  [[nodiscard]] std::string codes(const std::string& status = "complete") const {
    std::string list;
    for (const VerdictReason& reason : verdict(status).reasons) list += reason.code + ' ';
    return list;
  }
};

TEST(RunVerdict, ASoundRunIsValid) {
  EXPECT_EQ(Story{}.codes(), "");
  EXPECT_TRUE(Story{}.verdict().valid());
  EXPECT_EQ(verdict_text(Story{}.verdict()), "");
}

TEST(RunVerdict, TooLittleSpaceForTheGrains) {
  Story story;
  story.rows[30].sample.void_ratio = -0.43;
  EXPECT_EQ(story.codes(), "negative_void_ratio ");
  const std::string text = verdict_text(story.verdict());
  EXPECT_TRUE(text.starts_with("THE FIGURES OF THIS RUN MEAN NOTHING:\n")) << text;
  EXPECT_NE(text.find("void ratio -0.430 at step 3000, stage shear"), std::string::npos) << text;
}

TEST(RunVerdict, OverlapBeyondTheLimit) {
  Story story;
  story.rows[40].measurement.overlap_ratio = 0.2;
  EXPECT_EQ(story.codes(), "deep_overlap ");
  const std::string text = verdict_text(story.verdict());
  EXPECT_NE(text.find("20 % of a grain's diameter at step 4000"), std::string::npos) << text;
  EXPECT_NE(text.find("above 5 %"), std::string::npos) << text;
  story.rows[40].measurement.overlap_ratio = 0.02;
  story.rows[3].measurement.overlap_ratio = 0.2;  // grains of a scan that are still relaxed
  EXPECT_EQ(story.codes(), "");
}

TEST(RunVerdict, NodesThatCannotSeeAnOverlapBeyondTheLimit) {
  const Story story;
  const auto verdict = [&](double unseen) {
    return verdict_on({.scene = story.scene,
                       .history = story.table(),
                       .status = "complete",
                       .coarse_nodes = {"nodes lie apart", unseen}});
  };
  ASSERT_EQ(verdict(0.2).reasons.size(), 1U);
  EXPECT_EQ(verdict(0.2).reasons[0].code, "coarse_nodes");
  EXPECT_EQ(verdict(0.2).reasons[0].text, "nodes lie apart");
  EXPECT_TRUE(verdict(0.03).valid());
  EXPECT_EQ(verdict(0.03).notes, std::vector<std::string>{"nodes lie apart"});
}

TEST(RunVerdict, GrainsOutsideAndLost) {
  Story story;
  story.rows[40].measurement.outside = 17;
  EXPECT_EQ(story.codes(), "grains_outside ");
  story.rows[40].measurement.outside = 0;
  story.rows[40].measurement.departed = 2;
  EXPECT_EQ(story.codes(), "grains_lost ");
  story.rows[40].sample.volume = 0;  // a hopper is no sample
  EXPECT_EQ(story.codes(), "");
}

TEST(RunVerdict, ATestThatIsTooFast) {
  Story story;
  for (Story::Row& row : story.rows) row.sample.inertial_number = 0.00104;
  EXPECT_EQ(story.codes(), "too_fast ");
  // Never "0.001, above 0.001".
  const std::string text = verdict_text(story.verdict());
  EXPECT_NE(text.find("inertial number 0.00104, above 0.001"), std::string::npos) << text;
}

TEST(RunVerdict, ARestThatWasAskedForAndNotReached) {
  Story story;
  story.rows[20].measurement.kinetic_ratio = 2;
  EXPECT_EQ(story.codes(), "not_at_rest ");
  story.scene.stages[0].until.reset();
  EXPECT_EQ(story.codes(), "");

  Story fall;
  fall.scene.stages.clear();
  fall.scene.time.stop_at_unbalanced_ratio = 0.01;
  fall.scene.body.gravity = {0, 0, -9.81};
  EXPECT_EQ(fall.codes(), "");
  // One contact of five hundred grains, which carries no force.
  fall.rows.back().measurement.unbalanced_ratio = 0;
  fall.rows.back().measurement.carried_share = 0.002;
  EXPECT_EQ(fall.codes(), "not_at_rest ");
  EXPECT_EQ(fall.codes("running"), "") << "it may yet come to rest";
  // Where no rest was required, a run that ends in mid-fall gets a note and no reason.
  fall.scene.time.stop_at_unbalanced_ratio.reset();
  EXPECT_TRUE(fall.verdict().valid());
  EXPECT_NE(verdict_text(fall.verdict()).find("note: not at rest at step 4000"), std::string::npos);
}

TEST(RunVerdict, AFailureAndAHistoryWithoutTheColumns) {
  Story story;
  story.scene.output.sample = false;
  const HistoryTable old{{"step", "time_s", "stage"}, {{"0", "0", "1"}, {"9", "1", "2"}}};
  EXPECT_TRUE(verdict_on({story.scene, old, "interrupted"}).valid());
  const RunVerdict failed = verdict_on({story.scene, old, "failed", "grain 3: left"});
  ASSERT_FALSE(failed.valid());
  EXPECT_NE(failed.reasons[0].text.find("grain 3: left"), std::string::npos);
}

TEST(RunVerdict, JsonHasAFieldForScripts) {
  Story story;
  story.rows[30].sample.void_ratio = -0.43;
  JsonWriter json;
  json.begin_object();
  write_verdict(json, story.verdict());
  json.end();
  EXPECT_NE(json.text().find("\"valid\": false"), std::string::npos) << json.text();
  EXPECT_NE(json.text().find("\"code\": \"negative_void_ratio\""), std::string::npos);
}

class RuinedSampleTest : public testing::RunSceneTest {
 protected:
  [[nodiscard]] static std::string soft(const char* stiffness = "1e9 N/m^3") {
    return with(staged(), "2e9 N/m^3", stiffness);
  }
  [[nodiscard]] LoadedScene loaded(const std::string& text) const {
    SceneReading reading = read(text);
    return load_scene(reading);
  }
};

/// Grains far too soft for the stress: no friction angle without the warning, anywhere.
TEST_F(RuinedSampleTest, SoftGrainsAreToldByTheRunAndItsFolder) {
  const RunReport report = run(soft(), {.folder = root_ / "run"});
  ASSERT_FALSE(report.verdict.valid());
  bool is_deep = false;
  for (const VerdictReason& reason : report.verdict.reasons) {
    is_deep = is_deep || reason.code == "deep_overlap";
  }
  EXPECT_TRUE(is_deep) << verdict_text(report.verdict);
  EXPECT_GT(report.measured.size(), 10U);
  const RunVerdict later = verdict_of(RunFolder{root_ / "run"});
  EXPECT_EQ(verdict_text(later), verdict_text(report.verdict));
  EXPECT_NE(read_file(root_ / "run/run.json").find("\"valid\": false"), std::string::npos);
}

/// F = pi/4 k d u^2 of two spheres at the force that an average contact has.
TEST_F(RuinedSampleTest, TheOverlapIsForeseen) {
  const LoadedScene scene = loaded(soft());
  const auto forecast = forecast_overlap(scene);
  ASSERT_TRUE(forecast);
  EXPECT_EQ(forecast->stress, 200e3);
  EXPECT_TRUE(forecast->is_too_deep());
  const auto stiffer = forecast_overlap(loaded(soft("1e11 N/m^3")));
  EXPECT_NEAR(stiffer->ratio, 0.1 * forecast->ratio, 1e-12);
  EXPECT_FALSE(forecast_overlap(loaded(soft("3e12 N/m^3")))->is_too_deep());
  // A node's share of the surface turns a law per node into one per area.
  std::string text = with(soft(), "normal_stiffness", "law = 'linear'\nnormal_stiffness");
  text = with(text, "1e9 N/m^3", "10 N/m");
  const auto by_nodes = forecast_overlap(loaded(text));
  double area = 0;
  double nodes = 0;
  for (const GrainState& grain : scene.grains) {
    area += scene.shapes[grain.shape.get()].node_area;
    nodes += static_cast<double>(scene.shapes[grain.shape.get()].outline.nodes);
  }
  EXPECT_NEAR(by_nodes->ratio, forecast->ratio * std::sqrt(1e9 / (10 * nodes / area)), 1e-12);
  // Grains that only fall have their weight.
  const auto weight = forecast_overlap(loaded(scene_text(usual)));
  ASSERT_TRUE(weight);
  EXPECT_TRUE(weight->of_weight);
  EXPECT_FALSE(weight->is_too_deep());
}

}  // namespace
}  // namespace reckon
