// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reckon/output/grain_fields.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/simulation/config.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

/// A grain as fields/grains_*.vtp hold it.
struct SavedGrain {
  GrainId id;
  ShapeId shape;
  bool prescribed{false};
  double radius{0};             ///< of the bounding sphere [m]
  double equivalent_radius{0};  ///< of the sphere of equal volume [m]
  double mass{0};               ///< [kg]
  Vec3 position;                ///< in the cell, where there is one [m]
  Quaternion orientation;       ///< body to world
  Vec3 velocity;                ///< half a step before [m/s]
  Vec3 angular_velocity;        ///< world frame, half a step before [rad/s]
  std::uint32_t touching{0};    ///< partners, walls included
  Vec3 cell_shift;              ///< from there to its unwrapped position; see PeriodicCell [m]
};

/// A field of the table (output/grain_fields.hpp) that the report page shows, as it was saved.
struct SavedField {
  std::string name;
  std::uint32_t components{1};
  std::vector<double> numbers;  ///< grain by grain
};

/// The assembly at one saved step.
struct SavedFields {
  std::uint64_t step{0};
  double time{0};                       ///< [s]
  std::vector<SavedGrain> grains;       ///< sorted by id
  std::vector<SavedField> shown;        ///< see read_fields; as far as the file has them
  bool has_contacts{false};             ///< whether the run wrote contacts (output.contacts)
  std::vector<ContactRecord> contacts;  ///< of pairs, then with walls
  std::vector<Vec3> wall_displacement;  ///< by wall, since time zero; empty where not known [m]
  std::vector<Vec3> membrane_places;    ///< of its nodes; empty while it is not in place [m]
  std::vector<std::uint32_t> membrane_corners;  ///< three nodes for each triangle
  std::vector<Vec3> cell_corners;  ///< of the periodic cell, see write_cell; or none [m]
};

/// The scene as it ran, without its files. Throws Error where the folder holds no run, or its
/// scene_resolved.toml is not a scene.
[[nodiscard]] SceneConfig scene_of_run(const RunFolder& folder);

/// Reads the ParaView files that a run wrote at `step`. Throws Error when there are none, or when
/// they are damaged or contradict each other. Of `table`, the fields with a label are read as
/// `shown`, which the report page needs.
[[nodiscard]] SavedFields read_fields(const RunFolder& folder, std::uint64_t step,
                                      std::span<const GrainField> table = {});

}  // namespace reckon
