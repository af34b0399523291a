// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reckon/output/fields.hpp"

namespace reckon {

/// A grain at one step, with the data that its fields are computed from.
struct GrainAtStep {
  const GrainState& state;
  const ShapeOutline& shape;
  double density{0};          ///< [kg/m^3]
  std::uint32_t partners{0};  ///< in contact with it, walls included
  Vec3 contact_force;         ///< sum over them [N]
  std::uint32_t rank{0};      ///< that owns the grain
  Vec3 cell_shift;            ///< from its image in the cell to its unwrapped position [m]
};

/// How the numbers of a field are stored: real numbers as Float64 at points and as Float32 on
/// surfaces, counts as UInt32, flags as UInt8.
enum class FieldNumbers : std::uint8_t { real, count, flag };

/// What carries a field in surfaces_*.vtp. In grains_*.vtp each grain's point carries all fields.
enum class OnSurface : std::uint8_t { nothing, vertices, triangles };

/// One field that is saved of each grain. An entry in the table of fields is sufficient: the
/// ParaView files, their reference page, the state that `reckon paraview` writes and the list of
/// colours of the report page are made from that table.
struct GrainField {
  std::string name;             ///< of the array, e.g. "angular_velocity"
  std::string unit;             ///< e.g. "rad/s"; empty for a pure number
  std::string meaning;          ///< for the reference
  std::uint32_t components{1};  ///< numbers per grain, at most 4
  FieldNumbers numbers{FieldNumbers::real};
  OnSurface on_surface{OnSurface::vertices};
  /// The report page colours grains by the field's magnitude under this label, e.g. "Angular
  /// speed". Empty: it does not.
  std::string label{};
  bool needs_contacts{false};
  std::string condition{};                      ///< for the reference: which runs have it
  bool (*is_in)(const FieldsAtStep&){nullptr};  ///< whether it is saved; none: always
  std::function<std::array<double, 4>(const GrainAtStep&)> values;
};

/// The table, in the order of the arrays in the files.
[[nodiscard]] const std::vector<GrainField>& grain_fields();

/// Whether files of these fields hold the field.
[[nodiscard]] bool is_saved(const GrainField& field, const FieldsAtStep& fields);

/// The page of the reference: every field with unit and meaning, in Markdown.
[[nodiscard]] std::string grain_fields_markdown(std::span<const GrainField> table = grain_fields());

}  // namespace reckon
