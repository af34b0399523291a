// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/performance_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "reckon/text/human.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {
namespace {

struct Phase {
  const char* name;
  const char* meaning;
  double (*seconds)(const RankPerformance&);
};

constexpr std::array phases{Phase{"force", "pairs, touching nodes and their forces",
                                  [](const RankPerformance& r) {
                                    return r.phases.lists + r.phases.grain_contacts +
                                           r.phases.wall_contacts;
                                  }},
                            Phase{"border", "listing ghosts and waiting for their states",
                                  [](const RankPerformance& r) { return r.phases.border; }},
                            Phase{"migrate", "bringing grains to their owners",
                                  [](const RankPerformance& r) { return r.phases.migration; }},
                            Phase{"update", "sums, motion, and waiting for all ranks to agree",
                                  [](const RankPerformance& r) {
                                    return r.phases.frames + r.phases.motion + r.phases.agreement;
                                  }}};

/// Over the ranks.
struct Spread {
  double mean{0};
  double most{0};

  /// Largest over mean; 1 is even.
  [[nodiscard]] double imbalance() const { return mean > 0 ? most / mean : 1; }
};

template <class Value>
Spread spread(std::span<const RankPerformance> ranks, Value&& value) {
  Spread result;
  for (const RankPerformance& rank : ranks) {
    const auto v = static_cast<double>(value(rank));
    result.mean += v / static_cast<double>(ranks.size());
    result.most = std::max(result.most, v);
  }
  return result;
}

template <class Value>
std::uint64_t total(std::span<const RankPerformance> ranks, Value&& value) {
  std::uint64_t sum = 0;
  for (const RankPerformance& rank : ranks) sum += value(rank);
  return sum;
}

double per(std::uint64_t count, std::uint64_t of) {
  return of > 0 ? static_cast<double>(count) / static_cast<double>(of) : 0;
}

/// Sums over ranks, and what follows from them.
struct Summary {
  std::uint64_t machines{0};
  std::uint64_t steps{0};
  std::uint64_t bytes{0};     ///< of ghost updates
  std::uint64_t messages{0};  ///< likewise
  std::uint64_t migrated_grains{0};
  std::uint64_t migration_bytes{0};
  std::uint64_t migrations{0};
  double ghosts_per_grain{0};
  double pairs_per_grain{0};
  double pairs_twice{0};  ///< share of the pairs that two ranks compute
  Spread work;
  Spread force;
  double busy_seconds{0};  ///< of all phases, mean over ranks
};

Summary summarize(std::span<const RankPerformance> ranks) {
  Summary sum;
  if (ranks.empty()) return sum;
  const auto grain_steps = total(ranks, [](const auto& r) { return r.grain_steps; });
  const auto pair_steps = total(ranks, [](const auto& r) { return r.pair_steps; });
  const auto shared = total(ranks, [](const auto& r) { return r.shared_pair_steps; });
  sum.machines =
      total(ranks, [](const auto& r) { return std::uint64_t{r.rank_on_machine == 0 ? 1U : 0U}; });
  sum.steps = ranks.front().steps;
  sum.bytes = total(ranks, [](const auto& r) { return r.communication.update_bytes; });
  sum.messages = total(ranks, [](const auto& r) { return r.communication.update_messages; });
  sum.migrated_grains = total(ranks, [](const auto& r) { return r.communication.migrated_grains; });
  sum.migration_bytes = total(ranks, [](const auto& r) { return r.communication.migration_bytes; });
  sum.migrations = ranks.front().communication.migrations;
  sum.ghosts_per_grain =
      per(total(ranks, [](const auto& r) { return r.ghost_steps; }), grain_steps);
  // A pair that two ranks list is one pair.
  const std::uint64_t twice = shared / 2;
  sum.pairs_per_grain = per(pair_steps - twice, grain_steps);
  sum.pairs_twice = per(twice, pair_steps - twice);
  sum.work = spread(ranks, [](const auto& r) { return r.work; });
  sum.force = spread(ranks, phases[0].seconds);
  sum.busy_seconds = spread(ranks, [](const auto& r) { return r.phases.total(); }).mean;
  return sum;
}

double share(double part, double whole) { return whole > 0 ? part / whole : 0; }

}  // namespace

std::string performance_json(const PerformanceOfRun& run) {
  const Summary sum = summarize(run.ranks);
  JsonWriter json;
  json.begin_object();
  json.value("ranks", run.ranks.size());
  json.value("machines", sum.machines);
  json.value("grains", run.grains);
  json.value("steps", sum.steps);
  json.value("wall_s", run.wall_seconds);
  json.value("output_s", run.output_seconds);
  json.value("background_output_s", run.background_seconds);
  json.value("ns_per_grain_step",
             1e9 * share(run.wall_seconds, static_cast<double>(sum.steps * run.grains)));
  json.value("ghosts_per_grain", sum.ghosts_per_grain);
  json.value("listed_pairs_per_grain", sum.pairs_per_grain);
  json.value("pairs_computed_twice_share", sum.pairs_twice);
  json.value("update_bytes", sum.bytes);
  json.value("update_messages", sum.messages);
  json.value("migrations", sum.migrations);
  json.value("migrated_grains", sum.migrated_grains);
  json.value("migration_bytes", sum.migration_bytes);
  json.value("work_imbalance", sum.work.imbalance());
  json.value("force_time_imbalance", sum.force.imbalance());
  json.begin_array("rank");
  for (const RankPerformance& rank : run.ranks) {
    json.begin_object();
    for (const Phase& phase : phases) {
      json.value(std::string{phase.name} + "_s", phase.seconds(rank));
    }
    json.begin_object("phase_s");
    json.value("frames", rank.phases.frames);
    json.value("border", rank.phases.border);
    json.value("migration", rank.phases.migration);
    json.value("lists", rank.phases.lists);
    json.value("grain_contacts", rank.phases.grain_contacts);
    json.value("wall_contacts", rank.phases.wall_contacts);
    json.value("motion", rank.phases.motion);
    json.value("agreement", rank.phases.agreement);
    json.end();
    json.value("list_rebuilds", rank.list_rebuilds);
    json.value("grain_steps", rank.grain_steps);
    json.value("ghost_steps", rank.ghost_steps);
    json.value("pair_steps", rank.pair_steps);
    json.value("shared_pair_steps", rank.shared_pair_steps);
    json.value("work", rank.work);
    json.value("update_bytes", rank.communication.update_bytes);
    json.value("update_messages", rank.communication.update_messages);
    json.value("migrated_grains", rank.communication.migrated_grains);
    json.value("migration_bytes", rank.communication.migration_bytes);
    json.value("peak_memory_bytes", rank.peak_memory);
    json.value("shape_bytes_of_machine", rank.shape_bytes);
    json.value("threads", rank.threads);
    json.end();
  }
  json.end();
  json.end();
  return json.text();
}

std::string performance_table(const PerformanceOfRun& run) {
  if (run.ranks.empty()) return {};
  const Summary sum = summarize(run.ranks);
  const bool several = run.ranks.size() > 1;
  std::string text;
  const auto row = [&](std::string_view name, const Spread& seconds, std::string_view meaning) {
    text += fmt::format("  {:<8} {:>10} {:>6.1f} %", name, human_duration(seconds.mean),
                        100 * share(seconds.mean, run.wall_seconds));
    if (several) text += fmt::format("  slowest rank {:>10}", human_duration(seconds.most));
    text += fmt::format("  {}\n", meaning);
  };
  for (const Phase& phase : phases)
    row(phase.name, spread(run.ranks, phase.seconds), phase.meaning);
  row("output", {run.output_seconds, run.output_seconds},
      fmt::format("waiting for files; {} more were written meanwhile",
                  human_duration(run.background_seconds)));
  text += fmt::format(
      "  {:.3g} ns per grain and step; lists rebuilt every {:.3g} steps; {:.3g} "
      "listed pairs per grain\n",
      1e9 * share(run.wall_seconds, static_cast<double>(sum.steps * run.grains)),
      per(sum.steps, run.ranks.front().list_rebuilds), sum.pairs_per_grain);
  const auto memory = spread(run.ranks, [](const auto& r) { return r.peak_memory; });
  const auto shapes = spread(run.ranks, [](const auto& r) { return r.shape_bytes; });
  text += fmt::format("  memory {} per rank at most, shapes {} per machine\n",
                      human_bytes(static_cast<std::uint64_t>(memory.most)),
                      human_bytes(static_cast<std::uint64_t>(shapes.most)));
  if (!several) return text;
  text += fmt::format(
      "  {} ranks of {} on {}: work of the busiest {:.3g} times the mean; {:.3g} "
      "ghosts per grain; {:.2g} % of pairs computed twice\n",
      run.ranks.size(), counted(static_cast<std::uint64_t>(run.ranks.front().threads), "thread"),
      counted(static_cast<std::uint64_t>(sum.machines), "machine"), sum.work.imbalance(),
      sum.ghosts_per_grain, 100 * sum.pairs_twice);
  text += fmt::format("  sent {} in {} messages for ghosts, {} for {} migrating grains\n",
                      human_bytes(sum.bytes), human_count(sum.messages),
                      human_bytes(sum.migration_bytes), human_count(sum.migrated_grains));
  return text;
}

}  // namespace reckon
