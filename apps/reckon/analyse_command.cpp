// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "analyse_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "reckon/io/run_analysis.hpp"

namespace reckon::app {

void add_analyse_command(CLI::App& app) {
  struct Options {
    std::string folder;
    AnalysisOptions analysis;
    double edge_mm{0};
  };
  CLI::App* command = app.add_subcommand(
      "analyse", "Local strains and the distribution of contact forces from a run's saved fields");
  auto options = std::make_shared<Options>();
  command->add_option("run", options->folder, "Folder of a run")->required();
  command->add_option("--from", options->analysis.from,
                      "Step that strains are counted from; by default the first saved in the last "
                      "stage");
  command
      ->add_option("--longest-edge", options->edge_mm,
                   "Of the tetrahedra that count [mm]; 0: five mean diameters of grains")
      ->check(CLI::Range(0.0, 1e12))
      ->capture_default_str();
  command
      ->add_option("--bin", options->analysis.bin_width,
                   "Width of the bins of forces, over the mean force")
      ->check(CLI::Range(1e-4, 1e4))
      ->capture_default_str();
  command->footer(
      "Strains are those of a Delaunay triangulation of the grains' centres, averaged around each\n"
      "grain; they show shear bands. strain.pvd opens them in ParaView, force_distribution.csv "
      "has\n"
      "a line per bin and saved step.\n\n"
      "Example:\n  reckon analyse triaxial.run");
  command->callback([options] {
    if (options->edge_mm > 0) options->analysis.longest_edge = 1e-3 * options->edge_mm;
    const RunAnalysis done = analyse_run(RunFolder{options->folder}, options->analysis);
    fmt::print("strain since step {}, around each grain\n", done.from);
    fmt::print("{:>12}  {:>12}  {:>12}  {:>12}\n", "step", "shear, mean", "shear, 90 %",
               "volumetric");
    for (const StrainSummary& strain : done.strains) {
      fmt::print("{:>12}  {:>12.4f}  {:>12.4f}  {:>12.4f}\n", strain.step, strain.shear,
                 strain.largest, strain.volumetric);
    }
    fmt::print("open {}\n", done.strain_index.string());
    if (!done.force_distribution.empty()) {
      fmt::print("forces: {}\n", done.force_distribution.string());
    }
  });
}

}  // namespace reckon::app
