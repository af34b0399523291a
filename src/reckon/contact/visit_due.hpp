// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "reckon/parallel/threads.hpp"

namespace reckon {

/// Calls evaluate(k, path_length) for every k with counts(k) that is due: its path_length(k) has
/// reached next_check[k]. Uses all threads.
///
/// The list of those that are due in a stretch is complete before the first is evaluated, so
/// prefetch(k) can run a few ahead. One that is not due costs a sum and a comparison. After each
/// stretch its thread calls finish().
template <class Counts, class PathLength, class Prefetch, class Evaluate, class Finish>
void visit_due(std::span<const double> next_check, Counts&& counts, PathLength&& path_length,
               Prefetch&& prefetch, Evaluate&& evaluate, Finish&& finish) {
  constexpr std::size_t ahead = 3;
  constexpr std::size_t shortest = 16;
  constexpr std::size_t longest = 128;  // long stretches fill vectors better
  const std::size_t even = next_check.size() / (8 * static_cast<std::size_t>(thread_count()));
  const std::size_t stretch = std::clamp(even, shortest, longest);
  struct Due {
    std::size_t k;
    double path_length;
  };
  parallel_for((next_check.size() + stretch - 1) / stretch, 1, [&](std::size_t task) {
    const std::size_t first = task * stretch;
    const std::size_t last = std::min(first + stretch, next_check.size());
    std::array<Due, longest> due;
    std::size_t count = 0;
    for (std::size_t k = first; k < last; ++k) {
      if (!counts(k)) continue;
      const double reading = path_length(k);
      if (!(reading < next_check[k])) due[count++] = {k, reading};
    }
    for (std::size_t n = 0; n < std::min(ahead, count); ++n) prefetch(due[n].k);
    for (std::size_t n = 0; n < count; ++n) {
      if (n + ahead < count) prefetch(due[n + ahead].k);
      evaluate(due[n].k, due[n].path_length);
    }
    finish();
  });
}

}  // namespace reckon
