// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// What edges and corners must carry. Statics: a box tips where its weight leaves its base, a plate
// and two blocks fall where their centres of mass leave their support; the depth of a corner in a
// face is known. Shapes are made as users make them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// Length, mass density and gravity are about 1, and the ground is so stiff that bodies sink in by
/// about a millionth.
constexpr double gravity = 1;

Shape block(const Vec3& half, double voxels, std::uint32_t nodes) {
  return build_shape(box_mesh(half, 0.1), {.voxels_per_diameter = voxels, .node_count = nodes},
                     "block", SurfaceKind::solid);
}

/// The turn from a block's own frame, whose axes go by its moments (longest first), to one where
/// its lengths along x, y, z are 2 half.
Quaternion upright(const Vec3& half) {
  const Vec3 moments{half.y * half.y + half.z * half.z, half.x * half.x + half.z * half.z,
                     half.x * half.x + half.y * half.y};
  std::array<int, 3> by_moment{0, 1, 2};
  std::stable_sort(by_moment.begin(), by_moment.end(),
                   [&](int a, int b) { return moments[a] < moments[b]; });
  std::array<Vec3, 3> axis;  // of the body in the world
  for (std::size_t n = 0; n < 3; ++n) axis[n][by_moment[n]] = 1;
  if (dot(cross(axis[0], axis[1]), axis[2]) < 0) axis[2] = -axis[2];
  return quaternion_from_matrix(transpose(Mat3{axis[0], axis[1], axis[2]}));
}

/// The least turn that takes one direction to another.
Quaternion turn_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = normalized(from);
  const Vec3 b = normalized(to);
  const Vec3 axis = cross(a, b);
  return normalized(Quaternion{1 + dot(a, b), axis.x, axis.y, axis.z});
}

GrainState at_rest(std::uint32_t shape, const Vec3& position, const Quaternion& orientation) {
  GrainState grain;
  grain.shape = ShapeId{shape};
  grain.position = position;
  grain.orientation = orientation;
  return grain;
}

SimulationSetup stiff_ground(std::vector<Shape> shapes, double stiffness) {
  SimulationSetup setup;
  setup.shapes = testing::library_of(std::move(shapes));
  setup.density = 1;
  const AreaLaw law{stiffness, stiffness, area_dashpot_factor(0.2)};
  setup.contact = {law, 1.0};
  setup.body_force.gravity = {0, 0, -gravity};
  setup.damping = 1;
  setup.time_step = 3e-4;
  setup.skin = 0.05;
  return setup;
}

Simulation simulation_of(const SimulationSetup& setup, std::vector<GrainState> grains) {
  for (std::uint32_t n = 0; n < grains.size(); ++n) grains[n].id = GrainId{n};
  SimulationState state;
  state.grains = std::move(grains);
  return {setup, state};
}

/// The angle between a grain's orientation and that at its start [rad].
double turned(const GrainState& now, const Quaternion& start) {
  const Quaternion& q = now.orientation;
  const double cosine = std::abs(q.w * start.w + q.x * start.x + q.y * start.y + q.z * start.z);
  return 2 * std::acos(std::min(cosine, 1.0));
}

// Edges differ in length, so that the frame of principal axes is known.
constexpr Vec3 tall{0.5, 0.6, 1};

/// Whether a tall box tips over its longer edge on a floor that leans by the tangent `ratio` w/h.
bool tips(const Shape& box, double ratio) {
  const Vec3 half = tall;
  SimulationSetup setup = stiff_ground({box}, 2e6);
  setup.walls = {{"floor",
                  PlaneSurface{{0, 0, 0}, {0, 0, 1}},
                  std::get<AreaLaw>(setup.contact.law),
                  1.0,
                  false,
                  {}}};
  const auto stage = [&](double tangent) {
    const double cosine = 1 / std::sqrt(1 + tangent * tangent);
    return StageSetup{.name = "s",
                      .friction = 1,
                      .wall_friction = {1},
                      .gravity = gravity * Vec3{tangent * cosine, 0, -cosine},
                      .damping = 1};
  };
  // Slowly, so that it does not rock.
  setup.stages = {stage(0.9 * half.x / half.z), stage(0.96 * half.x / half.z),
                  stage(ratio * half.x / half.z)};
  const Quaternion start = upright(half);
  Simulation simulation = simulation_of(setup, {at_rest(0, {0, 0, half.z}, start)});
  for (std::size_t s = 0; s < setup.stages.size(); ++s) {
    if (s > 0) simulation.begin_next_stage();
    const int steps = s + 1 < setup.stages.size() ? 6000 : 30000;
    for (int n = 0; n < steps; ++n) simulation.step();
  }
  return turned(simulation.state().grains[0], start) > 0.1;
}

TEST(Edges, BoxTipsWhereItsWeightLeavesItsBase) {
  for (const std::uint32_t nodes : {500U, 3000U}) {
    const Shape box = block(tall, 40, nodes);
    EXPECT_FALSE(tips(box, 0.99)) << nodes;
    EXPECT_TRUE(tips(box, 1.01)) << nodes;
  }
}

/// Whether a pile of plates of length 2 on a fixed block falls; `ahead` are the places of their
/// middles beyond the block's edge, from below.
bool falls(const std::vector<double>& ahead) {
  const Vec3 half{1, 0.4, 0.1};
  const Vec3 base{1, 0.6, 0.4};
  const SimulationSetup setup = stiff_ground({block(base, 40, 2000), block(half, 40, 2000)}, 2e5);
  std::vector<GrainState> grains{at_rest(0, {0, 0, -base.z}, upright(base))};
  grains[0].prescribed = true;
  for (std::size_t n = 0; n < ahead.size(); ++n) {
    grains.push_back(at_rest(1, {base.x + ahead[n], 0, (2.0 * static_cast<double>(n) + 1) * half.z},
                             upright(half)));
  }
  Simulation simulation = simulation_of(setup, grains);
  for (int n = 0; n < 20000; ++n) simulation.step();
  double most = 0;
  for (std::size_t n = 1; n < grains.size(); ++n) {
    most = std::max(most, turned(simulation.state().grains[n], grains[n].orientation));
  }
  return most > 0.05;
}

TEST(Edges, PlateOverhangsByHalfOfItsLength) {
  EXPECT_FALSE(falls({-0.01}));
  EXPECT_TRUE(falls({0.01}));
}

TEST(Edges, TwoBlocksOverhangByThreeQuartersOfTheirLength) {
  // The upper one's middle lies over the lower one's edge, both together over the block's edge.
  const auto reach = [](double share) {
    const double lower = -1 + 0.5 * share;
    return std::vector<double>{lower, lower + share};
  };
  EXPECT_FALSE(falls(reach(0.99)));
  EXPECT_TRUE(falls(reach(1.01)));
}

struct Sunk {
  double reported;  // overlap
  double depth;     // of the lowest corner below the face
};

/// A near-cube stands on its corner on a fixed one like it.
Sunk corner_on_face(std::uint32_t nodes, bool fixed_last) {
  const Vec3 half{1, 0.98, 0.96};
  SimulationSetup setup = stiff_ground({block(half, 20, nodes)}, 1e7);
  setup.damping = 30;
  const Quaternion start = upright(half);
  const Quaternion on_corner = turn_between(-half, {0, 0, -1});
  std::vector<GrainState> grains{at_rest(0, {0, 0, -half.z}, start),
                                 at_rest(0, {0.05, 0.03, norm(half)}, on_corner * start)};
  grains[0].prescribed = true;
  if (fixed_last) std::swap(grains[0], grains[1]);
  Simulation simulation = simulation_of(setup, grains);
  for (int n = 0; n < 3000; ++n) simulation.step();
  const double reported = simulation.measure().deepest_overlap;
  const GrainState upper = simulation.state().grains[fixed_last ? 0 : 1];
  const Mat3 rotation = rotation_matrix(upper.orientation) * transpose(rotation_matrix(start));
  double lowest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sides{(corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                     (corner & 4) != 0 ? 1.0 : -1.0};
    lowest = std::min(lowest, (upper.position + rotation * hadamard(sides, half)).z);
  }
  return {reported, -lowest};
}

TEST(Edges, CornerRestsOnAFaceAndItsDepthIsReported) {
  for (const bool fixed_last : {false, true}) {
    const Sunk sunk = corner_on_face(600, fixed_last);
    // Weight over k times half of the corner's area, a quarter of that of a node on a face.
    const double area = 24.0 / 600 / 4;
    const double expected = 8 * gravity / (0.5 * 1e7 * area);
    EXPECT_GT(sunk.depth, 0.5 * expected);
    EXPECT_LT(sunk.depth, 2 * expected);
    EXPECT_LT(sunk.depth, 1e-3);
    EXPECT_NEAR(sunk.reported / sunk.depth, 1, 0.01);
  }
}

constexpr Vec3 bar{1, 0.5, 0.48};

/// The upward force on a bar that lies with an edge across the edge of another, `overlap` deep,
/// `along` and `across` away from the middles of the edges.
double crossed_edges(const Shape& box, double overlap, double along, double across) {
  SimulationSetup setup = stiff_ground({box}, 1e7);
  setup.body_force.gravity = {};
  const Quaternion start = upright(bar);
  const Vec3 edge{0, bar.y, bar.z};  // the middle of one that runs along x
  const double diagonal = norm(edge);
  const double quarter = std::sqrt(0.5);
  const Quaternion below = turn_between(edge, {0, 0, 1}) * start;
  const Quaternion above =
      Quaternion{quarter, 0, 0, quarter} * (turn_between(-edge, {0, 0, -1}) * start);
  std::vector<GrainState> grains{at_rest(0, {along, 0, -diagonal}, below),
                                 at_rest(0, {0, across, diagonal - overlap}, above)};
  for (GrainState& grain : grains) grain.prescribed = true;
  Simulation simulation = simulation_of(setup, grains);
  simulation.step();
  static_cast<void>(simulation.measure());
  const auto forces = simulation.grain_contacts().forces();
  return forces.empty() ? 0 : -forces[0].force_on_a.z;
}

TEST(Edges, CrossedEdgesAreCarriedByTheirNodesFromHalfASpacingOn) {
  const Shape box = block(bar, 40, 979);
  // Nodes on its edges: sqrt(9.8 / 979) = 0.1 apart. At the depth d an edge lies inside the other
  // over 2 d, so one of its nodes does when d exceeds half a spacing.
  const double spacing = 0.1;
  for (int n = 0; n < 10; ++n) {
    for (int m = 0; m < 10; ++m) {
      const double along = spacing * n / 10;
      const double across = spacing * m / 10;
      EXPECT_GT(crossed_edges(box, 0.55 * spacing, along, across), 0) << n << ' ' << m;
    }
  }
  // Where nodes meet they push as soon as they pass the grid's rounding of the edge.
  const double voxel = box.level_set.spacing;
  EXPECT_GT(crossed_edges(box, 0.7 * voxel, 0, 0), 0);
  EXPECT_EQ(crossed_edges(box, -0.01 * voxel, 0, 0), 0);
}

}  // namespace
}  // namespace reckon
