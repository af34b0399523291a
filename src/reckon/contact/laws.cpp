// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "reckon/contact/area_law.hpp"
#include "reckon/contact/hertz_law.hpp"
#include "reckon/contact/linear_law.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

/// Force and its slope at an overlap x, in units in which the force is x^2 or x^(3/2).
struct Elastic {
  double force;
  double slope;
};
Elastic square_law(double x) { return {x * x, 2 * x}; }
Elastic hertz_force(double x) { return {x * std::sqrt(x), 1.5 * std::sqrt(x)}; }

/// Rebound speed of x'' = -max(0, force + alpha sqrt(slope) x') from x = 0, x' = 1 until x = 0.
double rebound(Elastic (*elastic)(double), double alpha) {
  struct State {
    double x, v;
  };
  const auto rate = [&](const State& s) -> State {
    const Elastic at = elastic(std::max(s.x, 0.0));
    return {s.v, -std::max(0.0, at.force + alpha * std::sqrt(at.slope) * s.v)};
  };
  constexpr double dt = 1e-3;
  State s{0, 1};
  for (int step = 0; step < 100000 && (s.x > 0 || s.v > 0); ++step) {
    const State k1 = rate(s);
    const State k2 = rate({s.x + 0.5 * dt * k1.x, s.v + 0.5 * dt * k1.v});
    const State k3 = rate({s.x + 0.5 * dt * k2.x, s.v + 0.5 * dt * k2.v});
    const State k4 = rate({s.x + dt * k3.x, s.v + dt * k3.v});
    s.x += dt / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x);
    s.v += dt / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v);
  }
  return -s.v;
}

/// The alpha that returns a share of the speed, by bisection.
double dashpot_factor(Elastic (*elastic)(double), double restitution) {
  double low = 0;
  double high = 1;
  while (rebound(elastic, high) > restitution && high < 1e3) high *= 2;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (rebound(elastic, middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double linear_dashpot_factor(double restitution) {
  const double log_e = portable::log(restitution);
  return -2 * log_e / std::sqrt(std::numbers::pi * std::numbers::pi + log_e * log_e);
}

double area_dashpot_factor(double restitution) { return dashpot_factor(square_law, restitution); }

double hertz_dashpot_factor(double restitution) { return dashpot_factor(hertz_force, restitution); }

}  // namespace reckon
