// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "workloads.hpp"

namespace reckon::bench {

struct MeasureOptions {
  int threads{1};
  SimdLevel simd{SimdLevel::automatic};
  bool plain{true};  ///< run the plain engine beside
};

/// Times of one engine.
struct Cost {
  std::uint64_t steps{0};
  double ns_per_grain_step{0};
  PhaseTimes phases;  ///< per grain and step [ns]
};

struct BenchResult {
  std::size_t grains{0};
  Cost near;
  std::optional<Cost> plain;
  double ratio{0};                ///< plain / near
  std::vector<double> ratios;     ///< of each stretch
  bool same_bits{true};           ///< wherever both engines ran the same steps
  std::optional<double> speedup;  ///< over one thread, when there are several
  ContactCounters counters;       ///< of pairs, in the measured steps of the near engine
  ContactCounters wall_counters;
  std::uint64_t list_rebuilds{0};
  double seconds_per_1000_steps{0};
  double contact_bytes_per_grain{0};  ///< lists, pairs and springs of the near engine
  double shape_bytes_per_grain{0};
  double peak_resident_bytes{0};
};

/// Runs a workload with the near engine and, beside it, the plain one, in turns.
///
/// Steady: after each stretch of the near engine the plain one starts from the very state, makes
/// its lists in a first step that is not timed, and runs a few; the near one runs them too, and
/// both must end in the same bits. Whole: both run stretch by stretch from the first step to rest.
///
/// Times are the processor's, so that other programs count little; with several threads they are
/// the clock's. `say` prints the progress.
[[nodiscard]] BenchResult measure(const Workload& work, const MeasureOptions& options,
                                  const std::function<void(const std::string&)>& say);

/// Bytes that a simple loop a = b + s c moves in a second, with all threads [1/s].
[[nodiscard]] double memory_bandwidth();

}  // namespace reckon::bench
