// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "grains_parts.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/io/placement_table.hpp"
#include "reckon/io/run_surfaces.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/scan/near_pairs.hpp"
#include "reckon/scan/scan_avatars.hpp"

namespace reckon::app {
namespace {

struct Options {
  std::string placement;
  std::string run;
  std::string output;
};

/// The angle of the smallest turn from one orientation to another [rad].
double angle_between(const Quaternion& a, const Quaternion& b) {
  const Quaternion turn = conjugate(a) * b;
  return 2 * std::atan2(norm(Vec3{turn.x, turn.y, turn.z}), std::abs(turn.w));
}

/// Mean, 95th of a hundred, and largest.
struct Spread {
  double mean{0};
  double high{0};
  double largest{0};
};
Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Spread spread;
  for (const double value : values) spread.mean += value / static_cast<double>(values.size());
  spread.high = values[(values.size() - 1) * 95 / 100];
  spread.largest = values.back();
  return spread;
}

void print_overlaps(const char* when, const std::vector<ShapeView>& views,
                    const std::vector<GrainState>& grains) {
  const auto pairs = near_pairs(views, grains, 0);
  double deepest = 0;
  for (const NearPair& pair : pairs) deepest = std::max(deepest, -pair.gap);
  fmt::print("{}   {} pairs overlap, by {:.4g} m at most\n", when, pairs.size(), deepest);
}

void compare(const Options& options) {
  const RunFolder folder{options.run};
  const auto steps = folder.checkpoint_steps();
  if (steps.empty()) {
    throw Error{{.place = options.run,
                 .problem = "there is no checkpoint here",
                 .reason = {},
                 .fix = "Name the folder of a run."}};
  }
  const Checkpoint checkpoint = read_checkpoint(folder.checkpoint(steps.back()));
  const ShapeCatalog catalog = shapes_of(checkpoint, options.run);
  const auto before = read_placement(options.placement, catalog.size());
  const auto& after = checkpoint.state.grains;
  if (before.size() != after.size()) {
    throw Error{{.place = options.run,
                 .problem = "the run has other grains than the table",
                 .reason = fmt::format("{} and {}", after.size(), before.size()),
                 .fix = "Name the table that the run's scene names."}};
  }
  ShapeLibrary library;
  for (std::size_t s = 0; s < catalog.size(); ++s) {
    library.push_back(catalog.read(ShapeId{static_cast<std::uint32_t>(s)}));
  }
  std::vector<double> moved;
  std::vector<double> turned;
  std::string text = "grain,moved_m,moved_diameters,turned_degrees\n";
  for (std::size_t n = 0; n < before.size(); ++n) {
    const double volume = library[after[n].shape.get()].mass.volume;
    const double diameter = portable::cbrt(6 * volume / std::numbers::pi);
    const double distance = norm(after[n].position - before[n].position);
    const double angle =
        180 / std::numbers::pi * angle_between(before[n].orientation, after[n].orientation);
    moved.push_back(distance / diameter);
    turned.push_back(angle);
    text += fmt::format("{},{:.6g},{:.6g},{:.6g}\n", n, distance, distance / diameter, angle);
  }
  if (!options.output.empty()) write_file(options.output, text);
  const Spread way = spread_of(moved);
  const Spread turn = spread_of(turned);
  fmt::print("          {:>10} {:>10} {:>10}\n", "mean", "95 %", "most");
  fmt::print("moved     {:>10.5f} {:>10.5f} {:>10.5f} diameters\n", way.mean, way.high,
             way.largest);
  fmt::print("turned    {:>10.4f} {:>10.4f} {:>10.4f} degrees\n", turn.mean, turn.high,
             turn.largest);
  const auto views = shape_views(library);
  print_overlaps("before", views, before);
  print_overlaps("after ", views, after);
}

}  // namespace

void add_grains_moved(CLI::App& grains) {
  CLI::App* command = grains.add_subcommand(
      "moved", "How far a run has moved grains from where a table placed them, and what overlaps");
  command->footer("Example:\n  reckon grains moved sand/placement.csv sand/relax.run");
  auto options = std::make_shared<Options>();
  command->add_option("placement", options->placement, "Table of poses")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("run", options->run, "Folder of a run that began with it")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("-o,--output", options->output, "Write a line per grain to this .csv");
  command->callback([=] { compare(*options); });
}

}  // namespace reckon::app
