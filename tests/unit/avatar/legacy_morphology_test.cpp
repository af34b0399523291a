// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/legacy_morphology.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "equal_morphologies.hpp"
#include "expect_error.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

/// A ball of four voxels radius whose centre lies off the grid's vertices.
LegacyMorphology ball() {
  const Vec3 center{6.25, 6.5, 6.125};
  LegacyMorphology m;
  const double volume = 4 * std::numbers::pi / 3 * 64;
  m.mass = volume;
  m.moments = 0.4 * volume * 16 * Vec3{1, 1, 1};
  m.center_of_mass = center;
  for (int n = 0; n < 60; ++n) {
    const double z = 1 - (2 * n + 1) / 60.0;
    const double r = std::sqrt(1 - z * z);
    const double angle = 2 * std::numbers::pi * n / std::numbers::phi;
    m.nodes.push_back({4 * r * std::cos(angle), 4 * r * std::sin(angle), 4 * z});
  }
  m.bounding_radius = 4;
  m.dims = {13, 14, 13};
  for (int k = 0; k < 13; ++k) {
    for (int j = 0; j < 14; ++j) {
      for (int i = 0; i < 13; ++i) {
        const Vec3 vertex{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        m.values.push_back(static_cast<float>(norm(vertex - center) - 4));
      }
    }
  }
  return m;
}

TEST(LegacyMorphology, TextComesBackExactly) {
  const LegacyMorphology original = ball();
  const std::string text = format_legacy_morphology(original);
  const LegacyMorphology parsed = parse_legacy_morphology(text, "ball");
  test::expect_equal(parsed, original);
  EXPECT_EQ(parsed.nodes, original.nodes);
  EXPECT_EQ(format_legacy_morphology(parsed), text);
}

TEST(LegacyMorphology, ShapeHasTheFilesNumbersAndGivesThemBack) {
  const LegacyMorphology original = ball();
  const Shape shape = to_shape(original, 1, "ball", LegacyRadius::as_in_file);
  EXPECT_EQ(shape.level_set.origin_body, -original.center_of_mass);
  EXPECT_EQ(shape.mass.volume, original.mass);
  EXPECT_EQ(shape.mass.inertia, original.moments);
  EXPECT_EQ(shape.bounding_radius, 4);
  test::expect_equal(to_legacy(shape), original);
  double area = 0;
  for (const double a : shape.nodes.area) {
    area += a;
    EXPECT_NEAR(a * 60 / (64 * std::numbers::pi), 1, 0.25);
  }
  EXPECT_NEAR(area / (64 * std::numbers::pi), 1, 0.03);
  EXPECT_NEAR(shape.descriptors.sphericity, 1, 0.03);
}

TEST(LegacyMorphology, AVoxelLengthScalesEverything) {
  const Shape one = to_shape(ball(), 1, "ball", LegacyRadius::as_in_file);
  const Shape half = to_shape(ball(), 0.5, "ball", LegacyRadius::as_in_file);
  EXPECT_EQ(half.mass.volume, one.mass.volume / 8);
  EXPECT_EQ(half.mass.inertia, one.mass.inertia / 32);
  EXPECT_EQ(half.nodes.x[10], one.nodes.x[10] / 2);
  EXPECT_EQ(half.level_set.values[10], one.level_set.values[10] / 2);
  EXPECT_EQ(half.level_set.spacing, 0.5);
  EXPECT_EQ(half.bounding_radius, 2);
  EXPECT_NEAR(half.nodes.area[10] / one.nodes.area[10], 0.25, 1e-12);
  test::expect_equal(to_legacy(half), ball());
  test::expect_error([] { (void)to_shape(ball(), 0, "ball", LegacyRadius::as_in_file); },
                     {"voxel", "between"});
}

TEST(LegacyMorphology, EnclosingRadiusKeepsThePromiseOfShapes) {
  LegacyMorphology m = ball();
  m.bounding_radius = 3.7;
  EXPECT_EQ(to_shape(m, 1, "ball", LegacyRadius::as_in_file).bounding_radius, 3.7);
  const Shape shape = to_shape(m, 1, "ball", LegacyRadius::enclosing);
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    EXPECT_LE(norm(shape.nodes.position(n)), shape.bounding_radius);
  }
  EXPECT_LT(shape.bounding_radius, 4.1);
}

TEST(LegacyMorphology, FaultsAreNamed) {
  const std::string good = format_legacy_morphology(ball());
  const auto line_replaced = [&](int number, const std::string& by) {
    std::string text = good;
    std::size_t begin = 0;
    for (int n = 1; n < number; ++n) begin = text.find('\n', begin) + 1;
    return text.replace(begin, text.find('\n', begin) - begin, by);
  };
  const auto refused = [](const std::string& text, std::initializer_list<std::string> parts) {
    test::expect_error([&] { (void)parse_legacy_morphology(text, "morph_7.dat"); }, parts);
  };
  refused(line_replaced(1, "-5"), {"morph_7.dat", "mass", "positive"});
  refused(line_replaced(1, "heavy"), {"morph_7.dat", "mass", "heavy"});
  refused(line_replaced(1, "nan"), {"mass"});
  refused(line_replaced(2, "1 2 0"), {"moment of inertia"});
  refused(line_replaced(4, "-1"), {"number of nodes"});
  refused(line_replaced(4, "0"), {"number of nodes"});
  refused(line_replaced(4, "2000000000"), {"too short", "nodes"});
  refused(line_replaced(4, "99999999999999999999"), {"number of nodes"});
  refused(line_replaced(7, "2000000000 2000000000 2000000000"), {"too short", "grid values"});
  refused(line_replaced(7, "13 14 -13"), {"grid dimension"});
  refused(line_replaced(7, "13 14 12"), {"more after the last grid value"});
  refused(line_replaced(7, "13 14 14"), {"grid value"});
  refused(good.substr(0, good.size() / 2), {"morph_7.dat"});
  refused("", {"mass"});
}

TEST(LegacyMorphology, MutatedTextGivesAnErrorOrAShapeAndNothingElse) {
  const std::string good = format_legacy_morphology(ball());
  RandomStream random{4, RandomPurpose::other, 0};
  const auto pick = [&](std::size_t below) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(below));
  };
  const std::string alphabet = "0123456789+-.eE \n\tnaif\0x\xff";
  for (int trial = 0; trial < 400; ++trial) {
    std::string text = good;
    // Most of the file is grid: aim at the head as often as at the rest.
    for (std::size_t n = 0; n <= pick(4); ++n) {
      const std::size_t at = pick(trial % 2 == 0 ? 400 : text.size());
      if (trial % 3 == 0) {
        text.erase(at, pick(20));
      } else {
        text[at] = alphabet[pick(alphabet.size())];
      }
    }
    try {
      const LegacyMorphology m = parse_legacy_morphology(text, "mutated");
      if (trial % 8 == 0) (void)to_shape(m, 1, "mutated", LegacyRadius::enclosing);
    } catch (const Error&) {
    }
  }
}

TEST(LegacyPlacement, PositionsAndRotations) {
  EXPECT_EQ(parse_legacy_positions("1 2 3\n\n4 5 6.5\n", "p"),
            (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6.5}}));
  const auto rotations = parse_legacy_rotations("0.1 0.2 0.3 0.92736184954957\n", "r");
  ASSERT_EQ(rotations.size(), 1U);
  EXPECT_EQ(rotations[0], (Quaternion{0.92736184954957, -0.2, 0.1, -0.3}));
  test::expect_error([] { (void)parse_legacy_positions("1 2 3\n1 2\n", "p.dat"); }, {"p.dat", "2"});
  test::expect_error([] { (void)parse_legacy_positions("1 2 3 4\n", "p"); }, {"three numbers"});
  test::expect_error([] { (void)parse_legacy_rotations("1 1 0 0\n", "r"); }, {"unit quaternion"});
}

}  // namespace
}  // namespace reckon
