// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "analyse_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "grains_parts.hpp"
#include "progress.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/results/run_analysis.hpp"
#include "reckon/results/run_verdict.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::app {

namespace {

struct AnalyseOptions {
  std::string folder;
  AnalysisOptions analysis;
  std::string longest_edge;
  bool json{false};
};

void print(const RunAnalysis& done, const RunVerdict& verdict) {
  fmt::print("{}", verdict_text(verdict));
  fmt::print("strain since step {}, around each grain\n", done.from);
  fmt::print("{:>12}  {:>12}  {:>12}  {:>12}\n", "step", "shear, mean", "shear, 90 %",
             "volumetric");
  for (const StrainSummary& strain : done.strains) {
    fmt::print("{:>12}  {:>12.4f}  {:>12.4f}  {:>12.4f}\n", strain.step, strain.shear,
               strain.largest, strain.volumetric);
  }
  const auto is_unknown = [](const StrainSummary& strain) { return std::isnan(strain.shear); };
  if (std::ranges::any_of(done.strains, is_unknown)) {
    fmt::print(
        "nan: no strain can be computed; there are too few grains, or all edges exceed "
        "--longest-edge\n");
  }
  fmt::print("open {}\n", done.strain_index.string());
  if (!done.force_distribution.empty()) {
    fmt::print("forces: {}\n", done.force_distribution.string());
  }
}

std::string as_json(const RunAnalysis& done, const RunVerdict& verdict) {
  JsonWriter json;
  json.begin_object();
  write_verdict(json, verdict);
  json.value("from_step", done.from);
  json.begin_array("strains");
  for (const StrainSummary& strain : done.strains) {
    json.begin_object();
    json.value("step", strain.step);
    json.value("shear_mean", strain.shear);
    json.value("shear_percentile_90", strain.largest);
    json.value("volumetric_mean", strain.volumetric);
    json.end();
  }
  json.end();
  json.value("strain_index", done.strain_index.string());
  json.value("force_distribution", done.force_distribution.string());
  json.begin_array("left_out");
  for (const std::string& reason : done.left_out) json.value(reason);
  json.end();
  json.end();
  return json.text();
}

void analyse(const AnalyseOptions& options) {
  AnalysisOptions wanted = options.analysis;
  if (!options.longest_edge.empty()) {
    wanted.longest_edge = parse_length("--longest-edge", options.longest_edge);
  }
  RunAnalysis done;
  {
    CountDisplay display{"saved times"};
    done = analyse_run(RunFolder{options.folder}, wanted,
                       [&](std::size_t made, std::size_t total) { display.show(made, total); });
  }
  for (const std::string& reason : done.left_out) {
    std::fputs(printable(fmt::format("left out: {}\n", reason)).c_str(), stderr);
  }
  const RunVerdict verdict = verdict_of(RunFolder{options.folder});
  if (options.json) {
    fmt::print("{}", as_json(done, verdict));
  } else {
    print(done, verdict);
  }
}

}  // namespace

void add_analyse_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "analyse", "Local strains and the distribution of contact forces from a run's saved fields");
  auto options = std::make_shared<AnalyseOptions>();
  command->add_option("run", options->folder, "Folder of a run")->required();
  command->add_option(
      "--from", options->analysis.from,
      "Reference step of the strains (default: the first saved step of the last stage)");
  command->add_option(
      "--longest-edge", options->longest_edge,
      "Tetrahedra with a longer edge are left out, e.g. 5mm (default: five mean diameters)");
  command
      ->add_option("--bin", options->analysis.bin_width,
                   "Width of a histogram bin, divided by the mean force")
      ->check(CLI::Range(1e-4, 1e4))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Answer in JSON");
  command->footer(
      "Strains are computed in a Delaunay triangulation of the grains' centres and averaged "
      "around\n"
      "each grain. They show shear bands. Open strain.pvd in ParaView to see them.\n"
      "force_distribution.csv has one line for each bin and saved step.\n\n"
      "Example:\n  reckon analyse triaxial.run");
  command->callback([options] { analyse(*options); });
}

}  // namespace reckon::app
