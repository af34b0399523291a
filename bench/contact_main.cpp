// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs one workload with the near engine and the plain one on the same state in the same process,
// and prints what a step costs. Only ratios within one run mean anything.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>

#include "reckon/core/error.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/parallel/threads.hpp"
#include "workloads.hpp"

namespace reckon::bench {
namespace {

/// ns per grain and step.
struct Cost {
  double total{0};    ///< of all threads; other programs do not count
  PhaseTimes phases;  ///< of the wall clock
};

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

Cost measure(Simulation& simulation, std::uint64_t steps) {
  const PhaseTimes before = simulation.phase_times();
  const double start = processor_seconds();
  for (std::uint64_t n = 0; n < steps; ++n) simulation.step();
  const double scale =
      1e9 / static_cast<double>(steps) / static_cast<double>(simulation.grains().size());
  const PhaseTimes after = simulation.phase_times();
  const auto part = [&](double PhaseTimes::*phase) {
    return (after.*phase - before.*phase) * scale;
  };
  const double total = (processor_seconds() - start) * scale;
  return {total,
          {.frames = part(&PhaseTimes::frames),
           .lists = part(&PhaseTimes::lists),
           .grain_contacts = part(&PhaseTimes::grain_contacts),
           .wall_contacts = part(&PhaseTimes::wall_contacts),
           .loads = part(&PhaseTimes::loads),
           .motion = part(&PhaseTimes::motion),
           .agreement = part(&PhaseTimes::agreement)}};
}

void print(const char* name, const Cost& cost) {
  fmt::print(
      "{:6} {:9.0f} | frames {:5.0f}  lists {:5.0f}  grains {:8.0f}  walls {:6.0f}  loads "
      "{:5.0f}  motion {:5.0f}  agreement {:5.0f}\n",
      name, cost.total, cost.phases.frames, cost.phases.lists, cost.phases.grain_contacts,
      cost.phases.wall_contacts, cost.phases.loads, cost.phases.motion, cost.phases.agreement);
}

void print(const ContactCounters& before, const ContactCounters& after, std::uint64_t list_rebuilds,
           double grains) {
  const auto evaluations = static_cast<double>(after.evaluations - before.evaluations);
  const auto rate = [&](std::uint64_t ContactCounters::*count) {
    return static_cast<double>(after.*count - before.*count) / evaluations / grains;
  };
  using C = ContactCounters;
  fmt::print(
      "per grain and step: pairs {:.2f}, awake {:.2f}, touching {:.2f}; nodes tested {:.2f}, "
      "touching {:.2f}, cells read {:.4f}\n",
      rate(&C::pairs), rate(&C::awake), rate(&C::touching_pairs), rate(&C::tested_nodes),
      rate(&C::touching_nodes), rate(&C::cells_read));
  const double made = rate(&C::lists_made);
  fmt::print(
      "near lists: checked {:.5f}, made {:.5f} ({:.2g} per pair), {:.1f} nodes each of {:.0f} "
      "searched; pair lists made {} times\n",
      rate(&C::lists_checked), made, made / rate(&C::pairs),
      made > 0 ? rate(&C::listed_nodes) / made : 0, made > 0 ? rate(&C::searched_nodes) / made : 0,
      list_rebuilds);
}

bool same_bits(const SimulationState& a, const SimulationState& b) {
  if (a.grains != b.grains || a.pair_springs.size() != b.pair_springs.size()) return false;
  for (std::size_t p = 0; p < a.pair_springs.size(); ++p) {
    if (a.pair_springs[p].springs != b.pair_springs[p].springs) return false;
  }
  return true;
}

struct Options {
  std::uint32_t grains{0};
  std::uint64_t near_steps{0};
  std::uint64_t plain_steps{0};
  int threads{1};
  std::string packing_file;
};

void run(const WorkloadKind& kind, const Options& options) {
  Stopwatch watch;
  const std::uint32_t grains = options.grains > 0 ? options.grains : kind.grains;
  Workload work = kind.make(grains, options.packing_file);
  fmt::print("{}: {}; {} grains, made in {:.1f} s\n", kind.name, kind.meaning, grains, watch.lap());
  if (work.inertial_number > 0) {
    fmt::print("inertial number {:.1e}, solid fraction {:.3f}\n", work.inertial_number,
               work.solid_fraction);
  }
  const bool whole = work.whole_run > 0;
  const std::uint64_t plain_steps = whole ? work.whole_run : options.plain_steps;
  const std::uint64_t near_steps = whole ? work.whole_run : options.near_steps;
  if (!whole) {
    Simulation warm_up{work.setup, work.state};
    for (int n = 0; n < 1000; ++n) warm_up.step();
    work.state = warm_up.state();
  }
  work.setup.engine = ContactEngine::near;
  Simulation near{work.setup, work.state};
  Simulation check{work.setup, work.state};
  if (!whole) static_cast<void>(measure(near, 50));  // lists are made
  const ContactCounters before = near.grain_contacts().counters();
  const std::uint64_t rebuilds_before = near.list_rebuilds();
  const Cost fast = measure(near, near_steps);
  print("near", fast);
  print(before, near.grain_contacts().counters(), near.list_rebuilds() - rebuilds_before,
        static_cast<double>(grains));
  if (plain_steps > 0) {
    work.setup.engine = ContactEngine::plain;
    Simulation plain{work.setup, work.state};
    const Cost slow = measure(plain, plain_steps);
    print("plain", slow);
    for (std::uint64_t n = 0; !whole && n < plain_steps; ++n) check.step();
    const bool same = same_bits(whole ? near.state() : check.state(), plain.state());
    fmt::print("plain / near {:.1f}; bits {}\n", slow.total / fast.total,
               same ? "equal" : "DIFFER");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace reckon::bench

int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape): ends with its text
  using namespace reckon;
  CLI::App app{"Costs of a step with the near and the plain contact engine"};
  std::string name = "dense";
  bench::Options options{.near_steps = 1000, .plain_steps = 20};
  app.add_option("workload", name, "dense, dense-fine, graded or settle");
  app.add_option("--grains", options.grains, "Number of grains (0: the workload's own)");
  app.add_option("--near-steps", options.near_steps, "Steps to measure with the near engine");
  app.add_option("--plain-steps", options.plain_steps, "Steps to measure with the plain engine");
  app.add_option("--packing", options.packing_file, "Keep the packing in this file");
  app.add_option("--threads", options.threads, "Threads");
  CLI11_PARSE(app, argc, argv);
  set_thread_count(options.threads);
  try {
    for (const bench::WorkloadKind& kind : bench::workload_kinds()) {
      if (kind.name == name) bench::run(kind, options);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
