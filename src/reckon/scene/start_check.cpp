// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/start_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <variant>

#include "reckon/simulation/grains_inside.hpp"

namespace reckon {
namespace {

constexpr std::size_t most_reports = 20;  // of each kind

constexpr const char* allowed =
    "With `allow_inside = true` in [contact] the run begins all the same, to let contacts push "
    "them "
    "apart.";

}  // namespace

StartCheck::StartCheck(const LoadedScene& scene, std::span<const std::uint32_t> first_ids,
                       Fault fault, Warn warn)
    : scene_{scene}, first_ids_{first_ids}, fault_{std::move(fault)}, warn_{std::move(warn)} {}

void StartCheck::run() {
  check_copies();
  check_inside();
  check_walls();
}

StartCheck::Origin StartCheck::origin_of(GrainId grain) const {
  const auto after = std::upper_bound(first_ids_.begin(), first_ids_.end(), grain.get());
  const auto set = static_cast<std::size_t>(after - first_ids_.begin()) - 1;
  const std::uint32_t row = grain.get() - first_ids_[set];
  const std::string path = fmt::format("grains[{}]", set);
  const auto& placement = scene_.config.grains[set].placement;
  const auto row_of = [&](const std::string& file) {
    return fmt::format("row {} of {}", row + 1, std::filesystem::path{file}.filename().string());
  };
  if (const auto* table = std::get_if<TablePlacement>(&placement)) {
    return {path + ".table", row_of(table->file)};
  }
  if (const auto* files = std::get_if<LegacyPlacement>(&placement)) {
    return {path + ".files", row_of(files->positions_file)};
  }
  if (std::holds_alternative<FillPlacement>(placement)) return {path + ".fill", path + ".fill"};
  const std::string place = fmt::format("{}.place[{}]", path, row);
  return {place, place};
}

std::string StartCheck::name_of(GrainId grain) const {
  return fmt::format("grain {} ({})", grain.get(), origin_of(grain).words);
}

void StartCheck::report(GrainId grain, std::string problem, const std::string& fix) {
  if (scene_.config.contact.allow_inside) return warn_(std::move(problem));
  fault_(origin_of(grain).key, std::move(problem), fix + ' ' + allowed);
}

void StartCheck::check_copies() {
  const std::vector<Copies> all = find_copies(scene_.grains);
  for (std::size_t n = 0; n < std::min(all.size(), most_reports); ++n) {
    const Copies& copies = all[n];
    std::string problem =
        fmt::format("{} stands exactly where {} stands", name_of(copies[1]), name_of(copies[0]));
    if (copies.size() > 2) problem += fmt::format(", and so do {} more", copies.size() - 2);
    // No contact parts grains in one pose: there is no direction to push in.
    fault_(origin_of(copies[1]).key, std::move(problem), "Keep one of them.");
  }
  if (all.size() > most_reports) {
    fault_("grains", fmt::format("{} more poses stand twice", all.size() - most_reports), {});
  }
}

void StartCheck::check_inside() {
  std::vector<ShapeOutline> outlines;
  outlines.reserve(scene_.shapes.size());
  for (const ShapeSummary& shape : scene_.shapes) outlines.push_back(shape.outline);
  std::optional<PeriodicCell> cell;
  if (const auto& config = scene_.config.cell) {
    const Vec3 size = config->box.high - config->box.low;
    cell.emplace(0.5 * (config->box.low + config->box.high), periodic_axes(*config),
                 UpperMat3{.diagonal = size}, UpperMat3{});
  }
  const auto found = find_grains_inside(scene_.grains, outlines, scene_.read_shape,
                                        cell ? &*cell : nullptr, most_reports);
  for (const GrainInside& pair : found) {
    report(pair.inner,
           fmt::format("{} is inside {}: its centre lies {:.3g} m below the surface",
                       name_of(pair.inner), name_of(pair.outer), pair.depth),
           "Place them apart: contacts are found at surfaces only.");
  }
  if (found.size() == most_reports) {
    report(found.back().inner, "more grains may be inside others: the search ended here", {});
  }
}

void StartCheck::check_walls() {
  const std::vector<Wall> walls = make_walls(scene_.config);
  std::size_t reports = 0;
  for (const GrainState& grain : scene_.grains) {
    for (const Wall& wall : walls) {
      const double distance = std::visit(
          [&](const auto& surface) { return surface.distance(grain.position); }, wall.surface);
      if (!(distance < 0)) continue;
      if (++reports > most_reports) {
        return report(grain.id, "more grains are beyond walls: the search ended here", {});
      }
      report(grain.id,
             fmt::format("{} is beyond wall \"{}\": its centre lies {:.3g} m behind the surface",
                         name_of(grain.id), wall.name, -distance),
             "Grains are kept on the side that a plane's normal points to, and inside a cylinder.");
    }
  }
}

}  // namespace reckon
