// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/run_outputs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "reckon/text/human.hpp"

namespace reckon {
namespace {

/// The rows that an uninterrupted run would have written at `resumed_at`.
std::function<bool(std::uint64_t)> rows_to_keep(const OutputSchedule& schedule,
                                                std::optional<std::uint64_t> resumed_at) {
  if (!resumed_at) return {};
  return [schedule, at = *resumed_at](std::uint64_t step) {
    return step <= at && schedule.history_due(step);
  };
}

/// The steps of rows that are due up to `resumed_at` and are not in the table, in words.
std::string rows_lost(const HistoryTable& table, const OutputSchedule& schedule,
                      std::uint64_t resumed_at) {
  constexpr std::size_t named = 5;
  std::string steps;
  std::size_t lost = 0;
  std::set<std::string> known;
  for (const auto& row : table.rows) known.insert(row.front());
  for (std::uint64_t step = 0; step <= resumed_at; ++step) {
    if (!schedule.history_due(step)) continue;
    const std::string word = fmt::format("{}", step);
    if (known.contains(word)) continue;
    if (++lost <= named) steps += (steps.empty() ? "" : ", ") + word;
  }
  if (lost == 0) return {};
  if (lost > named) steps += ", ...";
  return fmt::format(
      "history.csv lacks {} from before the checkpoint (step{} {}): lost by a full disk or a "
      "power failure, they cannot be made again without --overwrite",
      counted(lost, "row"), lost == 1 ? "" : "s", steps);
}

}  // namespace

RunOutputs::RunOutputs(RunFolder folder, const LoadedScene& scene, const PreparedScene& prepared,
                       OutputSchedule schedule, std::optional<std::uint64_t> resumed_at)
    : folder_{std::move(folder)},
      config_{scene.config.output},
      schedule_{std::move(schedule)},
      shapes_{scene.shapes},
      read_shape_{scene.read_shape},
      walls_{prepared.setup.walls},
      density_{scene.config.material.density},
      time_step_{prepared.time_step.step},
      history_{folder_.history(), quantities_of(layout_of(prepared.setup, config_.sample)),
               rows_to_keep(schedule_, resumed_at)} {
  if (prepared.setup.membrane) mould_ = prepared.setup.membrane->mould;
  if (!resumed_at) return;
  lost_rows_ = rows_lost(read_history(folder_.history()), schedule_, *resumed_at);
  take_over("grains", *resumed_at, grains_);
  take_over("contacts", *resumed_at, contacts_);
  take_over("surfaces", *resumed_at, surfaces_);
  take_over("membrane", *resumed_at, membrane_);
  take_over("walls", *resumed_at, wall_polygons_);
  take_over("cell", *resumed_at, cell_);
  if (schedule_.history_due(*resumed_at)) last_row_ = resumed_at;
  if (schedule_.fields_due(*resumed_at)) last_frame_ = resumed_at;
}

void RunOutputs::append_history(const HistoryRow& row) {
  history_.append(row);
  last_row_ = row.measurement.step;
}

void RunOutputs::write_fields(const FieldsAtStep& fields) {
  const auto file = [&](std::string_view kind) {
    return folder_.root() / RunFolder::field_name(kind, fields.step);
  };
  write_grain_points(file("grains"), fields, shapes_, density_);
  add_to_index("grains", fields.step, grains_);
  if (config_.contacts) {
    write_contact_lines(file("contacts"), fields.contacts, fields.time);
    add_to_index("contacts", fields.step, contacts_);
  }
  if (config_.surfaces) {
    if (surface_meshes_.empty()) surface_meshes_ = surface_meshes(fields.grains, read_shape_);
    write_grain_surfaces(file("surfaces"), fields, shapes_, density_, surface_meshes_);
    add_to_index("surfaces", fields.step, surfaces_);
  }
  if (mould_) {  // an empty file while the mould is in the membrane's place: pictures then show
                 // none
    write_membrane(file("membrane"), fields.membrane.value_or(MembraneAtStep{}), fields.time);
    add_to_index("membrane", fields.step, membrane_);
  }
  if (!walls_.empty()) {
    write_walls(file("walls"), fields, shapes_, walls_, mould_);
    add_to_index("walls", fields.step, wall_polygons_);
  }
  if (fields.cell) {
    write_cell(file("cell"), *fields.cell, fields.time);
    add_to_index("cell", fields.step, cell_);
  }
  last_frame_ = fields.step;
}

void RunOutputs::add_to_index(std::string_view kind, std::uint64_t step,
                              std::vector<PvdEntry>& entries) {
  entries.push_back(
      {static_cast<double>(step) * time_step_, RunFolder::field_name(kind, step), {}});
  write_pvd(folder_.index(kind), entries);
}

void RunOutputs::take_over(std::string_view kind, std::uint64_t resumed_at,
                           std::vector<PvdEntry>& entries) {
  const std::vector<std::uint64_t> steps = folder_.field_steps(kind);
  for (const std::uint64_t step : steps) {
    const std::string name = RunFolder::field_name(kind, step);
    if (step <= resumed_at && schedule_.fields_due(step)) {
      entries.push_back({static_cast<double>(step) * time_step_, name, {}});
    } else {
      folder_.remove_field(kind, step);
    }
  }
  if (!steps.empty()) write_pvd(folder_.index(kind), entries);
}

}  // namespace reckon
