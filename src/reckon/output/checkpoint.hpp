// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "reckon/simulation/simulation.hpp"

namespace reckon {

class Hdf5Writer;

/// All that is needed to go on with a run, to the same bits as if it had never stopped.
struct Checkpoint {
  SimulationState state;
  double time_step{0};                       ///< [s]
  double energy_at_start{0};                 ///< EnergyBudget::total() at step 0 [J]
  std::string scene;                         ///< as write_scene gives it, without its length
  std::vector<std::uint64_t> shape_digests;  ///< of the library, see avatar/library_file.hpp
  std::uint64_t acceleration_digest{0};      ///< of the grains' own accelerations
  /// The step since when the goal of the run or of its stage is met (HeldCondition), if it is.
  std::optional<std::uint64_t> goal_met_since{};
};

/// One dataset of a checkpoint: rows of `width` numbers each.
struct CheckpointColumn {
  std::string name;  ///< e.g. "/grain/position"
  std::string unit;
  std::uint64_t width{1};
  std::variant<std::vector<double>, std::vector<std::uint64_t>, std::vector<std::uint32_t>,
               std::vector<std::uint8_t>>
      values;
};

/// The state as named tables of numbers: what the file holds and what `reckon diff` compares.
[[nodiscard]] std::vector<CheckpointColumn> to_columns(const SimulationState& state);

/// Adds a column to a file as a dataset with its unit.
void write_column(Hdf5Writer& file, const CheckpointColumn& column);

/// Writes a sealed HDF5 file (core/hdf5_file.hpp). Equal checkpoints give equal files.
///
///   /run/{step, time_step, energy_at_start, shape_digest, acceleration_digest, scene,
///         goal_met_since}
///   /grain/{id, shape, prescribed, position, orientation, ...}     one row per grain, by id
///   /departed/{step, id, ...}              grains that left, as they were then
///   /driven_wall/{displacement, ...}       one row per wall of the scene
///   /stage/start                           the step at which each stage so far began
///   /membrane/{foot, ...}, /membrane_node/{position, ...}, /membrane_spring/{node, grain, ...}
///   /cell/{edges, lean, ...}               one row where there is a periodic cell
///   /pair/{id_a, id_b, first_spring}        one row per touching pair; its springs begin there
///   /pair_spring/{node, master_is_b, shear_force, normal, dashpot_push, shear_stiffness}
///   /wall_contact/{grain, wall, first_spring}, /wall_spring/{...}  the same for walls
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Throws Error when the file is damaged, is no checkpoint or contradicts itself.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace reckon
