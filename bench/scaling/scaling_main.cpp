// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// How work and messages are shared out over ranks: counted for any number of simulated ranks, timed
// for the ranks that mpirun starts. Every subcommand prints a table as CSV.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bin_counts.hpp"
#include "measured.hpp"
#include "paper_tables.hpp"
#include "reckon/core/error.hpp"
#include "reckon/domain/decomposition_names.hpp"
#include "reckon/parallel/threads.hpp"
#include "virtual_ranks.hpp"

namespace reckon::bench {
namespace {

GridCut paper_cut(double edge, int ranks) {
  return cut_grid(Region{{0, 0, 0}, {edge, edge, edge}}, ranks, paper::bin_size);
}

/// The bins of the paper's Tables 2 and 3 beside those of this program's grid.
void print_bins() {
  fmt::print(
      "table,edge,ranks,blocks,paper_theoretical,theoretical,paper_actual,actual,paper_seconds\n");
  const auto row = [](const char* table, double edge, int ranks, int theoretical, int actual,
                      double seconds) {
    const GridCut cut = paper_cut(edge, ranks);
    const BinCounts bins = count_bins(cut);
    fmt::print("{},{},{},{}x{}x{},{},{},{},{},{}\n", table, edge, ranks, cut.blocks[0],
               cut.blocks[1], cut.blocks[2], theoretical, bins.most_owned, actual,
               bins.most_with_halo, seconds);
  };
  for (const paper::BinRow& r : paper::table_2) {
    row("2", paper::table_2_edge, r.ranks, r.theoretical_bins, r.actual_bins, r.force_seconds);
  }
  for (const paper::WeakRow& r : paper::table_3) {
    row(fmt::format("3.{}", r.series).c_str(), r.edge, r.ranks, r.theoretical_bins, r.actual_bins,
        r.seconds);
  }
}

void print_load_columns() {
  fmt::print(
      "assembly,grains,decomposition,ranks,most_work,work_ratio,speed_up,idle_ranks,most_grains,"
      "most_pairs,"
      "ghosts_per_rank,most_ghosts,most_bytes_per_step,most_messages_per_step,pairs,"
      "computed_twice\n");
}

void print_load(const Assembly& assembly, DecompositionKind kind, int ranks) {
  const LoadSummary s = summarize(share_out(assembly, kind, ranks));
  fmt::print("{},{},{},{},{:.0f},{:.4f},{:.2f},{},{},{},{:.1f},{},{},{},{},{:.4f}\n", assembly.name,
             assembly.positions.size(), name_of(kind), ranks, s.most_work, s.work_ratio, s.speed_up,
             s.idle_ranks, s.most_grains, s.most_pairs, s.ghosts_per_rank, s.most_ghosts,
             s.most_bytes, s.most_messages, s.pairs, s.computed_twice);
  std::fflush(stdout);
}

/// Grains at rest in a closed box under pressure, from a simulation.
Assembly squeezed_cube(const WorkloadRequest& request) {
  const Workload work = make_workload("dense", request);
  Assembly assembly;
  assembly.name = "squeezed";
  assembly.skin = work.setup.skin;
  for (const GrainState& grain : work.state.grains) {
    assembly.positions.push_back(grain.position);
    assembly.radii.push_back(work.setup.shapes.views()[grain.shape.get()].bounding_radius);
    assembly.reach = std::max(assembly.reach, 2 * assembly.radii.back() + assembly.skin);
  }
  assembly.domain = bounding_region(assembly.positions);
  return assembly;
}

struct Options {
  std::string assembly{"cube"};
  std::uint32_t grains{4096};
  double edge{200};
  std::vector<int> ranks{1, 2, 4, 8, 16, 32, 64};
  int most_ranks{512};
  int threads{1};
  std::string decomposition;
  MeasuredRun run;
};

Assembly make_assembly(const Options& options) {
  if (options.assembly == "heap") return cone_heap(options.grains);
  if (options.assembly == "squeezed") {
    return squeezed_cube({.grains = options.grains, .cache = options.run.request.cache});
  }
  if (options.assembly == "paper") {
    Assembly assembly = packed_cube(options.grains, options.edge, paper::bin_size);
    assembly.name = "paper";
    return assembly;
  }
  return dense_cube(options.grains);
}

void print_counts(const Options& options) {
  const Assembly assembly = make_assembly(options);
  print_load_columns();
  for (const DecompositionKind kind : {DecompositionKind::grid, DecompositionKind::balanced}) {
    for (const int ranks : options.ranks) print_load(assembly, kind, ranks);
  }
}

/// The assemblies of the paper's Table 3: as many grains a rank at every number of ranks.
void print_weak(const Options& options) {
  print_load_columns();
  for (const paper::WeakRow& row : paper::table_3) {
    if (row.ranks > options.most_ranks) continue;
    Assembly assembly =
        packed_cube(static_cast<std::uint32_t>(row.grains), row.edge, paper::bin_size);
    assembly.name = fmt::format("series {}", row.series);
    print_load(assembly, DecompositionKind::grid, row.ranks);
    print_load(assembly, DecompositionKind::balanced, row.ranks);
  }
}

void print_measured(Options& options, const Communicator& ranks) {
  options.run.decomposition = decomposition_named(options.decomposition).value();
  const std::string line = measure(options.run, ranks);
  if (ranks.is_root()) fmt::print("{}\n", line);
}

}  // namespace
}  // namespace reckon::bench

int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape): ends with its text
  using namespace reckon;
  const ParallelSession session{argc, argv};
  CLI::App app{"How work is shared out over ranks, as CSV"};
  app.require_subcommand(1);
  bench::Options options;
  app.add_option("--threads", options.threads, "Threads of each rank");

  const auto* bins = app.add_subcommand("bins", "Bins of the paper's Tables 2 and 3");
  auto* count = app.add_subcommand("count", "Loads of simulated ranks");
  count->add_option("assembly", options.assembly, "cube, heap, squeezed or paper")
      ->check(CLI::IsMember({"cube", "heap", "squeezed", "paper"}));
  count->add_option("--grains", options.grains, "Number of grains");
  count->add_option("--edge", options.edge, "Edge of the cube of \"paper\"");
  count->add_option("--ranks", options.ranks, "Numbers of ranks")->delimiter(',');
  count->add_option("--cache", options.run.request.cache, "Folder that keeps packings");
  auto* weak = app.add_subcommand("weak", "Loads of the assemblies of the paper's Table 3");
  weak->add_option("--most-ranks", options.most_ranks, "Leave out rows with more ranks");
  auto* columns = app.add_subcommand("columns", "Names of the columns that measure prints");
  auto* measured = app.add_subcommand("measure", "Times the ranks that mpirun started");
  measured->add_option("workload", options.run.workload, "A workload of reckon bench");
  measured->add_option("--grains", options.run.request.grains, "0: as many as the workload has");
  measured->add_option("--warm-up", options.run.warm_up, "Steps before the clock starts");
  measured->add_option("--steps", options.run.steps, "Steps that are timed");
  measured->add_option("--exchange-batches", options.run.exchange_batches,
                       "Batches of ghost updates that are timed alone; the fastest counts");
  std::vector<std::string> decompositions;
  decompositions.reserve(decomposition_names.size());
  for (const auto& known : decomposition_names) decompositions.emplace_back(known.first);
  measured->add_option("--decomposition", options.decomposition, "How grains are shared out")
      ->default_val("balanced")
      ->check(CLI::IsMember(decompositions));
  measured->add_option("--cache", options.run.request.cache, "Folder that keeps packings");
  CLI11_PARSE(app, argc, argv);
  set_thread_count(options.threads);
  try {
    if (bins->parsed()) bench::print_bins();
    if (count->parsed()) bench::print_counts(options);
    if (weak->parsed()) bench::print_weak(options);
    if (columns->parsed()) fmt::print("{}\n", bench::measured_columns());
    if (measured->parsed()) bench::print_measured(options, session.world());
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    session.world().abort(1);
  }
  return 0;
}
