// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// Ranks of one machine read each shape once, hold it once, and all see it:  shapes_test
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "reckon/domain/shape_store.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

int failures = 0;

void expect(bool holds, const Communicator& ranks, const char* what) {
  if (holds) return;
  std::printf("rank %d: %s\n", ranks.rank(), what);
  ++failures;
}

/// Memory of this process that no other process maps [bytes].
std::int64_t private_bytes() {
  std::ifstream file{"/proc/self/smaps_rollup"};
  std::int64_t sum = 0;
  for (std::string word; file >> word;) {
    std::int64_t kilobytes = 0;
    if (word.starts_with("Private_") && file >> kilobytes) sum += kilobytes * 1024;
  }
  return sum;
}

/// A grid of 8 MB in which place and shape show.
Shape large_shape(float mark) {
  Shape shape = testing::sphere(1.0, 100);
  shape.level_set.dims = {128, 128, 128};
  shape.level_set.values.assign(128 * 128 * 128, mark);
  return shape;
}

void test(const Communicator& ranks) {
  constexpr std::uint32_t count = 6;
  std::int64_t reads = 0;
  ShapeStore store{ranks, std::vector<ShapeOutline>(count, outline_of(large_shape(0))),
                   [&](ShapeId id) {
                     ++reads;
                     return large_shape(static_cast<float>(id.get()));
                   }};
  const std::int64_t before = private_bytes();
  // Each rank needs other shapes; no rank needs the last.
  const auto own = static_cast<std::uint32_t>(ranks.rank());
  std::vector<bool> needed(count, false);
  needed[own] = true;
  store.require(needed);
  needed[(own + 1) % 4] = true;
  store.require(needed);
  for (std::uint32_t s = 0; s < count; ++s) {
    if (!needed[s]) continue;
    const auto values = store.views()[s].level_set.values;
    expect(values.size() == 128 * 128 * 128 &&
               std::all_of(values.begin(), values.end(),
                           [s](float value) { return value == static_cast<float>(s); }),
           ranks, "a shape is not what was read");
    expect(store.views()[s].nodes.size() == 100, ranks, "nodes are missing");
  }
  ranks.barrier();
  const std::int64_t grown = private_bytes() - before;
  std::vector<std::int64_t> total{reads, ranks.size() > 1 ? grown : 0};
  ranks.sum(total);
  expect(total[0] == std::min(ranks.size() + 1, 4), ranks, "a shape was read more than once");
  // A copy per rank would be private; what is shared by several processes is not.
  expect(ranks.is_root() || ranks.size() == 1 || grown < 8'000'000, ranks,
         "a rank holds shapes of its own");
  expect(store.resident_shapes() == static_cast<std::uint64_t>(total[0]), ranks,
         "ranks disagree on what is there");
  if (ranks.is_root()) {
    std::printf("%d ranks: %lld shapes of 8 MB read, %.1f MB private to all ranks\n", ranks.size(),
                static_cast<long long>(total[0]), static_cast<double>(total[1]) / 1e6);
  }
}

}  // namespace
}  // namespace reckon

int main(int argc, char** argv) {
  const reckon::ParallelSession session{argc, argv};
  reckon::test(session.world());
  return session.world().any(reckon::failures > 0) ? 1 : 0;
}
