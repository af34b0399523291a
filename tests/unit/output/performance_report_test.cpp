// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/performance_report.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace reckon {
namespace {

/// Two ranks on one machine, 10 steps: 30 and 10 grains, 40 and 20 listed pairs, of which each
/// rank shares 8 with the other.
std::array<RankPerformance, 2> two_ranks() {
  std::array<RankPerformance, 2> ranks;
  for (RankPerformance& rank : ranks) {
    rank.steps = 10;
    rank.list_rebuilds = 2;
    rank.shared_pair_steps = 80;
    rank.threads = 1;
    rank.phases.migration = 0.25;
    rank.communication.update_bytes = 1040;
    rank.communication.update_messages = 9;
    rank.communication.migrations = 1;
  }
  ranks[1].rank_on_machine = 1;
  ranks[0].grain_steps = 300;
  ranks[1].grain_steps = 100;
  ranks[0].ghost_steps = 20;
  ranks[1].ghost_steps = 60;
  ranks[0].pair_steps = 400;
  ranks[1].pair_steps = 200;
  ranks[0].work = 700;
  ranks[1].work = 300;
  ranks[0].phases.grain_contacts = 3;
  ranks[1].phases.grain_contacts = 1;
  ranks[0].communication.migrated_grains = 4;
  ranks[1].communication.migrated_grains = 1;
  return ranks;
}

void expect_has(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no " << part << " in\n" << text;
}

TEST(PerformanceReport, SumsAndRatiosOfTheRanks) {
  const auto ranks = two_ranks();
  const std::string json = performance_json({ranks, 40, 8, 0.5, 0.125});
  expect_has(json, "\"ranks\": 2,");
  expect_has(json, "\"machines\": 1,");
  expect_has(json, "\"steps\": 10,");
  expect_has(json, "\"ns_per_grain_step\": 20000000,");  // 8 s / (10 * 40)
  expect_has(json, "\"ghosts_per_grain\": 0.2,");        // 80 / 400
  expect_has(json, "\"listed_pairs_per_grain\": 1.3,");  // (600 - 80) / 400: 80 are on both lists
  expect_has(json, "\"pairs_computed_twice_share\": 0.15384615384615385,");  // 80 / 520
  expect_has(json, "\"update_bytes\": 2080,");
  expect_has(json, "\"update_messages\": 18,");
  expect_has(json, "\"migrations\": 1,");
  expect_has(json, "\"migrated_grains\": 5,");
  expect_has(json, "\"work_imbalance\": 1.4,");        // 700 / 500
  expect_has(json, "\"force_time_imbalance\": 1.5,");  // 3 s / 2 s
  expect_has(json, "\"migrate_s\": 0.25,");
  expect_has(json, "\"background_output_s\": 0.125,");
}

TEST(PerformanceReport, TheTableTellsMeanAndSlowest) {
  const auto ranks = two_ranks();
  const std::string table = performance_table({ranks, 40, 8, 0.5, 0.125});
  expect_has(table, "force           2 s   25.0 %  slowest rank        3 s");
  expect_has(table, "2 ranks of 1 thread on 1 machine: work of the busiest 1.4 times the mean");
  expect_has(table, "15 % of pairs computed twice");
}

TEST(PerformanceReport, OneRankHasNoMessagesToTellOf) {
  const std::array<RankPerformance, 1> one{two_ranks()[0]};
  const std::string table = performance_table({one, 30, 8, 0.5, 0.125});
  EXPECT_EQ(table.find("slowest"), std::string::npos) << table;
  EXPECT_EQ(table.find("ghost"), table.find("ghosts and waiting")) << table;
  EXPECT_EQ(performance_table({{}, 0, 0, 0, 0}), "");
}

}  // namespace
}  // namespace reckon
