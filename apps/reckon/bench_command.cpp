// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "exit_codes.hpp"
#include "grains_parts.hpp"
#include "reckon/core/file.hpp"
#include "reckon/parallel/threads.hpp"
#include "report.hpp"
#include "thread_limit.hpp"

namespace reckon::app {
namespace {

struct BenchOptions {
  std::vector<std::string> workloads;
  std::string size{"full"};
  std::string simd{"auto"};
  std::uint32_t grains{0};
  int threads{1};
  ShapeStorage storage{ShapeStorage::full};
  std::string cache;
  std::string save;
  bool no_plain{false};
  bool json{false};
  bool quiet{false};
};

SimdLevel simd_level(const std::string& name) {
  for (const SimdLevel level : simd_levels_here()) {
    if (name_of(level) == name) return level;
  }
  return SimdLevel::automatic;
}

std::string list_of_workloads() {
  std::string text = "Workloads:\n";
  for (const bench::WorkloadKind& kind : bench::workload_kinds()) {
    text += fmt::format("  {:16} {:6} grains; {}\n", kind.name, kind.grains, kind.meaning);
  }
  return text;
}

bool run(const std::string& name, const BenchOptions& options) {
  const auto say = [&](const std::string& text) {
    if (options.quiet) return;
    fmt::print(stderr, "{}: {}\n", name, text);
  };
  const bench::WorkloadRequest request{options.size == "small", options.grains, options.cache,
                                       options.storage};
  const bench::MeasureOptions measuring{options.threads, simd_level(options.simd),
                                        !options.no_plain};
  say("making shapes and grains");
  const bench::Workload work = bench::make_workload(name, request);
  bench::BenchReport report =
      bench::make_report(name, request, work, measuring, bench::measure(work, measuring, say));
  if (!request.small) report.bandwidth = bench::memory_bandwidth();
  std::fputs((options.json ? as_json(report) : as_text(report)).c_str(), stdout);
  std::fflush(stdout);
  if (!options.save.empty()) {
    const std::filesystem::path folder{options.save};
    std::filesystem::create_directories(folder);
    const std::string storage = options.storage == ShapeStorage::band ? "-band" : "";
    const std::string threads =
        options.threads > 1 ? fmt::format("-{}-threads", options.threads) : "";
    write_file(folder / fmt::format("{}{}.{}{}.json", name, storage, report.machine, threads),
               as_json(report));
  }
  return report.result.same_bits;
}

void bench(const BenchOptions& options) {
  set_thread_count(options.threads);
  if (!options.cache.empty()) std::filesystem::create_directories(options.cache);
  bool same_bits = true;
  for (const std::string& name : options.workloads) same_bits = run(name, options) && same_bits;
  if (same_bits) return;
  fmt::print(stderr,
             "reckon: error: the two engines gave different results; they must be equal to the "
             "last bit\n");
  throw CLI::RuntimeError{run_failed};
}

}  // namespace

void add_bench_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "bench", "Measure the time of a step on this machine, and compare with the plain engine");
  auto options = std::make_shared<BenchOptions>();
  std::vector<std::string> names;
  for (const bench::WorkloadKind& kind : bench::workload_kinds()) names.push_back(kind.name);
  command->add_option("workload", options->workloads, "Workloads to run, one or more")
      ->required()
      ->check(CLI::IsMember(names));
  command->add_option("--size", options->size, "small: few grains and steps, for a first try")
      ->check(CLI::IsMember({"full", "small"}))
      ->capture_default_str();
  command->add_option("--grains", options->grains,
                      "Number of grains (default: that of the workload)");
  command
      ->add_option("--threads", options->threads,
                   "Number of threads; above 1, one thread is measured too")
      ->check(CLI::Range(1, most_threads))
      ->capture_default_str();
  std::vector<std::string> levels{"auto"};
  for (const SimdLevel level : simd_levels_here()) levels.emplace_back(name_of(level));
  // The choices depend on the machine; the reference must not.
  command
      ->add_option(
          "--simd", options->simd,
          "Instructions that the search for near nodes uses: auto, scalar, avx2, avx512 or neon")
      ->check(CLI::IsMember(levels).description(""))
      ->capture_default_str();
  add_storage_option(*command, options->storage);
  command->add_option("--cache", options->cache, "Keep packings in this folder, and reuse them");
  command->add_option("--save", options->save, "Also write WORKLOAD.MACHINE.json into this folder");
  command->add_flag("--no-plain", options->no_plain, "Do not run the plain engine");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->add_flag("--quiet", options->quiet, "Print no progress");
  command->footer(list_of_workloads() +
                  "\nExample:\n"
                  "  reckon bench dense settle --cache /tmp/packings\n\n"
                  "If other programs use the machine too, compare only ratios within one run.");
  command->callback([options] { bench(*options); });
}

}  // namespace reckon::app
