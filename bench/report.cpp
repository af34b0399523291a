// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include "reckon/core/build_info.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::bench {
namespace {

/// Counts per grain and step, and what they are called in print and JSON.
struct Rate {
  const char* name;
  std::uint64_t ContactCounters::*count;
};
constexpr std::array rates{Rate{"pairs", &ContactCounters::pairs},
                           Rate{"due", &ContactCounters::due},
                           Rate{"touching_pairs", &ContactCounters::touching_pairs},
                           Rate{"touching_nodes", &ContactCounters::touching_nodes},
                           Rate{"tested_nodes", &ContactCounters::tested_nodes},
                           Rate{"cells_read", &ContactCounters::cells_read},
                           Rate{"lists_checked", &ContactCounters::lists_checked},
                           Rate{"lists_made", &ContactCounters::lists_made},
                           Rate{"listed_nodes", &ContactCounters::listed_nodes},
                           Rate{"searched_nodes", &ContactCounters::searched_nodes}};

struct Phase {
  const char* name;
  double PhaseTimes::*time;
};
constexpr std::array phases{Phase{"frames", &PhaseTimes::frames},
                            Phase{"lists", &PhaseTimes::lists},
                            Phase{"grain_contacts", &PhaseTimes::grain_contacts},
                            Phase{"wall_contacts", &PhaseTimes::wall_contacts},
                            Phase{"motion", &PhaseTimes::motion},
                            Phase{"agreement", &PhaseTimes::agreement}};

double per_grain_step(const BenchResult& result, std::uint64_t count) {
  const auto evaluations = static_cast<double>(result.counters.evaluations);
  return evaluations > 0
             ? static_cast<double>(count) / evaluations / static_cast<double>(result.grains)
             : 0;
}

std::string line_of(const char* engine, const Cost& cost) {
  std::string line =
      fmt::format("  {:5} {:8.0f} ns per grain and step |", engine, cost.ns_per_grain_step);
  for (const Phase& phase : phases) {
    line += fmt::format(" {} {:.0f}", phase.name, cost.phases.*phase.time);
  }
  return line + fmt::format(" | {} steps\n", cost.steps);
}

void write_cost(JsonWriter& json, const char* engine, const Cost& cost) {
  json.begin_object(engine);
  json.value("ns_per_grain_step", cost.ns_per_grain_step);
  json.value("steps", cost.steps);
  json.begin_object("phases_ns");
  for (const Phase& phase : phases) json.value(phase.name, cost.phases.*phase.time);
  json.end();
  json.end();
}

}  // namespace

std::string machine_name(SimdLevel simd) {
  std::ifstream processors{"/proc/cpuinfo"};
  std::string model = "unknown";
  for (std::string line; std::getline(processors, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      model = line.substr(colon + 2);
      break;
    }
  }
  std::string name;
  for (const char c : fmt::format("{} {}", model, name_of(resolve(simd)))) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) {
      name += static_cast<char>(std::tolower(letter));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  return name;
}

BenchReport make_report(const std::string& name, const WorkloadRequest& request,
                        const Workload& work, const MeasureOptions& options, BenchResult result) {
  return {.workload = name,
          .machine = machine_name(options.simd),
          .revision = std::string{build_info().revision},
          .threads = options.threads,
          .small = request.small,
          .storage = request.storage,
          .inertial_number = work.inertial_number,
          .solid_fraction = work.solid_fraction,
          .distinct_shapes = work.distinct_shapes,
          .paper_seconds = work.paper_seconds,
          .bandwidth = 0,
          .result = std::move(result)};
}

std::string as_text(const BenchReport& report) {
  const BenchResult& r = report.result;
  std::string text = fmt::format("{}: {} grains of {} distinct shapes", report.workload, r.grains,
                                 report.distinct_shapes);
  if (report.solid_fraction > 0)
    text += fmt::format(", solid fraction {:.3f}", report.solid_fraction);
  if (report.inertial_number > 0) {
    text += fmt::format(", inertial number {:.0e}", report.inertial_number);
  }
  if (report.storage == ShapeStorage::band) text += ", kept as bands";
  text += fmt::format("; {} thread{}, {}, {}\n", report.threads, report.threads > 1 ? "s" : "",
                      report.machine, report.revision);
  text += line_of("near", r.near);
  if (r.plain) {
    text += line_of("plain", *r.plain);
    const auto [low, high] = std::minmax_element(r.ratios.begin(), r.ratios.end());
    text += fmt::format("  plain / near {:.1f} (stretches {:.1f} to {:.1f}); bits {}\n", r.ratio,
                        *low, *high, r.same_bits ? "equal" : "DIFFER");
  }
  if (r.speedup) text += fmt::format("  {:.2f} times as fast as one thread\n", *r.speedup);
  text += "  per grain and step:";
  for (const Rate& rate : rates) {
    text += fmt::format(" {} {:.4g}", rate.name, per_grain_step(r, r.counters.*rate.count));
  }
  text += fmt::format("\n  pair lists made {} times in {} steps; {} lists of nodes on walls\n",
                      r.list_rebuilds, r.counters.evaluations, r.wall_counters.lists_made);
  text += fmt::format(
      "  bytes per grain: contacts {:.0f}, shapes {:.0f}; peak of the process "
      "{:.2f} GB\n",
      r.contact_bytes_per_grain, r.shape_bytes_per_grain, r.peak_resident_bytes / 1e9);
  if (report.bandwidth > 0) {
    text += fmt::format("  memory moves {:.1f} GB/s\n", report.bandwidth / 1e9);
  }
  if (report.paper_seconds > 0) {
    text += fmt::format("  1000 steps: {:.1f} s; the paper's {:.0f} s on one core of its machine\n",
                        r.seconds_per_1000_steps, report.paper_seconds);
  }
  return text;
}

std::string as_json(const BenchReport& report) {
  const BenchResult& r = report.result;
  JsonWriter json;
  json.begin_object();
  json.value("workload", report.workload);
  json.value("size", report.small ? "small" : "full");
  json.value("storage", report.storage == ShapeStorage::band ? "band" : "full");
  json.value("machine", report.machine);
  json.value("revision", report.revision);
  json.value("compiler", build_info().compiler);
  json.value("flags", build_info().flags);
  json.value("threads", report.threads);
  json.value("grains", r.grains);
  json.value("distinct_shapes", report.distinct_shapes);
  if (report.solid_fraction > 0) json.value("solid_fraction", report.solid_fraction);
  if (report.inertial_number > 0) json.value("inertial_number", report.inertial_number);
  write_cost(json, "near", r.near);
  if (r.plain) {
    write_cost(json, "plain", *r.plain);
    json.value("ratio", r.ratio);
    const auto [low, high] = std::minmax_element(r.ratios.begin(), r.ratios.end());
    json.value("ratio_lowest", *low);
    json.value("ratio_highest", *high);
    json.value("same_bits", r.same_bits);
  }
  if (r.speedup) json.value("speedup", *r.speedup);
  json.begin_object("per_grain_step");
  for (const Rate& rate : rates) {
    json.value(rate.name, per_grain_step(r, r.counters.*rate.count));
  }
  json.end();
  json.value("pair_lists_made", r.list_rebuilds);
  json.value("wall_lists_made", r.wall_counters.lists_made);
  json.value("contact_bytes_per_grain", r.contact_bytes_per_grain);
  json.value("shape_bytes_per_grain", r.shape_bytes_per_grain);
  json.value("peak_resident_bytes", r.peak_resident_bytes);
  json.value("bandwidth_bytes_per_second", report.bandwidth);
  json.value("seconds_per_1000_steps", r.seconds_per_1000_steps);
  if (report.paper_seconds > 0) json.value("paper_seconds_per_1000_steps", report.paper_seconds);
  json.end();
  return json.text();
}

}  // namespace reckon::bench
