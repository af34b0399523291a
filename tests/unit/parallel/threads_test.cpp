// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/parallel/threads.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace reckon {
namespace {

class ThreadLoop : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(before_); }

 private:
  int before_{thread_count()};
};

TEST_P(ThreadLoop, VisitsEveryIndexOnce) {
  for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
    for (const std::size_t chunk : {1U, 3U, 64U}) {
      std::vector<int> visits(count);
      parallel_for(count, chunk, [&](std::size_t k) { ++visits[k]; });
      EXPECT_EQ(visits, std::vector<int>(count, 1)) << count << " indices by " << chunk;
    }
  }
}

TEST_P(ThreadLoop, ThreadIndexStaysBelowThreadCount) {
  std::vector<int> index(500, -1);
  parallel_for(index.size(), 1, [&](std::size_t k) { index[k] = thread_index(); });
  for (const int thread : index) {
    EXPECT_GE(thread, 0);
    EXPECT_LT(thread, GetParam());
  }
}

TEST_P(ThreadLoop, ThrowsTheErrorOfTheLowestIndex) {
  for (int trial = 0; trial < 20; ++trial) {
    std::string caught;
    try {
      parallel_for(200, 1, [](std::size_t k) {
        if (k % 10 == 7) throw std::runtime_error("at " + std::to_string(k));
      });
    } catch (const std::runtime_error& error) {
      caught = error.what();
    }
    EXPECT_EQ(caught, "at 7");
  }
}

TEST_P(ThreadLoop, LargestIsTheLeastWhereNothingIsLarger) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  for (const std::size_t count : {0U, 10U, 100000U}) {
    EXPECT_EQ(parallel_max(count, none, [&](std::size_t) { return none; }), none);
    EXPECT_EQ(parallel_max(count, 3, [&](std::size_t k) { return -static_cast<double>(k); }), 3);
  }
  EXPECT_EQ(parallel_max(100000, 3, [&](std::size_t k) { return k == 70001 ? 4.0 : 1.0; }), 4);
}

TEST(ChunkParts, EveryThreadBeginsWithItsOwnPartAndTakesWhatIsLeft) {
  const int before = thread_count();
  set_thread_count(4);
  const ChunkParts parts{103, 10};  // 11 chunks: parts of 2, 3, 3 and 3
  set_thread_count(before);
  std::array<ChunkParts::Next, ChunkParts::most> next{};
  using Range = std::pair<std::size_t, std::size_t>;
  std::vector<Range> of_third;
  parts.visit(next, 2,
              [&](std::size_t first, std::size_t last) { of_third.emplace_back(first, last); });
  const std::vector<Range> expected{{50, 60}, {60, 70}, {70, 80}, {80, 90}, {90, 100}, {100, 103},
                                    {0, 10},  {10, 20}, {20, 30}, {30, 40}, {40, 50}};
  EXPECT_EQ(of_third, expected);
  parts.visit(next, 0, [](std::size_t, std::size_t) { FAIL() << "all chunks were taken"; });
}

INSTANTIATE_TEST_SUITE_P(Counts, ThreadLoop, testing::Values(1, 2, 4));

}  // namespace
}  // namespace reckon
