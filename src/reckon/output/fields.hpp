// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

struct GrainField;

/// A membrane at one step.
struct MembraneAtStep {
  VtkCells triangles;
  std::vector<Vec3> places;          ///< of its nodes [m]
  std::vector<Vec3> displacements;   ///< since it took its place [m]
  std::vector<Vec3> velocities;      ///< half a step before [m/s]
  std::vector<Vec3> contact_forces;  ///< of grains on nodes [N]
};
/// Nothing while it is not in place.
[[nodiscard]] std::optional<MembraneAtStep> membrane_now(const Simulation& simulation);

/// What fields are written from: the assembly at one step.
struct FieldsAtStep {
  std::uint64_t step{0};
  double time{0};                       ///< [s]
  std::vector<GrainState> grains;       ///< sorted by id
  std::vector<std::uint32_t> ranks;     ///< owners of the grains; empty: not requested
  bool has_contacts{true};              ///< whether contacts are known
  std::vector<ContactRecord> contacts;  ///< see Simulation::contacts
  std::vector<Vec3> wall_displacement;  ///< by wall, since time zero [m]
  std::optional<MembraneAtStep> membrane;
  std::optional<PeriodicCell> cell;  ///< that the grains were put into
  std::vector<Vec3> cell_shift;      ///< by row, from there to the unwrapped position [m]
};

/// Takes the image of each grain that is in the cell, as it moves there.
void put_into(const PeriodicCell& cell, FieldsAtStep& fields);

/// Writes one point per grain, by id, with the fields of the table (output/grain_fields.hpp). Data
/// of the whole file: `TimeValue` and `wall_displacement`.
void write_grain_points(const std::filesystem::path& path, const FieldsAtStep& fields,
                        std::span<const ShapeSummary> shapes, double density);
/// The same with another table.
void write_grain_points(const std::filesystem::path& path, const FieldsAtStep& fields,
                        std::span<const ShapeSummary> shapes, double density,
                        std::span<const GrainField> table);

/// Writes one line per touching pair from centre to centre, or from a grain's centre to its foot on
/// a wall: `force` on the first grain, `force_magnitude`, `grain`, `partner` (grain id or wall
/// number), `with_wall`, `deepest`, `nodes`.
void write_contact_lines(const std::filesystem::path& path, std::span<const ContactRecord> contacts,
                         double time);

/// Writes the membrane's triangles, with `displacement`, `velocity` and `contact_force` per node.
void write_membrane(const std::filesystem::path& path, const MembraneAtStep& membrane, double time);

/// Writes the edges of a periodic cell as lines between its eight corners, the one at corner n half
/// of edge a, b or c ahead of the centre where bit 0, 1 or 2 of n is set, else behind.
void write_cell(const std::filesystem::path& path, const PeriodicCell& cell, double time);

/// Writes the walls as polygons (output/wall_surfaces.hpp), with `wall` (its place in the scene),
/// `displacement` since time zero and `force` of all grains on it. The mould of a membrane that is
/// in place is not there. Without grains there is nothing to draw them around.
void write_walls(const std::filesystem::path& path, const FieldsAtStep& fields,
                 std::span<const ShapeSummary> shapes, std::span<const Wall> walls,
                 std::optional<WallId> mould);

/// Writes the grains' true surfaces where the grains are, with the fields that the table puts on
/// vertices and triangles. `surfaces[shape]` are in the body frame.
void write_grain_surfaces(const std::filesystem::path& path, const FieldsAtStep& fields,
                          std::span<const ShapeSummary> shapes, double density,
                          std::span<const TriangleMesh> surfaces);

/// The size of a file of write_grain_surfaces, on disk and in memory.
struct SurfaceSize {
  std::uint64_t triangles{0};
  std::uint64_t bytes{0};
};
[[nodiscard]] SurfaceSize size_of_surfaces(std::span<const GrainState> grains,
                                           std::span<const TriangleMesh> surfaces);

/// The zero surfaces of the shapes that grains have, by ShapeId, for write_grain_surfaces; those of
/// other shapes are empty.
[[nodiscard]] std::vector<TriangleMesh> surface_meshes(std::span<const GrainState> grains,
                                                       const ShapeStore::Read& read);

}  // namespace reckon
