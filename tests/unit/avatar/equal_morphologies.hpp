// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "reckon/avatar/legacy_morphology.hpp"

namespace reckon::test {

inline auto sorted(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  return points;
}

/// Equal to the last bit, but for the order of the nodes.
inline void expect_equal(const LegacyMorphology& a, const LegacyMorphology& b) {
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.moments, b.moments);
  EXPECT_EQ(a.center_of_mass, b.center_of_mass);
  EXPECT_EQ(sorted(a.nodes), sorted(b.nodes));
  EXPECT_EQ(a.bounding_radius, b.bounding_radius);
  EXPECT_EQ(a.dims, b.dims);
  EXPECT_EQ(a.values, b.values);
}

}  // namespace reckon::test
