// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_ranks.hpp"

#include <gtest/gtest.h>

#include "reckon/neighbor/pair_list.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"

namespace reckon::bench {
namespace {

const Communicator* world = nullptr;  // all ranks that mpirun started

constexpr DecompositionKind kinds[] = {DecompositionKind::grid, DecompositionKind::balanced};

std::uint64_t pair_count(const Assembly& assembly) {
  std::vector<GrainId> ids;
  for (std::uint32_t n = 0; n < assembly.positions.size(); ++n) ids.emplace_back(n);
  return find_pairs(ids, assembly.positions, assembly.radii, assembly.skin, ids.size()).size();
}

TEST(VirtualRanks, HoldEachGrainOnceAndEachPairOnceOrOnBothItsRanks) {
  for (const Assembly& assembly : {dense_cube(2000), cone_heap(2000), packed_cube(592, 200, 50)}) {
    const std::uint64_t pairs = pair_count(assembly);
    for (const DecompositionKind kind : kinds) {
      for (const int ranks : {1, 2, 7, 64}) {
        std::uint64_t grains = 0;
        std::uint64_t inner = 0;
        std::uint64_t cross = 0;
        for (const RankLoad& load : share_out(assembly, kind, ranks)) {
          grains += load.grains;
          inner += load.pairs - load.cross_pairs;
          cross += load.cross_pairs;
          EXPECT_EQ(load.work, static_cast<double>(load.grains + load.pairs));
        }
        EXPECT_EQ(grains, assembly.positions.size());
        EXPECT_EQ(inner + cross / 2, pairs) << assembly.name << " on " << ranks;
        EXPECT_EQ(cross % 2, 0U);
      }
    }
  }
}

TEST(VirtualRanks, BalancedSharesOutHeapAndCubeEvenlyOnSixtyFourRanks) {
  for (const Assembly& assembly :
       {cone_heap(4096), dense_cube(4096), cone_heap(20000), dense_cube(20000)}) {
    const auto balanced = share_out(assembly, DecompositionKind::balanced, 64);
    const auto grid = share_out(assembly, DecompositionKind::grid, 64);
    EXPECT_LE(summarize(balanced).work_ratio, 1.10) << assembly.name;
    EXPECT_GT(summarize(grid).work_ratio, 1.3) << assembly.name << ": too easy to show anything";
  }
}

TEST(VirtualRanks, MayOutnumberBinsAndGrains) {
  const Assembly few = dense_cube(10);
  for (const DecompositionKind kind : kinds) {
    const LoadSummary load = summarize(share_out(few, kind, 64));
    EXPECT_EQ(load.pairs, pair_count(few));
    EXPECT_GE(load.idle_ranks, 54U);
  }
}

/// A cube of equal grains that rest apart, on real ranks: listed in the first step, then a plain
/// step. What each rank holds and sends must be what was counted for it.
void expect_counted_load(std::uint32_t grains, DecompositionKind kind) {
  const auto shapes = testing::library_of({testing::bumpy_grain(0.5, 100, 12)});
  Assembly assembly = dense_cube(grains);
  assembly.radii.assign(assembly.radii.size(), (*shapes)[0].bounding_radius);
  assembly.reach = 2 * assembly.radii[0] + assembly.skin;
  SimulationSetup setup;
  setup.shapes = shapes;
  setup.density = 1000;
  setup.contact = {LinearLaw{1, 1, 0, 0}, 0, MasterRule::lower_id};
  setup.time_step = 1e-9;
  setup.skin = assembly.skin;
  setup.decomposition = kind;
  SimulationState state;
  for (std::uint32_t n = 0; world->is_root() && n < grains; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.position = assembly.positions[n];
    state.grains.push_back(grain);
  }
  Simulation simulation{setup, state, *world};
  simulation.step();
  simulation.step();
  const std::vector<RankLoad> loads = share_out(assembly, kind, world->size());
  const RankLoad& load = loads[static_cast<std::size_t>(world->rank())];
  const CommunicationCounters& sent = simulation.distribution().counters();
  EXPECT_EQ(load.grains, simulation.grains().size());
  EXPECT_EQ(load.ghosts, simulation.distribution().ghosts().size());
  EXPECT_EQ(load.pairs, simulation.grain_contacts().pairs().size());
  EXPECT_EQ(sent.updates, 1U);
  EXPECT_EQ(load.bytes, sent.update_bytes);
  EXPECT_EQ(load.messages, sent.update_messages);
}

TEST(RealRanks, HoldAndSendWhatWasCounted) {
  for (const DecompositionKind kind : kinds) {
    for (const std::uint32_t grains : {1000U, 2U}) expect_counted_load(grains, kind);
  }
}

}  // namespace
}  // namespace reckon::bench

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const reckon::ParallelSession session{argc, argv};
  reckon::bench::world = &session.world();
  return RUN_ALL_TESTS();
}
