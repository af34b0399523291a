// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "expect_error.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/shape_sources.hpp"
#include "reckon/core/file.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// Few faces and waves, so that a grain's mesh is small.
std::vector<ShapeSource> sources(std::uint64_t count) {
  GrainStatistics statistics;
  statistics.highest_degree = 8;
  std::vector<ShapeSource> all;
  for (std::uint64_t n = 0; n < count; ++n) all.push_back(generated_source(statistics, 7, n));
  return all;
}

const ShapeResolution coarse{.voxels_per_diameter = 10, .node_count = 60};

class ThreadCount {
 public:
  explicit ThreadCount(int count) : before_{thread_count()} { set_thread_count(count); }
  ~ThreadCount() { set_thread_count(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

TEST(ShapeThreads, AShapeIsBitIdenticalForAnyThreadCount) {
  std::vector<std::uint64_t> digests;
  for (const int threads : {1, 2, 3, 7}) {
    const ThreadCount set{threads};
    digests.push_back(shape_digest(build_library(sources(1), coarse)[0]));
  }
  for (const std::uint64_t digest : digests) EXPECT_EQ(digest, digests[0]);
}

// With five sources, four threads share them out; eight go inside each.
TEST(ShapeThreads, ALibraryFileIsBitIdenticalForAnyThreadCount) {
  const std::filesystem::path file =
      std::filesystem::path{::testing::TempDir()} / "shape_threads.h5";
  std::vector<std::string> files;
  for (const int threads : {1, 2, 4, 8}) {
    const ThreadCount set{threads};
    save_library(file, build_library(sources(5), coarse));
    files.push_back(read_file(file));
  }
  std::filesystem::remove(file);
  for (const std::string& bytes : files) EXPECT_TRUE(bytes == files[0]);
}

TEST(ShapeThreads, ProgressCountsEveryGrainOnce) {
  const ThreadCount set{3};
  std::vector<std::size_t> seen;
  (void)build_library(sources(5), coarse, [&](std::size_t done) { seen.push_back(done); });
  EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2, 3, 4, 5}));
}

TEST(ShapeThreads, TheFirstSourceAtFaultIsReported) {
  const ThreadCount set{4};
  auto all = sources(6);
  const auto fail = [](const char* text) {
    return [text](const ShapeResolution&) -> TriangleMesh {
      throw Error{{.place = "source", .problem = text, .reason = {}, .fix = "Mend it."}};
    };
  };
  all[2].surface = fail("second");
  all[4].surface = fail("fourth");
  test::expect_error([&] { (void)build_library(all, coarse); }, {"second"});
  all[1].name = all[0].name;
  test::expect_error([&] { (void)build_library(all, coarse); }, {"two grains are named"});
}

}  // namespace
}  // namespace reckon
