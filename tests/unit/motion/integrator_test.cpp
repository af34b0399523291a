// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/motion/integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/verification_table.hpp"

namespace reckon {
namespace {

Grains one_grain(const Vec3& velocity, const Vec3& angular_velocity_body) {
  Grains grains;
  GrainState grain;
  grain.velocity = velocity;
  grain.angular_velocity_body = angular_velocity_body;
  grain.orientation = normalized(Quaternion{0.3, -0.5, 0.7, 0.2});
  grains.push_back(grain);
  return grains;
}

void advance(Grains& grains, const Load& load, const Inertia& inertia, double damping, double dt) {
  drift(grains, 0,
        kick(grains, 0, rotation_matrix(grains.orientation[0]), load, inertia, damping, dt), dt);
}

Vec3 angular_momentum_world(const Grains& grains, const Inertia& inertia) {
  return rotation_matrix(grains.orientation[0]) *
         hadamard(inertia.moments, grains.angular_velocity_body[0]);
}

TEST(Integrator, FreeFallFollowsTheLeapfrogParabola) {
  // Leapfrog is exact for a constant force: x_n = n v0 dt + n (n + 1) / 2 g dt^2.
  Grains grains = one_grain({1, 2, 3}, {});
  const Inertia inertia{2, {1, 1, 1}};
  const double dt = 1e-3;
  for (int n = 0; n < 1000; ++n) advance(grains, {{0, 0, -19.62}, {}}, inertia, 0, dt);
  EXPECT_NEAR(grains.position[0].x, 1.0, 1e-12);
  EXPECT_NEAR(grains.position[0].z, 3.0 - 9.81 * 0.5 * 1000 * 1001 * dt * dt, 1e-10);
}

TEST(Integrator, DampingDecaysAtTheSetRate) {
  const double xi = 3;
  const double dt = 1e-4;
  const Inertia inertia{2, {0.5, 0.5, 0.5}};
  Grains grains = one_grain({1, -2, 0.5}, {4, 0, 0});
  testing::VerificationTable table{"damping", "time_s,speed_over_start,closed_form"};
  for (int n = 0; n < 5000; ++n) {
    if (n % 250 == 0) table.row({n * dt, grains.velocity[0].x, std::exp(-xi * n * dt)});
    advance(grains, {}, inertia, xi, dt);
  }
  EXPECT_NEAR(grains.velocity[0].x, std::exp(-xi * 0.5), 1e-7);
  EXPECT_NEAR(grains.velocity[0].y, -2 * std::exp(-xi * 0.5), 2e-7);
  EXPECT_NEAR(grains.angular_velocity_body[0].x, 4 * std::exp(-xi * 0.5), 4e-7);
}

// A symmetric top without torque: the angular velocity turns about the symmetry axis at the rate
// (I1 - I3) / I1 * omega_3 in the body frame.
double symmetric_top_error(double dt) {
  const Inertia inertia{1, {2, 2, 1}};
  Grains grains = one_grain({}, {0.6, 0, 3});
  const double rate = (2.0 - 1.0) / 2.0 * 3;
  // Velocities are those of half a step before: start on the exact orbit at t = -dt/2.
  const auto exact = [&](double t) {
    return Vec3{0.6 * std::cos(rate * t), -0.6 * std::sin(rate * t), 3};
  };
  grains.angular_velocity_body[0] = exact(-0.5 * dt);
  grains.angular_increment_body[0] = exact(-0.5 * dt) - exact(-1.5 * dt);
  const int steps = static_cast<int>(std::lround(2.0 / dt));
  for (int n = 0; n < steps; ++n) advance(grains, {}, inertia, 0, dt);
  return norm(grains.angular_velocity_body[0] - exact(2.0 - 0.5 * dt));
}

TEST(Integrator, SymmetricTopConvergesAtSecondOrder) {
  testing::VerificationTable table{"symmetric_top", "steps_per_turn,angular_velocity"};
  for (double dt = 4e-2; dt > 1e-3; dt /= 2) {
    table.row({2 * std::numbers::pi / (1.5 * dt), symmetric_top_error(dt) / 3});
  }
  const double coarse = symmetric_top_error(1e-2);
  const double fine = symmetric_top_error(5e-3);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05);
}

TEST(Integrator, SpinAboutAPrincipalAxisUnderTorqueIsExact) {
  // omega_z = M t / I, and the angle is the exact integral of the piecewise constant rate, up to
  // the midpoint rule's third-order angle error.
  const Inertia inertia{1, {2, 2, 1}};
  Grains grains = one_grain({}, {});
  grains.orientation[0] = {1, 0, 0, 0};
  const double dt = 1e-3;
  const double torque = 0.7;
  for (int n = 0; n < 2000; ++n) advance(grains, {{}, {0, 0, torque}}, inertia, 0, dt);
  EXPECT_NEAR(grains.angular_velocity_body[0].z, torque * 2, 1e-12);
  const double angle = 2 * std::atan2(grains.orientation[0].z, grains.orientation[0].w);
  EXPECT_NEAR(angle, torque * dt * dt * 2000 * 2001 / 2, 1e-6);
}

// Time between flips of a free body that spins about its middle axis: 2 K(k) / rate (Landau and
// Lifshitz, Mechanics, section 37), for moments I1 < I2 < I3.
double flip_interval(const Vec3& i, const Vec3& w) {
  const double energy = 0.5 * dot(hadamard(i, w), w);
  const double momentum_squared = squared_norm(hadamard(i, w));
  double low = i.x;
  double high = i.z;
  if (momentum_squared < 2 * energy * i.y) std::swap(low, high);
  const double lower = momentum_squared - 2 * energy * low;
  const double upper = 2 * energy * high - momentum_squared;
  const double rate = std::sqrt((high - i.y) * lower / (i.x * i.y * i.z));
  const double modulus = std::sqrt((i.y - low) * upper / ((high - i.y) * lower));
  return 2 * std::comp_ellint_1(modulus) / rate;
}

TEST(Integrator, TumblingKeepsMomentumAndEnergyAndFlipsOnTime) {
  // Spin about the middle axis is unstable: the grain flips again and again (Dzhanibekov).
  const Inertia inertia{1, {1, 2, 3}};
  const Vec3 start{0.03, 5, 0.02};
  Grains grains = one_grain({}, start);
  const double dt = 1e-4;
  const double momentum = norm(angular_momentum_world(grains, inertia));
  const auto energy = [&] {
    const Vec3& w = grains.angular_velocity_body[0];
    return 0.5 * dot(hadamard(inertia.moments, w), w);
  };
  const double energy_before = energy();
  std::vector<double> flips;
  double worst_momentum = 0;
  double worst_energy = 0;
  testing::VerificationTable spins{"tumbling", "time_s,omega_1,omega_2,omega_3"};
  for (int n = 0; n < 600000; ++n) {
    if (n % 500 == 0 && n < 200000) {
      const Vec3& w = grains.angular_velocity_body[0];
      spins.row({n * dt, w.x, w.y, w.z});
    }
    const double before = grains.angular_velocity_body[0].y;
    advance(grains, {}, inertia, 0, dt);
    const double after = grains.angular_velocity_body[0].y;
    if (before * after < 0) flips.push_back((n + before / (before - after)) * dt);
    worst_momentum = std::max(
        worst_momentum, std::abs(norm(angular_momentum_world(grains, inertia)) / momentum - 1));
    worst_energy = std::max(worst_energy, std::abs(energy() / energy_before - 1));
  }
  ASSERT_GE(flips.size(), 8U);
  const double interval = (flips.back() - flips.front()) / static_cast<double>(flips.size() - 1);
  testing::VerificationTable figures{"tumbling_figures",
                                     "flips,interval_s,closed_form_s,momentum_error,energy_error"};
  figures.row({static_cast<double>(flips.size()), interval, flip_interval(inertia.moments, start),
               worst_momentum, worst_energy});
  EXPECT_NEAR(interval / flip_interval(inertia.moments, start), 1, 1e-5);
  EXPECT_LT(worst_momentum, 1e-8);
  EXPECT_LT(worst_energy, 1e-8);
}

TEST(Integrator, OrientationStaysOfUnitLength) {
  Grains grains = one_grain({}, {30, -20, 10});
  for (int n = 0; n < 10000; ++n) advance(grains, {}, {1, {1, 2, 3}}, 0, 1e-3);
  const Quaternion& q = grains.orientation[0];
  EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
}

}  // namespace
}  // namespace reckon
