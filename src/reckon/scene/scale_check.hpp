// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reckon/simulation/setup.hpp"

namespace reckon {

/// Sizes, speeds and periods of a scene against what the computation resolves: the spacing of
/// double-precision numbers, the time step, the mesh of the membrane, the densities of solids. What
/// cannot give a right answer is a fault; what may not is a warning.
class ScaleCheck {
 public:
  /// Key, problem, fix.
  using Fault = std::function<void(std::string, std::string, std::string)>;
  using Warn = std::function<void(std::string)>;

  /// Scenes whose grains, walls and stages have no faults.
  ScaleCheck(const LoadedScene& scene, double time_step, Fault fault, Warn warn);

  void run();
  /// Whether positions and the distances between them mean something. Known after run().
  [[nodiscard]] bool resolves_positions() const { return resolves_positions_; }

 private:
  void check_material();
  void check_coordinates();
  void check_speeds();
  void check_walls();
  void check_controls();
  void check_membrane();
  void check_coordinate(const std::string& key, const std::string& what, double coordinate);
  void check_path(const std::string& what, double speed);

  const LoadedScene& scene_;
  double time_step_;
  Fault fault_;
  Warn warn_;
  bool resolves_positions_{true};
  double smallest_radius_;  // of the bounding spheres of grains [m]
};

}  // namespace reckon
