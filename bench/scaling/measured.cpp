// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reckon/core/error.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/domain/decomposition_names.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon::bench {
namespace {

double sum(const Communicator& ranks, double value) {
  constexpr double unit = 1e-9;
  std::int64_t units = std::llround(value / unit);
  ranks.sum({&units, 1});
  return static_cast<double>(units) * unit;
}

/// Ghost update and reduction of a plain step alone, all ranks in step, in the fastest of many
/// batches [s]: their cost when no rank waits for the work of another rank or for another program.
double exchange_alone(const Simulation& simulation, const SimulationState& state, int batches) {
  constexpr int repeats = 50;
  const Communicator& ranks = simulation.distribution().ranks();
  const SimulationSetup& setup = simulation.setup();
  auto grain_count = static_cast<std::int64_t>(state.grains.size());
  ranks.sum({&grain_count, 1});
  const auto count = static_cast<std::size_t>(grain_count);
  Distribution distribution{ranks, setup.decomposition, count, count};
  Grains grains;
  for (const GrainState& grain : state.grains) grains.push_back(grain);
  GrainContacts no_contacts{setup.contact};
  WallContacts no_walls{setup.walls};
  double radius = 0;
  for (const ShapeView& shape : simulation.shapes()) {
    radius = std::max(radius, shape.bounding_radius);
  }
  const std::vector<double> costs(grains.size(), 1.0);
  distribution.redistribute(grains, no_contacts, no_walls, simulation.shapes(), costs,
                            2 * radius + setup.skin);
  distribution.list_ghosts(grains);
  double fastest = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < batches; ++batch) {
    ranks.barrier();
    Stopwatch watch;
    for (int n = 0; n < repeats; ++n) {
      distribution.start_update(grains);
      distribution.finish_update();
      static_cast<void>(ranks.max(0));
    }
    fastest = std::min(fastest, watch.lap() / repeats);
  }
  return fastest;
}

struct Ratio {
  double most;
  double mean;
};

Ratio over_ranks(const Communicator& ranks, double value) {
  return {ranks.max(value), sum(ranks, value) / ranks.size()};
}

}  // namespace

std::string measured_columns() {
  return "workload,grains,ranks,threads,decomposition,steps,step_us,grain_contacts_us,walls_us,"
         "frames_motion_us,lists_us,border_us,migration_us,agreement_us,exchange_alone_us,"
         "list_rebuilds,migrated_grains,most_grains,most_ghosts,most_bytes_per_step,"
         "most_messages_per_step,pairs_ratio,tested_nodes_ratio";
}

std::string measure(const MeasuredRun& run, const Communicator& ranks) {
  if (ranks.is_root() && !run.request.cache.empty()) {
    static_cast<void>(make_workload(run.workload, run.request));
  }
  ranks.barrier();  // a packing to keep is kept now
  Workload work = make_workload(run.workload, run.request);
  work.setup.decomposition = run.decomposition;
  const std::size_t grain_count = work.state.grains.size();
  if (!ranks.is_root()) work.state = {};
  Simulation simulation{work.setup, work.state, ranks};
  for (std::uint64_t n = 0; n < run.warm_up; ++n) simulation.step();

  const PhaseTimes before = simulation.phase_times();
  const ContactCounters contacts_before = simulation.grain_contacts().counters();
  const CommunicationCounters messages_before = simulation.distribution().counters();
  const std::uint64_t rebuilds_before = simulation.list_rebuilds();
  ranks.barrier();
  Stopwatch watch;
  for (std::uint64_t n = 0; n < run.steps; ++n) simulation.step();
  ranks.barrier();
  const double seconds = ranks.max(watch.lap());

  const PhaseTimes after = simulation.phase_times();
  const auto steps = static_cast<double>(run.steps);
  const auto phase = [&](double PhaseTimes::*part) {
    return 1e6 * sum(ranks, after.*part - before.*part) / ranks.size() / steps;
  };
  using P = PhaseTimes;
  const double contact_time = phase(&P::grain_contacts);
  const double wall_time = phase(&P::wall_contacts);
  const double motion_time = phase(&P::frames) + phase(&P::motion);
  const double list_time = phase(&P::lists);
  const double border_time = phase(&P::border);
  const double migration_time = phase(&P::migration);
  const double agreement_time = phase(&P::agreement);
  const CommunicationCounters& messages = simulation.distribution().counters();
  const ContactCounters& contacts = simulation.grain_contacts().counters();
  const auto updates =
      static_cast<double>(std::max<std::uint64_t>(messages.updates - messages_before.updates, 1));
  const auto count = [&](std::uint64_t later, std::uint64_t earlier) {
    return over_ranks(ranks, static_cast<double>(later - earlier));
  };
  const Ratio pairs = count(contacts.pairs, contacts_before.pairs);
  const Ratio nodes = count(contacts.tested_nodes, contacts_before.tested_nodes);
  const Ratio bytes = count(messages.update_bytes, messages_before.update_bytes);
  const Ratio sent = count(messages.update_messages, messages_before.update_messages);
  const Ratio grains = count(simulation.grains().size(), 0);
  const Ratio ghosts = count(simulation.distribution().ghosts().size(), 0);
  const double migrated =
      ranks.size() * count(messages.migrated_grains, messages_before.migrated_grains).mean;
  const double alone =
      1e6 * ranks.max(exchange_alone(simulation, simulation.state(), run.exchange_batches));
  if (!ranks.is_root()) return {};
  return fmt::format(
      "{},{},{},{},{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{},{:.0f},"
      "{:.0f},{:.0f},{:.0f},{:.0f},{:.3f},{:.3f}",
      run.workload, grain_count, ranks.size(), thread_count(), name_of(run.decomposition),
      run.steps, 1e6 * seconds / steps, contact_time, wall_time, motion_time, list_time,
      border_time, migration_time, agreement_time, alone,
      simulation.list_rebuilds() - rebuilds_before, migrated, grains.most, ghosts.most,
      bytes.most / updates, sent.most / updates, pairs.most / pairs.mean, nodes.most / nodes.mean);
}

}  // namespace reckon::bench
