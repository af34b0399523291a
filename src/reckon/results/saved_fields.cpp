// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/saved_fields.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/vtk_reader.hpp"
#include "reckon/scene/scene_reader.hpp"

namespace reckon {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, std::string reason) {
  throw Error{{.place = path.string(),
               .problem = "this file of fields contradicts itself",
               .reason = std::move(reason),
               .fix = {}}};
}

/// One array of a file, with the types that the rest of the program uses.
class Column {
 public:
  Column(const VtkReader& file, const std::filesystem::path& path, VtkSection section,
         const char* name, std::uint32_t components, std::size_t rows)
      : path_{path},
        name_{name},
        components_{components},
        numbers_{file.numbers(section, name, components, rows)} {
    for (const double number : numbers_) {
      if (!std::isfinite(number)) refuse(path_, name_ + " holds what is no finite number");
    }
  }

  [[nodiscard]] double number(std::size_t row) const { return numbers_[row * components_]; }
  [[nodiscard]] std::uint32_t whole(std::size_t row) const {
    const double value = number(row);
    if (!(value >= 0 && value <= std::numeric_limits<std::uint32_t>::max()) ||
        value != std::floor(value)) {
      refuse(path_, name_ + " holds what is no whole number of 32 bits");
    }
    return static_cast<std::uint32_t>(value);
  }
  [[nodiscard]] const std::vector<double>& numbers() const { return numbers_; }
  [[nodiscard]] Vec3 vector(std::size_t row) const {
    return {numbers_[3 * row], numbers_[3 * row + 1], numbers_[3 * row + 2]};
  }
  [[nodiscard]] Quaternion quaternion(std::size_t row) const {
    return {numbers_[4 * row], numbers_[4 * row + 1], numbers_[4 * row + 2], numbers_[4 * row + 3]};
  }

 private:
  const std::filesystem::path& path_;
  std::string name_;
  std::uint32_t components_;
  std::vector<double> numbers_;
};

void read_grains(const std::filesystem::path& path, std::span<const GrainField> table,
                 SavedFields& fields) {
  const VtkReader file{path};
  const std::size_t rows = file.tuples(VtkSection::points, "Points");
  const auto column = [&](const char* name, std::uint32_t components) {
    return Column{file, path, VtkSection::point_data, name, components, rows};
  };
  const Column position{file, path, VtkSection::points, "Points", 3, rows};
  const Column id = column("id", 1);
  const Column shape = column("shape", 1);
  const Column prescribed = column("prescribed", 1);
  const Column radius = column("radius", 1);
  const Column equivalent_radius = column("equivalent_radius", 1);
  const Column mass = column("mass", 1);
  const Column orientation = column("orientation", 4);
  const Column velocity = column("velocity", 3);
  const Column angular_velocity = column("angular_velocity", 3);
  const Column touching = column("contacts", 1);
  std::optional<Column> shift;  // only in a periodic cell
  if (file.has(VtkSection::point_data, "cell_shift")) shift.emplace(column("cell_shift", 3));
  fields.grains.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    fields.grains.push_back(
        {GrainId{id.whole(row)}, ShapeId{shape.whole(row)}, prescribed.whole(row) != 0,
         radius.number(row), equivalent_radius.number(row), mass.number(row), position.vector(row),
         orientation.quaternion(row), velocity.vector(row), angular_velocity.vector(row),
         touching.whole(row), shift ? shift->vector(row) : Vec3{}});
    if (row > 0 && fields.grains[row - 1].id >= fields.grains[row].id) {
      refuse(path, "grains are not in the order of their ids");
    }
  }
  for (const GrainField& field : table) {
    if (field.label.empty() || !file.has(VtkSection::point_data, field.name)) continue;
    fields.shown.push_back(
        {field.name, field.components, column(field.name.c_str(), field.components).numbers()});
  }
  fields.time = Column{file, path, VtkSection::field_data, "TimeValue", 1, 1}.number(0);
  const std::size_t walls = file.tuples(VtkSection::field_data, "wall_displacement");
  if (walls == 0) return;
  const Column displacement{file, path, VtkSection::field_data, "wall_displacement", 3, walls};
  for (std::size_t wall = 0; wall < walls; ++wall) {
    fields.wall_displacement.push_back(displacement.vector(wall));
  }
}

void read_contacts(const std::filesystem::path& path, SavedFields& fields) {
  const VtkReader file{path};
  const std::size_t rows = file.tuples(VtkSection::cell_data, "grain");
  const auto column = [&](const char* name, std::uint32_t components) {
    return Column{file, path, VtkSection::cell_data, name, components, rows};
  };
  const Column ends{file, path, VtkSection::points, "Points", 3, 2 * rows};
  const Column grain = column("grain", 1);
  const Column partner = column("partner", 1);
  const Column with_wall = column("with_wall", 1);
  const Column force = column("force", 3);
  const Column deepest = column("deepest", 1);
  const Column nodes = column("nodes", 1);
  std::optional<Column> bonded;  // files from before bonds have none
  if (file.has(VtkSection::cell_data, "bonded")) bonded.emplace(column("bonded", 1));
  const auto is_grain = [&](std::uint32_t id) {
    const auto found =
        std::lower_bound(fields.grains.begin(), fields.grains.end(), GrainId{id},
                         [](const SavedGrain& saved, GrainId wanted) { return saved.id < wanted; });
    return found != fields.grains.end() && found->id == GrainId{id};
  };
  fields.contacts.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const ContactRecord contact{
        GrainId{grain.whole(row)}, with_wall.whole(row) != 0, partner.whole(row),
        ends.vector(2 * row),      ends.vector(2 * row + 1),  force.vector(row),
        deepest.number(row),       nodes.whole(row),          bonded && bonded->whole(row) != 0};
    if (!is_grain(contact.grain.get()) || (!contact.with_wall && !is_grain(contact.partner))) {
      refuse(path, "a contact names a grain that does not exist");
    }
    fields.contacts.push_back(contact);
  }
  std::stable_partition(fields.contacts.begin(), fields.contacts.end(),
                        [](const ContactRecord& contact) { return !contact.with_wall; });
}

void read_membrane(const std::filesystem::path& path, SavedFields& fields) {
  const VtkReader file{path};
  const std::size_t nodes = file.tuples(VtkSection::points, "Points");
  if (nodes == 0) return;
  const Column places{file, path, VtkSection::points, "Points", 3, nodes};
  for (std::size_t node = 0; node < nodes; ++node) {
    fields.membrane_places.push_back(places.vector(node));
  }
  const std::size_t corners = file.tuples(VtkSection::polys, "connectivity");
  const Column corner{file, path, VtkSection::polys, "connectivity", 1, corners};
  if (corners % 3 != 0) refuse(path, "the membrane is not made of triangles");
  for (std::size_t n = 0; n < corners; ++n) {
    if (corner.whole(n) >= nodes) refuse(path, "a triangle names a node that does not exist");
    fields.membrane_corners.push_back(corner.whole(n));
  }
}

void read_cell(const std::filesystem::path& path, SavedFields& fields) {
  constexpr std::size_t corners = 8;
  const VtkReader file{path};
  const Column places{file, path, VtkSection::points, "Points", 3, corners};
  for (std::size_t corner = 0; corner < corners; ++corner) {
    fields.cell_corners.push_back(places.vector(corner));
  }
}

}  // namespace

SceneConfig scene_of_run(const RunFolder& folder) {
  if (!std::filesystem::exists(folder.resolved())) {
    throw Error{{.place = folder.root().string(),
                 .problem = "this is not the folder of a run",
                 .reason = "it has no scene_resolved.toml",
                 .fix = "Name a folder that `reckon run` has written."}};
  }
  const std::filesystem::path file = folder.own(folder.resolved());
  SceneReading reading = read_scene_text(read_file(file), folder.root());
  for (const SceneFault& fault : reading.faults) {
    if (fault.is_of_other_file) continue;  // missing shapes are reported later
    throw Error{{.place = file.string(),
                 .problem = "this is not a scene that a run has written",
                 .reason = describe(fault, file.filename().string()),
                 .fix = "Put the run's own file back: `reckon run` with --resume writes it anew."}};
  }
  return std::move(reading.config);
}

SavedFields read_fields(const RunFolder& folder, std::uint64_t step,
                        std::span<const GrainField> table) {
  SavedFields fields;
  fields.step = step;
  const auto file = [&](const char* kind) {
    return folder.own(folder.root() / RunFolder::field_name(kind, step));
  };
  read_grains(file("grains"), table, fields);
  const std::filesystem::path contacts = file("contacts");
  fields.has_contacts = std::filesystem::exists(contacts);
  if (fields.has_contacts) read_contacts(contacts, fields);
  const std::filesystem::path membrane = file("membrane");
  if (std::filesystem::exists(membrane)) read_membrane(membrane, fields);
  const std::filesystem::path cell = file("cell");
  if (std::filesystem::exists(cell)) read_cell(cell, fields);
  return fields;
}

}  // namespace reckon
