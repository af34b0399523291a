// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "damage.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <vector>

#include "guard.hpp"

namespace reckon::fuzz {
namespace {

constexpr std::string_view sample = "first = 1.5 # a\nsecond = [2, -3e4]\nthird = \"text\"\n";

TEST(Damage, IsAFunctionOfTheCase) {
  for (std::uint64_t n = 0; n < 200; ++n) {
    RandomStream once{1, RandomPurpose::other, n};
    RandomStream again{1, RandomPurpose::other, n};
    EXPECT_EQ(damaged(sample, once), damaged(sample, again));
  }
}

TEST(Damage, DiffersFromCaseToCase) {
  std::set<std::string> seen;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    RandomStream random{1, RandomPurpose::other, n};
    seen.insert(damaged(sample, random));
  }
  EXPECT_GT(seen.size(), 800U);
}

TEST(Damage, ReachesEveryKindOfFault) {
  bool shorter = false;
  bool longer = false;
  bool huge_number = false;
  bool not_a_number = false;
  bool reordered = false;
  for (std::uint64_t n = 0; n < 4000; ++n) {
    RandomStream random{1, RandomPurpose::other, n};
    const std::string text = damaged(sample, random);
    shorter |= text.size() < sample.size() / 2;
    longer |= text.size() > 4000;
    huge_number |= text.find("1e400") != std::string::npos;
    not_a_number |= text.find("nan") != std::string::npos;
    const auto second = text.find("second");
    reordered |= second != std::string::npos && second < text.find("first");
  }
  EXPECT_TRUE(shorter && longer && huge_number && not_a_number && reordered);
}

TEST(Damage, OfNothingIsHarmless) {
  for (std::uint64_t n = 0; n < 500; ++n) {
    RandomStream random{1, RandomPurpose::other, n};
    EXPECT_LE(damaged("", random).size(), 80000U);
  }
}

TEST(GuardDeathTest, KeepsTheInputThatCrashesOrHangs) {
  const std::string path = testing::TempDir() + "kept_by_guard";
  const auto kept = [&] {
    std::ifstream file{path, std::ios::binary};
    return std::string{std::istreambuf_iterator<char>{file}, {}};
  };
  const auto abort_inside = [&] {
    const std::string input = "the input";
    const Guard guard{path, input, 10};
    std::abort();
  };
  std::filesystem::remove(path);
  EXPECT_DEATH(abort_inside(), "the input is kept in");
  EXPECT_EQ(kept(), "the input");

  const auto hang_inside = [&] {
    const std::string input = "another input";
    const Guard guard{path, input, 1};
    std::atomic<unsigned> turns{0};
    while (true) ++turns;
  };
  std::filesystem::remove(path);
  EXPECT_DEATH(hang_inside(), "took too long");
  EXPECT_EQ(kept(), "another input");
}

}  // namespace
}  // namespace reckon::fuzz
