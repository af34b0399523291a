// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "reckon/core/stopwatch.hpp"
#include "reckon/run/run.hpp"

namespace reckon::app {

/// "[####......]  40 %  text", at most as wide as `width`; the bar gives way to the text.
[[nodiscard]] std::string bar_line(double share, std::string_view text, std::size_t width);

/// Shows how far a run is: a bar that redraws itself on a terminal, else a plain line now and then
/// for logs of batch systems.
class ProgressDisplay {
 public:
  /// `may_redraw`: whether standard output, if it is a terminal, is the user's own; mpirun's is
  /// not.
  ProgressDisplay(bool quiet, bool may_redraw);

  void show(const RunProgress& progress);
  /// Clears the bar, so that other lines can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] double rate(const RunProgress& progress, Clock::time_point now);
  void draw_bar(const RunProgress& progress, double steps_per_second);
  void print_line(const RunProgress& progress, double steps_per_second) const;

  bool quiet_;
  bool terminal_;
  bool drawn_{false};
  Clock::time_point last_shown_;
  Clock::time_point rate_since_;
  std::uint64_t rate_from_step_{0};
  double smooth_rate_{0};
  double line_interval_{1};  // grows, so that a log of days stays short [s]
};

/// Shows how many of a known number are done, how fast, and the time left: a bar on standard error
/// where that is a terminal, nothing elsewhere. It is removed at the end.
class CountDisplay {
 public:
  /// `what` is counted, e.g. "grains".
  explicit CountDisplay(std::string what);
  ~CountDisplay();
  CountDisplay(const CountDisplay&) = delete;
  CountDisplay& operator=(const CountDisplay&) = delete;

  void show(std::size_t done, std::size_t total);
  [[nodiscard]] double seconds() const { return since_start_.seconds(); }

 private:
  std::string what_;
  bool terminal_;
  Stopwatch since_start_;
  Stopwatch since_shown_;
};

}  // namespace reckon::app
