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
#include "reckon/math/portable.hpp"
#include "reckon/results/run_surfaces.hpp"
#include "reckon/scan/near_pairs.hpp"
#include "reckon/scan/scan_avatars.hpp"
#include "reckon/scene/placement_table.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::app {
namespace {

struct MovedOptions {
  std::string placement;
  std::string run;
  std::string output;
  bool json{false};
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

/// Pairs whose surfaces overlap.
struct Overlaps {
  std::size_t pairs{0};
  double deepest{0};  ///< [m]
};
Overlaps overlaps_of(const std::vector<ShapeView>& views, const std::vector<GrainState>& grains) {
  const auto pairs = near_pairs(views, grains, 0);
  Overlaps found{.pairs = pairs.size()};
  for (const NearPair& pair : pairs) found.deepest = std::max(found.deepest, -pair.gap);
  return found;
}

struct Movement {
  Spread moved;   ///< in diameters
  Spread turned;  ///< [deg]
  Overlaps before;
  Overlaps after;
};

void print(const Movement& m) {
  fmt::print("          {:>10} {:>10} {:>10}\n", "mean", "95 %", "max");
  fmt::print("moved     {:>10.5f} {:>10.5f} {:>10.5f} diameters\n", m.moved.mean, m.moved.high,
             m.moved.largest);
  fmt::print("turned    {:>10.4f} {:>10.4f} {:>10.4f} degrees\n", m.turned.mean, m.turned.high,
             m.turned.largest);
  fmt::print("before   {} pairs overlap, by {:.4g} m at most\n", m.before.pairs, m.before.deepest);
  fmt::print("after    {} pairs overlap, by {:.4g} m at most\n", m.after.pairs, m.after.deepest);
}

std::string as_json(const Movement& m) {
  JsonWriter json;
  json.begin_object();
  const auto spread = [&](const char* key, const Spread& values) {
    json.begin_object(key);
    json.value("mean", values.mean);
    json.value("percentile_95", values.high);
    json.value("most", values.largest);
    json.end();
  };
  const auto overlaps = [&](const char* key, const Overlaps& found) {
    json.begin_object(key);
    json.value("overlapping_pairs", found.pairs);
    json.value("deepest_overlap_m", found.deepest);
    json.end();
  };
  spread("moved_diameters", m.moved);
  spread("turned_degrees", m.turned);
  overlaps("before", m.before);
  overlaps("after", m.after);
  json.end();
  return json.text();
}

void compare(const MovedOptions& options) {
  const RunFolder folder{options.run};
  const auto steps = folder.checkpoint_steps();
  if (steps.empty()) {
    throw Error{{.place = options.run,
                 .problem = "there is no checkpoint here",
                 .reason = {},
                 .fix = "Name the folder of a run."}};
  }
  const Checkpoint checkpoint = read_checkpoint(folder.own(folder.checkpoint(steps.back())));
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
  if (!options.output.empty()) {
    require_own_file(options.output, text.substr(0, text.find('\n')), "table of moved grains");
    write_file(options.output, text);
  }
  const auto views = shape_views(library);
  const Movement movement{spread_of(moved), spread_of(turned), overlaps_of(views, before),
                          overlaps_of(views, after)};
  if (options.json) {
    fmt::print("{}", as_json(movement));
  } else {
    print(movement);
  }
}

}  // namespace

void add_grains_moved(CLI::App& grains) {
  CLI::App* command = grains.add_subcommand(
      "moved", "Measure how far a run moved the grains of a table, and their overlaps");
  command->footer("Example:\n  reckon grains moved sand/placement.csv relax.run");
  auto options = std::make_shared<MovedOptions>();
  command->add_option("placement", options->placement, "Table of poses, placement.csv")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("run", options->run, "Folder of a run that started from this table")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("-o,--output", options->output, "Write one line per grain to this .csv file");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->callback([=] { compare(*options); });
}

}  // namespace reckon::app
