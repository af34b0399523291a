// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A 3x3 matrix with zeros below its diagonal. Sums, products and inverses of such matrices are
/// such matrices too.
struct UpperMat3 {
  Vec3 diagonal;
  double xy{0};  ///< row x, column y
  double xz{0};
  double yz{0};

  [[nodiscard]] static constexpr UpperMat3 identity() { return {{1, 1, 1}, 0, 0, 0}; }
  constexpr UpperMat3& operator+=(const UpperMat3& b) {
    diagonal += b.diagonal;
    xy += b.xy;
    xz += b.xz;
    yz += b.yz;
    return *this;
  }
  friend constexpr bool operator==(const UpperMat3&, const UpperMat3&) = default;
};

[[nodiscard]] constexpr UpperMat3 operator+(UpperMat3 a, const UpperMat3& b) { return a += b; }
[[nodiscard]] constexpr UpperMat3 operator*(double s, const UpperMat3& m) {
  return {s * m.diagonal, s * m.xy, s * m.xz, s * m.yz};
}
[[nodiscard]] constexpr Vec3 operator*(const UpperMat3& m, const Vec3& v) {
  return {m.diagonal.x * v.x + m.xy * v.y + m.xz * v.z, m.diagonal.y * v.y + m.yz * v.z,
          m.diagonal.z * v.z};
}
[[nodiscard]] constexpr UpperMat3 operator*(const UpperMat3& a, const UpperMat3& b) {
  return {hadamard(a.diagonal, b.diagonal), a.diagonal.x * b.xy + a.xy * b.diagonal.y,
          a.diagonal.x * b.xz + a.xy * b.yz + a.xz * b.diagonal.z,
          a.diagonal.y * b.yz + a.yz * b.diagonal.z};
}
/// Without zeros on the diagonal.
[[nodiscard]] constexpr UpperMat3 inverse(const UpperMat3& m) {
  const Vec3 d{1 / m.diagonal.x, 1 / m.diagonal.y, 1 / m.diagonal.z};
  const double xy = -m.xy * d.x * d.y;
  const double yz = -m.yz * d.y * d.z;
  return {d, xy, -(m.xz * d.x + m.yz * xy) * d.z, yz};
}
/// The sum of the products of all entries.
[[nodiscard]] constexpr double contract(const UpperMat3& a, const UpperMat3& b) {
  return dot(a.diagonal, b.diagonal) + (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
}
/// Root of the sum of all squares: no vector grows by more when multiplied.
[[nodiscard]] inline double frobenius_norm(const UpperMat3& m) { return std::sqrt(contract(m, m)); }

}  // namespace reckon
