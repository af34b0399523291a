// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/math/rotation.hpp"

namespace reckon {

[[nodiscard]] constexpr double determinant(const Mat3& m) {
  return dot(m.row_x, cross(m.row_y, m.row_z));
}

/// Of a matrix whose determinant is not zero.
[[nodiscard]] constexpr Mat3 inverse(const Mat3& m) {
  return 1 / determinant(m) *
         transpose({cross(m.row_y, m.row_z), cross(m.row_z, m.row_x), cross(m.row_x, m.row_y)});
}

}  // namespace reckon
