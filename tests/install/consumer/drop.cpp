// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drops a ball by the installed library and compares with Galileo.
#include <cmath>
#include <cstdio>
#include <memory>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/simulation/simulation.hpp"

int main() {
  using namespace reckon;
  const SceneReading reading = read_scene_text("[body]\ngravity = [0, 0, -9.81]\n", ".");
  const Vec3 gravity = reading.config.body.gravity;

  SimulationSetup setup;
  setup.shapes = std::make_shared<const ShapeLibrary>(
      ShapeLibrary{build_shape(sphere_mesh(0.001, 2e-4), {}, "ball")});
  setup.density = 2650;
  setup.body_force.gravity = gravity;
  setup.time_step = 1e-5;
  setup.skin = 1e-4;
  SimulationState start;
  start.grains.push_back({.position = {0, 0, 1}});
  Simulation simulation{setup, start};
  for (int n = 0; n < 10000; ++n) simulation.step();

  const double fallen = 1 - simulation.grain_states().front().position.z;
  const double expected = -0.5 * gravity.z * simulation.time() * simulation.time();
  std::printf("fallen %.6f m, expected %.6f m\n", fallen, expected);
  return std::abs(fallen - expected) < 1e-3 * expected ? 0 : 1;
}
