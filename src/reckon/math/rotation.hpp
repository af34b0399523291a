// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A 3x3 matrix by rows.
struct Mat3 {
  Vec3 row_x{1, 0, 0};
  Vec3 row_y{0, 1, 0};
  Vec3 row_z{0, 0, 1};
  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

constexpr Mat3& operator+=(Mat3& a, const Mat3& b) {
  a.row_x += b.row_x;
  a.row_y += b.row_y;
  a.row_z += b.row_z;
  return a;
}
[[nodiscard]] constexpr Mat3 operator*(double factor, const Mat3& m) {
  return {factor * m.row_x, factor * m.row_y, factor * m.row_z};
}
/// Row i, column j is a_i b_j.
[[nodiscard]] constexpr Mat3 outer(const Vec3& a, const Vec3& b) {
  return {a.x * b, a.y * b, a.z * b};
}
[[nodiscard]] constexpr double trace(const Mat3& m) { return m.row_x.x + m.row_y.y + m.row_z.z; }

[[nodiscard]] constexpr Vec3 operator*(const Mat3& m, const Vec3& v) {
  return {dot(m.row_x, v), dot(m.row_y, v), dot(m.row_z, v)};
}
[[nodiscard]] constexpr Mat3 transpose(const Mat3& m) {
  return {{m.row_x.x, m.row_y.x, m.row_z.x},
          {m.row_x.y, m.row_y.y, m.row_z.y},
          {m.row_x.z, m.row_y.z, m.row_z.z}};
}
[[nodiscard]] constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
  const Mat3 c = transpose(b);
  return {{dot(a.row_x, c.row_x), dot(a.row_x, c.row_y), dot(a.row_x, c.row_z)},
          {dot(a.row_y, c.row_x), dot(a.row_y, c.row_y), dot(a.row_y, c.row_z)},
          {dot(a.row_z, c.row_x), dot(a.row_z, c.row_y), dot(a.row_z, c.row_z)}};
}
/// transpose(m) * v without forming the transpose.
[[nodiscard]] constexpr Vec3 transposed_times(const Mat3& m, const Vec3& v) {
  return {m.row_x.x * v.x + m.row_y.x * v.y + m.row_z.x * v.z,
          m.row_x.y * v.x + m.row_y.y * v.y + m.row_z.y * v.z,
          m.row_x.z * v.x + m.row_y.z * v.y + m.row_z.z * v.z};
}

/// A unit quaternion (w, x, y, z) that turns body-frame vectors into world-frame vectors.
struct Quaternion {
  double w{1};
  double x{0};
  double y{0};
  double z{0};
  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// Hamilton product: rotating by `b` first, then by `a`.
[[nodiscard]] constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
[[nodiscard]] constexpr Quaternion conjugate(const Quaternion& q) {
  return {q.w, -q.x, -q.y, -q.z};
}
[[nodiscard]] inline Quaternion normalized(const Quaternion& q) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}
/// The matrix R with world = R * body, in its homogeneous form: a quaternion of norm s gives s^2 R.
/// (Input files give quaternions with few digits; their first step uses them unchanged.)
[[nodiscard]] constexpr Mat3 rotation_matrix(const Quaternion& q) {
  const double ww = q.w * q.w;
  const double xx = q.x * q.x;
  const double yy = q.y * q.y;
  const double zz = q.z * q.z;
  return {{ww + xx - yy - zz, 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)},
          {2 * (q.x * q.y + q.w * q.z), ww - xx + yy - zz, 2 * (q.y * q.z - q.w * q.x)},
          {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), ww - xx - yy + zz}};
}

/// The rotation matrix `m` as a unit quaternion with w >= 0 (Shepperd 1978: the largest of the
/// four candidates is found first, so the division is always safe).
[[nodiscard]] inline Quaternion quaternion_from_matrix(const Mat3& m) {
  const double xx = m.row_x.x;
  const double yy = m.row_y.y;
  const double zz = m.row_z.z;
  Quaternion q;
  if (xx + yy + zz >= xx && xx + yy + zz >= yy && xx + yy + zz >= zz) {
    q = {1 + xx + yy + zz, m.row_z.y - m.row_y.z, m.row_x.z - m.row_z.x, m.row_y.x - m.row_x.y};
  } else if (xx >= yy && xx >= zz) {
    q = {m.row_z.y - m.row_y.z, 1 + xx - yy - zz, m.row_x.y + m.row_y.x, m.row_x.z + m.row_z.x};
  } else if (yy >= zz) {
    q = {m.row_x.z - m.row_z.x, m.row_x.y + m.row_y.x, 1 - xx + yy - zz, m.row_y.z + m.row_z.y};
  } else {
    q = {m.row_y.x - m.row_x.y, m.row_x.z + m.row_z.x, m.row_y.z + m.row_z.y, 1 - xx - yy + zz};
  }
  if (q.w < 0) q = {-q.w, -q.x, -q.y, -q.z};
  return normalized(q);
}

/// `v` turned by the smallest rotation that takes the unit vector `from` to the unit vector `to`.
/// This is Rodrigues' formula (paper, B.4) with cosine and sine written as products of the two
/// vectors, so that no trigonometric function is called. Opposite vectors leave `v` unchanged.
[[nodiscard]] constexpr Vec3 rotate_between(const Vec3& v, const Vec3& from, const Vec3& to) {
  const Vec3 axis = cross(from, to);  // |axis| = sin(angle)
  const double cosine = dot(from, to);
  if (cosine <= -1 + 1e-12) return v;
  return cosine * v + cross(axis, v) + (dot(axis, v) / (1 + cosine)) * axis;
}

}  // namespace reckon
