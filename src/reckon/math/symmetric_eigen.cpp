// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/math/symmetric_eigen.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace reckon {
namespace {

using Rows = std::array<Vec3, 3>;

/// Rotates rows and columns p and q of `a` so that a[p][q] vanishes (Golub & Van Loan, Matrix
/// Computations, section 8.5), and rows p and q of `v` along.
void rotate(Rows& a, Rows& v, int p, int q) {
  const auto row = [](Rows& m, int i) -> Vec3& { return m[static_cast<std::size_t>(i)]; };
  const double apq = row(a, p)[q];
  // Turning by less than rounding would only wear the basis down.
  if (std::abs(apq) <= 0x1p-54 * (std::abs(row(a, p)[p]) + std::abs(row(a, q)[q]))) {
    row(a, p)[q] = row(a, q)[p] = 0;
    return;
  }
  const double tau = (row(a, q)[q] - row(a, p)[p]) / (2 * apq);
  // The smaller root of t^2 + 2 tau t - 1; the inverse of an overflowing tau^2 is zero, as it
  // should.
  const double t = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
  const double c = 1 / std::sqrt(1 + t * t);
  const double s = t * c;
  const int r = 3 - p - q;
  const double arp = row(a, r)[p];
  const double arq = row(a, r)[q];
  row(a, p)[p] -= t * apq;
  row(a, q)[q] += t * apq;
  row(a, p)[q] = row(a, q)[p] = 0;
  row(a, r)[p] = row(a, p)[r] = c * arp - s * arq;
  row(a, r)[q] = row(a, q)[r] = s * arp + c * arq;
  const Vec3 vp = row(v, p);
  row(v, p) = c * vp - s * row(v, q);
  row(v, q) = s * vp + c * row(v, q);
}

}  // namespace

SymmetricEigen symmetric_eigen(const Mat3& matrix) {
  Rows a{Vec3{matrix.row_x.x, matrix.row_y.x, matrix.row_z.x},
         Vec3{matrix.row_y.x, matrix.row_y.y, matrix.row_z.y},
         Vec3{matrix.row_z.x, matrix.row_z.y, matrix.row_z.z}};
  Rows v{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  // Convergence is quadratic: a handful of sweeps takes every component below rounding, where
  // rotate sets it to zero.
  constexpr int most_sweeps = 30;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    if (a[1].x == 0 && a[2].x == 0 && a[2].y == 0) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  const std::array<double, 3> values{a[0].x, a[1].y, a[2].z};
  std::array<std::size_t, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  return {{values[order[0]], values[order[1]], values[order[2]]},
          {v[order[0]], v[order[1]], v[order[2]]}};
}

}  // namespace reckon
