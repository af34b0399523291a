// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/grain_fields.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "reckon/math/rotation.hpp"

namespace reckon {
namespace {

using Values = std::array<double, 4>;
using G = const GrainAtStep&;

Values values_of(const Vec3& v) { return {v.x, v.y, v.z, 0}; }
Values values_of(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

double equivalent_radius(const ShapeOutline& shape) {
  return std::cbrt(0.75 / std::numbers::pi * shape.mass.volume);
}

std::vector<GrainField> make_table() {
  const auto in_cell = [](const FieldsAtStep& fields) { return fields.cell.has_value(); };
  const auto with_ranks = [](const FieldsAtStep& fields) { return !fields.ranks.empty(); };
  std::vector<GrainField> table;
  table.push_back({.name = "id",
                   .unit = "",
                   .meaning = "number of the grain",
                   .numbers = FieldNumbers::count,
                   .on_surface = OnSurface::triangles,
                   .values = [](G g) { return Values{static_cast<double>(g.state.id.get())}; }});
  table.push_back({.name = "shape",
                   .unit = "",
                   .meaning = "place of its shape in the library",
                   .numbers = FieldNumbers::count,
                   .on_surface = OnSurface::triangles,
                   .values = [](G g) { return Values{static_cast<double>(g.state.shape.get())}; }});
  table.push_back({.name = "radius",
                   .unit = "m",
                   .meaning = "radius of the bounding sphere around the centre of mass",
                   .on_surface = OnSurface::nothing,
                   .values = [](G g) { return Values{g.shape.bounding_radius}; }});
  table.push_back({.name = "orientation",
                   .unit = "",
                   .meaning = "unit quaternion w, x, y, z that turns the body frame into the world "
                              "frame",
                   .components = 4,
                   .on_surface = OnSurface::nothing,
                   .values = [](G g) { return values_of(g.state.orientation); }});
  table.push_back({.name = "speed",
                   .unit = "m/s",
                   .meaning = "magnitude of the velocity",
                   .on_surface = OnSurface::triangles,
                   .values = [](G g) { return Values{norm(g.state.velocity)}; }});
  table.push_back({.name = "prescribed",
                   .unit = "",
                   .meaning = "1 for a grain that moves as the scene says, else 0",
                   .numbers = FieldNumbers::flag,
                   .on_surface = OnSurface::nothing,
                   .values = [](G g) { return Values{g.state.prescribed ? 1.0 : 0.0}; }});
  table.push_back({.name = "equivalent_radius",
                   .unit = "m",
                   .meaning = "radius of the sphere of equal volume",
                   .values = [](G g) { return Values{equivalent_radius(g.shape)}; }});
  table.push_back(
      {.name = "mass", .unit = "kg", .meaning = "mass", .label = "Mass", .values = [](G g) {
         return Values{g.density * g.shape.mass.volume};
       }});
  table.push_back({.name = "velocity",
                   .unit = "m/s",
                   .meaning = "velocity of the centre of mass in the world frame, half a step "
                              "before the time of the file",
                   .components = 3,
                   .label = "Speed",
                   .values = [](G g) { return values_of(g.state.velocity); }});
  table.push_back({.name = "angular_velocity",
                   .unit = "rad/s",
                   .meaning = "angular velocity in the world frame, half a step before the time of "
                              "the file",
                   .components = 3,
                   .label = "Angular speed",
                   .values = [](G g) {
                     return values_of(rotation_matrix(g.state.orientation) *
                                      g.state.angular_velocity_body);
                   }});
  const auto with_contacts = [](const FieldsAtStep& fields) { return fields.has_contacts; };
  table.push_back({.name = "contacts",
                   .unit = "",
                   .meaning = "number of touching partners, walls included",
                   .numbers = FieldNumbers::count,
                   .label = "Touching partners, walls included",
                   .needs_contacts = true,
                   .condition = "by `reckon surfaces`: where the run wrote contacts at that step",
                   .is_in = with_contacts,
                   .values = [](G g) { return Values{static_cast<double>(g.partners)}; }});
  table.push_back({.name = "contact_force",
                   .unit = "N",
                   .meaning = "sum of the contact forces on the grain",
                   .components = 3,
                   .label = "Sum of the contact forces",
                   .needs_contacts = true,
                   .condition = "by `reckon surfaces`: where the run wrote contacts at that step",
                   .is_in = with_contacts,
                   .values = [](G g) { return values_of(g.contact_force); }});
  table.push_back({.name = "rank",
                   .unit = "",
                   .meaning = "rank that has the grain: the only field that depends on how many "
                              "ranks there are",
                   .numbers = FieldNumbers::count,
                   .label = "Rank",
                   .condition = "with `output.ranks`",
                   .is_in = with_ranks,
                   .values = [](G g) { return Values{static_cast<double>(g.rank)}; }});
  table.push_back({.name = "cell_shift",
                   .unit = "m",
                   .meaning = "from the image that is in the cell to the place to which the grain "
                              "has moved",
                   .components = 3,
                   .on_surface = OnSurface::nothing,
                   .condition = "in a periodic cell",
                   .is_in = in_cell,
                   .values = [](G g) { return values_of(g.cell_shift); }});
  return table;
}

}  // namespace

const std::vector<GrainField>& grain_fields() {
  static const std::vector<GrainField> table = make_table();
  return table;
}

bool is_saved(const GrainField& field, const FieldsAtStep& fields) {
  return field.is_in == nullptr || field.is_in(fields);
}

std::string grain_fields_markdown(std::span<const GrainField> table) {
  std::string page =
      "# Fields of grains\n\n"
      "`grains_*.vtp` holds a point per grain, with all these fields as point data.\n"
      "`surfaces_*.vtp` holds the grains' surfaces; the last column says what carries a field\n"
      "there. The report page colours grains by the magnitude of the fields that have a label.\n\n"
      "This page is made by `reckon reference fields`.\n\n"
      "| field | unit | numbers | meaning | when | label on the page | on surfaces |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const GrainField& field : table) {
    const char* carrier = field.on_surface == OnSurface::vertices    ? "vertices"
                          : field.on_surface == OnSurface::triangles ? "triangles"
                                                                     : "";
    page += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", field.name, field.unit,
                        field.components, field.meaning, field.condition, field.label, carrier);
  }
  return page;
}

}  // namespace reckon
