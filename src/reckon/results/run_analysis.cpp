// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/run_analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "reckon/analysis/force_distribution.hpp"
#include "reckon/analysis/images_in_cell.hpp"
#include "reckon/analysis/local_strain.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/output/history.hpp"
#include "reckon/results/saved_fields.hpp"

namespace reckon {
namespace {

[[noreturn]] void refuse(const RunFolder& folder, std::string problem, std::string fix) {
  throw Error{{.place = folder.root().string(),
               .problem = std::move(problem),
               .reason = {},
               .fix = std::move(fix)}};
}

/// The last step of the stage before the last one; 0 without stages.
std::uint64_t start_of_last_stage(const RunFolder& folder) {
  const HistoryTable table = read_history(folder.own(folder.history()));
  const auto stage = std::find(table.header.begin(), table.header.end(), "stage");
  if (stage == table.header.end() || table.rows.empty()) return 0;
  const auto column = static_cast<std::size_t>(stage - table.header.begin());
  const auto before = std::find_if(table.rows.rbegin(), table.rows.rend(), [&](const auto& row) {
    return row[column] != table.rows.back()[column];
  });
  if (before == table.rows.rend()) return 0;
  const std::string& cell = before->front();
  std::uint64_t step = 0;
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), step);
  if (code == std::errc{} && end == cell.data() + cell.size()) return step;
  throw Error{{.place = folder.history().string(),
               .problem = fmt::format("\"{}\" is not a step", cell),
               .reason = "each row begins with one",
               .fix = "Put a good copy back, or give --from."}};
}

/// The fields of a step; nothing where they cannot be read, which is then recorded in `done`.
std::optional<SavedFields> readable_fields(const RunFolder& folder, std::uint64_t step,
                                           RunAnalysis& done) {
  try {
    return read_fields(folder, step);
  } catch (const Error& error) {
    done.left_out.emplace_back(error.what());
    return std::nullopt;
  }
}

std::uint64_t first_step(const RunFolder& folder, const AnalysisOptions& options,
                         const std::vector<std::uint64_t>& saved) {
  if (!options.from) {
    const auto found = std::lower_bound(saved.begin(), saved.end(), start_of_last_stage(folder));
    if (found != saved.end()) return *found;
  } else if (std::binary_search(saved.begin(), saved.end(), *options.from)) {
    return *options.from;
  }
  refuse(folder,
         options.from ? fmt::format("step {} was not saved", *options.from)
                      : "no step of the last stage was saved",
         "Its files fields/grains_STEP.vtp say which there are; output.fields_interval, or "
         "fields_interval of a stage, has more written.");
}

std::vector<Vec3> places(const SavedFields& fields) {
  std::vector<Vec3> found;
  for (const SavedGrain& grain : fields.grains) found.push_back(grain.position);
  return found;
}

GrainsOfCell in_cell(const SavedFields& fields) {
  GrainsOfCell found{.positions = places(fields), .shifts = {}, .edges = {}};
  for (const SavedGrain& grain : fields.grains) found.shifts.push_back(grain.cell_shift);
  const auto& corner = fields.cell_corners;
  found.edges = transpose({corner[1] - corner[0], corner[2] - corner[0], corner[4] - corner[0]});
  return found;
}

/// Where the grains at the start are now: in a periodic cell, their images that were in it then.
std::vector<Vec3> places_later(const SavedFields& start, const SavedFields& now) {
  const bool in_a_cell = !start.cell_corners.empty() && !now.cell_corners.empty();
  return in_a_cell ? images_later(in_cell(start), in_cell(now)) : places(now);
}

/// The angle between two orientations [deg].
double turn_between(const Quaternion& a, const Quaternion& b) {
  const double cosine = std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z);
  return 360 / std::numbers::pi * std::acos(std::min(cosine, 1.0));
}

StrainSummary summary_of(std::uint64_t step, const std::vector<LocalStrain>& strains) {
  StrainSummary summary{.step = step};
  std::vector<double> shears;
  for (const LocalStrain& strain : strains) {
    if (!strain.is_known()) continue;
    shears.push_back(strain.shear);
    summary.shear += strain.shear;
    summary.volumetric += strain.volumetric;
  }
  if (shears.empty()) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {.step = step, .shear = unknown, .largest = unknown, .volumetric = unknown};
  }
  const auto count = static_cast<double>(shears.size());
  summary.shear /= count;
  summary.volumetric /= count;
  const auto place = shears.begin() + static_cast<std::ptrdiff_t>(0.9 * (count - 1));
  std::nth_element(shears.begin(), place, shears.end());
  summary.largest = *place;
  return summary;
}

void write_strain(const std::filesystem::path& path, const SavedFields& start,
                  const SavedFields& now, const std::vector<Vec3>& later,
                  const std::vector<LocalStrain>& strains) {
  std::vector<Vec3> position;
  std::vector<Vec3> displacement;
  std::vector<std::uint32_t> id;
  std::vector<double> shear;
  std::vector<double> volumetric;
  std::vector<std::uint8_t> known;
  std::vector<double> turned;
  std::vector<double> radius;
  for (std::size_t n = 0; n < now.grains.size(); ++n) {
    const SavedGrain& grain = now.grains[n];
    position.push_back(grain.position);
    displacement.push_back(later[n] - start.grains[n].position);
    id.push_back(grain.id.get());
    shear.push_back(strains[n].shear);
    volumetric.push_back(strains[n].volumetric);
    known.push_back(strains[n].is_known() ? 1 : 0);
    turned.push_back(turn_between(start.grains[n].orientation, grain.orientation));
    radius.push_back(grain.equivalent_radius);
  }
  VtkPolyData data;
  data.points = vtk_array("Points", position);
  data.vertices = consecutive_cells(id.size(), 1);
  data.point_data = {vtk_array("id", id),
                     vtk_array("shear_strain", shear),
                     vtk_array("volumetric_strain", volumetric),
                     vtk_array("strain_is_known", known),
                     vtk_array("rotation", turned),
                     vtk_array("displacement", displacement),
                     vtk_array("equivalent_radius", radius)};
  const std::vector<double> time{now.time};
  const std::vector<std::uint64_t> from{start.step};
  data.field_data = {vtk_array("TimeValue", time), vtk_array("from_step", from)};
  write_vtp(path, data);
}

/// A line per bin: the step, f, the density and the count.
std::string distribution_lines(const SavedFields& fields, double width) {
  std::vector<double> sizes;
  for (const ContactRecord& contact : fields.contacts) {
    if (!contact.with_wall) sizes.push_back(norm(contact.force));
  }
  const ForceDistribution found = force_distribution(sizes, width);
  std::string lines;
  for (std::size_t bin = 0; bin < found.bins.size(); ++bin) {
    lines += fmt::format("{},{},{},{},{}\n", fields.step, found.mean, found.middle(bin),
                         found.density(bin), found.bins[bin]);
  }
  return lines;
}

}  // namespace

RunAnalysis analyse_run(
    const RunFolder& folder, const AnalysisOptions& options,
    const std::function<void(std::size_t done, std::size_t total)>& progressed) {
  const std::vector<std::uint64_t> saved = folder.field_steps("grains");
  if (saved.empty()) refuse(folder, "no fields were saved here", "Name the folder of a run.");
  RunAnalysis done;
  done.from = first_step(folder, options, saved);
  std::optional<SavedFields> first = readable_fields(folder, done.from, done);
  for (const std::uint64_t step : saved) {
    if (first || options.from || step <= done.from) continue;
    done.from = step;
    first = readable_fields(folder, step, done);
  }
  if (!first) refuse(folder, done.left_out.back(), "Give another step with --from.");
  const SavedFields& start = *first;
  const std::vector<Vec3> before = places(start);
  double diameter = 0;
  for (const SavedGrain& grain : start.grains) {
    diameter += 2 * grain.equivalent_radius / static_cast<double>(start.grains.size());
  }
  constexpr double diameters = 5;
  const double longest = options.longest_edge.value_or(diameters * diameter);
  std::string forces;
  if (start.has_contacts) forces = distribution_lines(start, options.bin_width);
  const auto later_steps = static_cast<std::size_t>(
      saved.end() - std::upper_bound(saved.begin(), saved.end(), done.from));
  std::vector<PvdEntry> entries;
  for (const std::uint64_t step : saved) {
    if (step <= done.from) continue;
    const std::optional<SavedFields> read = readable_fields(folder, step, done);
    if (!read) continue;
    const SavedFields& now = *read;
    const bool same =
        std::equal(start.grains.begin(), start.grains.end(), now.grains.begin(), now.grains.end(),
                   [](const SavedGrain& a, const SavedGrain& b) { return a.id == b.id; });
    if (!same) {
      refuse(folder, fmt::format("steps {} and {} have not the same grains", done.from, step),
             "Strains need all grains to stay; start after some have left.");
    }
    const std::vector<Vec3> later = places_later(start, now);
    const std::vector<LocalStrain> strains = local_strain(before, later, longest);
    write_strain(folder.root() / RunFolder::field_name("strain", step), start, now, later, strains);
    entries.push_back({now.time, RunFolder::field_name("strain", step), {}});
    done.strains.push_back(summary_of(step, strains));
    if (now.has_contacts) forces += distribution_lines(now, options.bin_width);
    if (progressed) progressed(entries.size(), later_steps);
  }
  if (entries.empty()) {
    refuse(folder, fmt::format("no step was saved after {}", done.from),
           "Strains are between two saved steps; give an earlier one with --from.");
  }
  done.strain_index = folder.index("strain");
  write_pvd(done.strain_index, entries);
  if (!forces.empty()) {
    done.force_distribution = folder.root() / "force_distribution.csv";
    write_file(done.force_distribution,
               "step,mean_force_N,force_over_mean,density,count\n" + forces);
  }
  return done;
}

}  // namespace reckon
