// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>

#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"

namespace reckon::testing {

/// One grain above the floor z = 0; gravity may lean, which stands for an inclined floor.
struct OneGrainOnPlane {
  double density{2500};
  AreaLaw law{1e8, 5e7, 0};
  double friction{0.5};
  Vec3 gravity;
  double time_step{1e-4};

  [[nodiscard]] Simulation simulation(const Shape& shape, const GrainState& grain) const {
    SimulationSetup setup;
    setup.shapes = library_of({shape});
    setup.density = density;
    setup.contact = {law, friction, MasterRule::lower_id};
    setup.walls = {{"floor", PlaneSurface{{0, 0, 0}, {0, 0, 1}}, law, friction, false, {}}};
    setup.body_force.gravity = gravity;
    setup.time_step = time_step;
    setup.skin = 0.1 * shape.bounding_radius;
    SimulationState state;
    state.grains = {grain};
    return {setup, state};
  }

  /// Overlap at which a sphere of radius `radius` rests on the floor: pi R k d^2 = m g_z.
  [[nodiscard]] double resting_overlap(double radius) const {
    const double weight =
        4.0 / 3 * std::numbers::pi * radius * radius * radius * density * std::abs(gravity.z);
    return std::sqrt(weight / (std::numbers::pi * radius * law.normal_stiffness));
  }
};

/// Advances to `time` [s] after the start.
inline void run_until(Simulation& simulation, double time) {
  while (simulation.time() < time) simulation.step();
}

}  // namespace reckon::testing
