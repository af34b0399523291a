// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "measure.hpp"

namespace reckon::bench {

/// What was measured, and on what.
struct BenchReport {
  std::string workload;
  std::string machine;  ///< processor and instructions, fit for a file name
  std::string revision;
  int threads{1};
  bool small{false};
  ShapeStorage storage{ShapeStorage::full};
  double inertial_number{0};
  double solid_fraction{0};
  std::size_t distinct_shapes{0};
  double paper_seconds{0};
  double bandwidth{0};  ///< see memory_bandwidth [1/s]
  BenchResult result;
};

[[nodiscard]] BenchReport make_report(const std::string& name, const WorkloadRequest& request,
                                      const Workload& work, const MeasureOptions& options,
                                      BenchResult result);

/// "amd-epyc-avx512": the processor's name and the widest instructions used.
[[nodiscard]] std::string machine_name(SimdLevel simd);

[[nodiscard]] std::string as_text(const BenchReport& report);
[[nodiscard]] std::string as_json(const BenchReport& report);

}  // namespace reckon::bench
