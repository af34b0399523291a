// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "reckon/parallel/foreign_communicator.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon::python {

/// A scene without faults, with its grains placed.
struct Scene {
  SceneReading reading;
  LoadedScene loaded;
  std::string name;  ///< for messages
};

/// By the Fortran handle of an MPI communicator, or this process alone.
[[nodiscard]] inline Communicator ranks_of(std::optional<int> communicator) {
  return communicator ? communicator_of(*communicator) : Communicator{};
}

}  // namespace reckon::python
