// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reckon/simulation/setup.hpp"

namespace reckon {

/// What can be wrong with stages, membrane and cell once walls and shapes are known: controls of
/// planes that are not there, stresses in a space that is open, a cell that is too narrow.
class StageCheck {
 public:
  /// Key, problem, fix.
  using Fault = std::function<void(std::string, std::string, std::string)>;

  StageCheck(const LoadedScene& scene, Fault fault);

  void run();

 private:
  void check_control(const ControlConfig& control, const std::string& key,
                     std::vector<bool>& controlled);
  void check_membrane();
  void check_cell(const LoadedScene& scene);
  void check_walls_in_cell();
  void check_room_in_cell(const LoadedScene& scene);
  void check_cell_control(const ControlConfig& control, const std::string& key,
                          std::vector<bool>& driven);
  void check_bonds();
  void check_goal(const StageConfig& stage, const std::string& key);
  [[nodiscard]] std::string known_planes() const;

  const LoadedScene& loaded_;
  const SceneConfig& scene_;
  Fault fault_;
  std::vector<Wall> walls_;
  bool closed_;
};

}  // namespace reckon
