// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "reckon/parallel/threads.hpp"

namespace reckon {

/// Calls evaluate(k, odometer) for every k with counts(k) whose odometer(k) has reached wake[k], on
/// all threads.
/// Who is awake in a stretch is known before the first is evaluated, so prefetch(k) can ask the
/// memory a few ahead. What sleeps costs its odometer and one comparison. After each stretch its
/// thread calls finish().
template <class Counts, class Odometer, class Prefetch, class Evaluate, class Finish>
void visit_awake(std::span<const double> wake, Counts&& counts, Odometer&& odometer,
                 Prefetch&& prefetch, Evaluate&& evaluate, Finish&& finish) {
  constexpr std::size_t stretch = 128;
  constexpr std::size_t ahead = 3;
  struct Awake {
    std::size_t k;
    double odometer;
  };
  parallel_for((wake.size() + stretch - 1) / stretch, 1, [&](std::size_t task) {
    const std::size_t first = task * stretch;
    const std::size_t last = std::min(first + stretch, wake.size());
    std::array<Awake, stretch> awake;
    std::size_t count = 0;
    for (std::size_t k = first; k < last; ++k) {
      if (!counts(k)) continue;
      const double reading = odometer(k);
      if (!(reading < wake[k])) awake[count++] = {k, reading};
    }
    for (std::size_t n = 0; n < std::min(ahead, count); ++n) prefetch(awake[n].k);
    for (std::size_t n = 0; n < count; ++n) {
      if (n + ahead < count) prefetch(awake[n + ahead].k);
      evaluate(awake[n].k, awake[n].odometer);
    }
    finish();
  });
}

}  // namespace reckon
