// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/predicates.hpp"

#include <cmath>

#include "reckon/core/exact_sum.hpp"

namespace reckon {
namespace {

constexpr double epsilon = 0x1.0p-53;
// Bounds on the rounding of the floating-point evaluations below, relative to the sum of the
// absolute values of their terms (Shewchuk 1997, section 4.4).
constexpr double orientation_bound = (7 + 56 * epsilon) * epsilon;
constexpr double turn_bound = (3 + 16 * epsilon) * epsilon;

int sign_of(double value) { return (value > 0) - (value < 0); }

/// A product of two doubles as the exact sum of two doubles.
struct Product {
  double high;
  double low;
};
Product exact_product(double a, double b) {
  const double high = a * b;
  return {high, std::fma(a, b, -high)};
}

void add_product(ExactSum& sum, double a, double b, double c) {
  const Product ab = exact_product(a, b);
  for (const double part : {ab.high, ab.low}) {
    const Product abc = exact_product(part, c);
    sum.add(abc.high);
    sum.add(abc.low);
  }
}

void add_determinant(ExactSum& sum, const Vec3& a, const Vec3& b, const Vec3& c) {
  add_product(sum, a.x, b.y, c.z);
  add_product(sum, a.y, b.z, c.x);
  add_product(sum, a.z, b.x, c.y);
  add_product(sum, -a.x, b.z, c.y);
  add_product(sum, -a.y, b.x, c.z);
  add_product(sum, -a.z, b.y, c.x);
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  const Vec3 r = d - a;
  const double yz = p.y * q.z;
  const double zy = p.z * q.y;
  const double zx = p.z * q.x;
  const double xz = p.x * q.z;
  const double xy = p.x * q.y;
  const double yx = p.y * q.x;
  const double value = (yz - zy) * r.x + (zx - xz) * r.y + (xy - yx) * r.z;
  const double size = (std::abs(yz) + std::abs(zy)) * std::abs(r.x) +
                      (std::abs(zx) + std::abs(xz)) * std::abs(r.y) +
                      (std::abs(xy) + std::abs(yx)) * std::abs(r.z);
  if (std::abs(value) > orientation_bound * size) return sign_of(value);
  if (size == 0) return 0;  // every product has a factor that is exactly zero

  // Multilinear in b, c, d: every term that takes a twice vanishes.
  ExactSum sum;
  add_determinant(sum, b, c, d);
  add_determinant(sum, -a, c, d);
  add_determinant(sum, b, -a, d);
  add_determinant(sum, b, c, -a);
  return sign_of(sum.value());
}

int turn(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  const double value = left - right;
  const double size = std::abs(left) + std::abs(right);
  if (std::abs(value) > turn_bound * size) return sign_of(value);
  if (size == 0) return 0;

  ExactSum sum;
  const auto add = [&sum](double x, double y) {
    const Product product = exact_product(x, y);
    sum.add(product.high);
    sum.add(product.low);
  };
  add(b[u], c[v]);
  add(-b[v], c[u]);
  add(-a[u], c[v]);
  add(a[v], c[u]);
  add(-b[u], a[v]);
  add(b[v], a[u]);
  return sign_of(sum.value());
}

}  // namespace reckon
