// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/pair_list.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

struct Cloud {
  std::vector<GrainId> ids;
  std::vector<Vec3> positions;
  std::vector<double> radii;
};

Cloud random_cloud(std::uint64_t seed, std::size_t count, double width) {
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> place{-width, width};
  std::uniform_real_distribution<double> size{0.3, 1.0};
  Cloud cloud;
  for (std::size_t n = 0; n < count; ++n) {
    cloud.ids.emplace_back(static_cast<std::uint32_t>(n));
    cloud.positions.push_back({place(random), place(random), place(random)});
    cloud.radii.push_back(size(random));
  }
  std::shuffle(cloud.ids.begin(), cloud.ids.end(), random);
  return cloud;
}

void expect_same(const std::vector<Pair>& found, const std::vector<Pair>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t p = 0; p < found.size(); ++p) {
    EXPECT_EQ(found[p].id_a, expected[p].id_a);
    EXPECT_EQ(found[p].id_b, expected[p].id_b);
    EXPECT_EQ(found[p].slot_a, expected[p].slot_a);
    EXPECT_EQ(found[p].slot_b, expected[p].slot_b);
  }
}

TEST(PairList, LinkedBinsMatchBruteForce) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Cloud cloud = random_cloud(seed, 300, 2.0 + static_cast<double>(seed));
    const auto expected =
        find_pairs_brute_force(cloud.ids, cloud.positions, cloud.radii, 0.2, cloud.ids.size());
    ASSERT_FALSE(expected.empty());
    expect_same(find_pairs(cloud.ids, cloud.positions, cloud.radii, 0.2, cloud.ids.size()),
                expected);
  }
}

TEST(PairList, LayersMatchBruteForceForUnequalSizes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Cloud cloud = random_cloud(seed, 500, 8);
    std::mt19937_64 random{seed};
    std::uniform_real_distribution<double> power{-6, 1};
    for (double& radius : cloud.radii) radius = std::exp2(power(random));
    cloud.radii[7] = 0;
    for (const double skin : {0.0, 0.01, 0.5}) {
      expect_same(find_pairs(cloud.ids, cloud.positions, cloud.radii, skin, 400),
                  find_pairs_brute_force(cloud.ids, cloud.positions, cloud.radii, skin, 400));
    }
  }
}

TEST(PairList, GrainsFarAwayNeitherCostNorConfuse) {
  Cloud cloud = random_cloud(3, 200, 4);
  cloud.positions[17] = {1e12, -3e15, 2};
  cloud.positions[18] = {1e12, -3e15, 2.5};
  cloud.positions[19] = {1e300, 0, 0};
  expect_same(
      find_pairs(cloud.ids, cloud.positions, cloud.radii, 0.2, cloud.ids.size()),
      find_pairs_brute_force(cloud.ids, cloud.positions, cloud.radii, 0.2, cloud.ids.size()));
}

TEST(PairList, ThreadsDoNotChangeTheList) {
  const Cloud cloud = random_cloud(5, 2000, 10);
  const int before = thread_count();
  set_thread_count(1);
  const auto one = find_pairs(cloud.ids, cloud.positions, cloud.radii, 0.1, cloud.ids.size());
  set_thread_count(4);
  expect_same(find_pairs(cloud.ids, cloud.positions, cloud.radii, 0.1, cloud.ids.size()), one);
  set_thread_count(before);
}

TEST(PairList, EmptyAndSingle) {
  EXPECT_TRUE(find_pairs({}, {}, {}, 0.1, 0).empty());
  const Cloud one = random_cloud(1, 1, 1);
  EXPECT_TRUE(find_pairs(one.ids, one.positions, one.radii, 0.1, 1).empty());
}

TEST(PairsOfGrain, ListsPartnersByIdAndEachPairTwice) {
  const Cloud cloud = random_cloud(9, 400, 5);
  const auto pairs = find_pairs(cloud.ids, cloud.positions, cloud.radii, 0.3, cloud.ids.size());
  std::vector<std::uint32_t> by_ids(pairs.size());
  std::iota(by_ids.begin(), by_ids.end(), 0U);
  const PairsOfGrain index = index_pairs(pairs, by_ids, cloud.ids.size());
  std::size_t entries = 0;
  for (std::size_t slot = 0; slot < cloud.ids.size(); ++slot) {
    std::uint32_t last_partner = 0;
    bool first = true;
    for (const auto& entry : index.of(slot)) {
      const Pair& pair = pairs[entry.pair];
      EXPECT_EQ(entry.is_a ? pair.id_a : pair.id_b, cloud.ids[slot]);
      const std::uint32_t partner = (entry.is_a ? pair.id_b : pair.id_a).get();
      EXPECT_TRUE(first || partner > last_partner);
      last_partner = partner;
      first = false;
      ++entries;
    }
  }
  EXPECT_EQ(entries, 2 * pairs.size());
}

}  // namespace
}  // namespace reckon
