// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/background_writer.hpp"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <vector>

namespace reckon {
namespace {

TEST(BackgroundWriter, DoesJobsInTheirOrder) {
  std::vector<int> done;
  BackgroundWriter writer;
  for (int n = 0; n < 100; ++n) writer.submit([&done, n] { done.push_back(n); });
  writer.finish();
  ASSERT_EQ(done.size(), 100U);
  for (int n = 0; n < 100; ++n) EXPECT_EQ(done[static_cast<std::size_t>(n)], n);
}

TEST(BackgroundWriter, TheCallerGoesOnMeanwhile) {
  std::promise<void> go;
  bool done = false;
  BackgroundWriter writer;
  writer.submit([&] {
    go.get_future().wait();
    done = true;
  });
  EXPECT_FALSE(done);  // would wait for ever if submit did
  go.set_value();
  writer.finish();
  EXPECT_TRUE(done);
}

TEST(BackgroundWriter, WhatAJobThrowsReachesTheCallerAndLaterJobsAreDropped) {
  BackgroundWriter writer;
  bool later = false;
  std::promise<void> go;
  writer.submit([&] {
    go.get_future().wait();
    throw std::runtime_error{"disk full"};
  });
  writer.submit([&] { later = true; });
  go.set_value();
  EXPECT_THROW(writer.finish(), std::runtime_error);
  EXPECT_FALSE(later);
  writer.submit([&] { later = true; });  // the failure has been reported
  writer.finish();
  EXPECT_TRUE(later);
}

TEST(BackgroundWriter, FinishesWhatWasHandedInBeforeItEnds) {
  int done = 0;
  {
    BackgroundWriter writer;
    writer.submit([&] { ++done; });
    writer.submit([&] { ++done; });
  }
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace reckon
