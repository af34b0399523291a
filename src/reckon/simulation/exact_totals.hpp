// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "reckon/core/exact_sum.hpp"
#include "reckon/math/rotation.hpp"
#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// Makes each sum that of all ranks, digit by digit, and each count that of all ranks, in one
/// message. Collective.
inline void add_up(const Communicator& ranks, std::span<ExactSum* const> sums,
                   std::span<std::int64_t> counts = {}) {
  std::vector<std::int64_t> digits{counts.begin(), counts.end()};
  digits.reserve(counts.size() + sums.size() * ExactSum::digit_count);
  for (ExactSum* sum : sums) {
    sum->carry();
    digits.insert(digits.end(), sum->digits().begin(), sum->digits().end());
  }
  ranks.sum(digits);
  auto next = digits.begin();
  for (std::int64_t& count : counts) count = *next++;
  for (ExactSum* sum : sums) {
    std::copy_n(next, ExactSum::digit_count, sum->digits().begin());
    next += ExactSum::digit_count;
  }
}
inline void add_up(const Communicator& ranks, std::span<ExactSum> sums) {
  std::vector<ExactSum*> pointers;
  for (ExactSum& sum : sums) pointers.push_back(&sum);
  add_up(ranks, pointers);
}

/// Exact sums of vectors and matrices, component by component.
struct ExactVec3 {
  ExactSum x, y, z;

  void add(const Vec3& v) {
    x.add(v.x);
    y.add(v.y);
    z.add(v.z);
  }
  [[nodiscard]] Vec3 value() const { return {x.value(), y.value(), z.value()}; }
  void list(std::vector<ExactSum*>& sums) { sums.insert(sums.end(), {&x, &y, &z}); }
};
struct ExactMat3 {
  ExactVec3 row_x, row_y, row_z;

  void add(const Mat3& m) {
    row_x.add(m.row_x);
    row_y.add(m.row_y);
    row_z.add(m.row_z);
  }
  [[nodiscard]] Mat3 value() const { return {row_x.value(), row_y.value(), row_z.value()}; }
  void list(std::vector<ExactSum*>& sums) {
    row_x.list(sums);
    row_y.list(sums);
    row_z.list(sums);
  }
};

}  // namespace reckon
