// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/run_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/output/history.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scene/node_spacing.hpp"
#include "reckon/text/human.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {
namespace {

// A dense assembly, assumed in the estimates of memory and output.
constexpr std::uint64_t pairs_per_grain = 3;
constexpr std::uint64_t listed_per_grain = 10;
constexpr std::uint64_t nodes_per_pair = 10;
constexpr double disk_rate = 2e8;  // [bytes/s]
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void describe_assembly(const LoadedScene& scene, const PreparedScene& prepared, RunPlan& plan) {
  plan.grains = scene.grains.size();
  plan.shapes = scene.shapes.size();
  plan.walls = prepared.setup.walls.size();
  plan.smallest_diameter = std::numeric_limits<double>::infinity();
  plan.density_scaling = scene.config.material.density_scaling;
  std::set<ShapeId> in_use;
  for (const GrainState& grain : scene.grains) {
    const ShapeOutline& shape = scene.shapes[grain.shape.get()].outline;
    in_use.insert(grain.shape);
    plan.nodes += shape.nodes;
    plan.solid_mass += scene.config.material.density * shape.mass.volume;
    plan.smallest_diameter = std::min(plan.smallest_diameter, 2 * shape.bounding_radius);
    plan.largest_diameter = std::max(plan.largest_diameter, 2 * shape.bounding_radius);
  }
  plan.coarse_nodes = coarse_nodes(scene);
  plan.shapes_in_use = in_use.size();
  for (const ShapeId shape : in_use) {
    plan.memory_shapes += scene.shapes[shape.get()].outline.memory();
  }
  if (const auto& membrane = prepared.setup.membrane) {
    const auto poses = poses_at(prepared.setup.walls, {}, 0, prepared.setup.time_step);
    if (const auto mould = closed_cylinder(prepared.setup.walls, poses, membrane->mould)) {
      plan.membrane_nodes = MembraneMesh{mould->place, membrane->spacing}.size();
      plan.membrane_areal_mass = membrane->areal_mass;
    }
  }
  if (const auto& cell = prepared.setup.cell) {
    plan.cell_size = cell->size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell->periodic[axis]) plan.cell_axes += "xyz"[axis];
    }
    plan.cell_solid_fraction = plan.solid_mass / scene.config.material.density /
                               (cell->size.x * cell->size.y * cell->size.z);
  }
  plan.bin_edge = plan.largest_diameter + prepared.setup.skin;
  std::set<std::array<double, 3>> bins;
  for (const GrainState& grain : scene.grains) {
    const Vec3 bin = grain.position / plan.bin_edge;
    bins.insert({std::floor(bin.x), std::floor(bin.y), std::floor(bin.z)});
  }
  plan.occupied_bins = bins.size();
}

void estimate_memory(RunPlan& plan) {
  constexpr std::uint64_t grain =
      2 * sizeof(GrainState) + sizeof(GrainFrame) + sizeof(Load) + sizeof(Vec3) + 64 /* bins */;
  constexpr std::uint64_t pair = sizeof(Pair) + sizeof(PairForce) + 2 * sizeof(SlotLists::Slot) +
                                 2 * sizeof(PairsOfGrain::Entry);
  constexpr std::uint64_t nodes = nodes_per_pair * sizeof(NodeLanes) / lane_count;
  plan.memory_grains = plan.grains * (grain + listed_per_grain * pair + pairs_per_grain * nodes);
  constexpr std::uint64_t membrane_node =
      3 * sizeof(MembraneNode) + 2 * sizeof(MembraneTouch) + 2 * sizeof(MembraneSpring);
  plan.memory_grains += plan.membrane_nodes * membrane_node;
}

std::uint64_t memory_of(const RunPlan& plan) {
  return plan.memory_shapes + plan.memory_grains + plan.memory_surfaces;
}

/// How often something happens from step 1 to the end, when the end counts anyhow.
std::uint64_t occasions(std::uint64_t steps, std::uint64_t interval) {
  if (interval == 0) return 1;
  return steps / interval + (steps % interval == 0 ? 0 : 1);
}

void estimate_output(const LoadedScene& scene, std::uint64_t row_bytes, RunPlan& plan) {
  const OutputConfig& output = scene.config.output;
  plan.history_rows = 1 + occasions(plan.steps, output.history_interval);
  plan.frames = 1 + occasions(plan.steps, output.fields_interval);
  plan.checkpoints = occasions(plan.steps, output.checkpoint_interval);
  constexpr std::uint64_t grain_point = 210;  // bytes, as fields.cpp writes them
  constexpr std::uint64_t contact_line = 125;
  constexpr double triangle = 76;             // with the half point that goes with it
  constexpr std::uint64_t grain_state = 181;  // bytes, as checkpoint.cpp writes them
  constexpr std::uint64_t spring = 69;
  std::uint64_t frame = plan.grains * grain_point;
  if (output.contacts) frame += plan.grains * pairs_per_grain * contact_line;
  if (output.surfaces) {
    for (const GrainState& grain : scene.grains) {
      // Marching cubes cuts about two and a half triangles per square of the grid.
      const ShapeSummary& shape = scene.shapes[grain.shape.get()];
      const double spacing = shape.outline.spacing;
      plan.memory_surfaces +=
          static_cast<std::uint64_t>(2.5 * shape.node_area / (spacing * spacing) * triangle);
    }
    frame += plan.memory_surfaces;
  }
  const std::uint64_t checkpoint =
      plan.grains * (grain_state + pairs_per_grain * nodes_per_pair * spring);
  plan.output_bytes =
      plan.history_rows * row_bytes + plan.frames * frame + plan.checkpoints * checkpoint;
}

/// Makes steps in memory to measure their time.
void time_steps(PreparedScene& prepared, double timing_seconds, bool with_sample, RunPlan& plan,
                std::uint64_t& row_bytes) {
  plan.threads = thread_count();
  double seconds_per_row = 0;
  try {
    Simulation simulation{std::move(prepared.setup), prepared.initial};
    Measurement measurement = simulation.measure();
    plan.listed_pairs = simulation.grain_contacts().pairs().size();
    plan.contacts = measurement.contacts + measurement.wall_contacts;
    plan.deepest_overlap = measurement.deepest_overlap;
    simulation.step();  // makes buffers that later steps find ready
    const Stopwatch stepping;
    while (plan.timed_steps + 1 < plan.steps && stepping.seconds() < timing_seconds) {
      simulation.step();
      ++plan.timed_steps;
    }
    const double spent = stepping.seconds();
    if (plan.timed_steps > 0) plan.seconds_per_step = spent / static_cast<double>(plan.timed_steps);
    const Stopwatch measuring;
    measurement = simulation.measure();
    seconds_per_row = measuring.seconds();
    const SampleMeasurement sample = measure_sample(simulation);
    const CellState cell = simulation.cell() != nullptr ? simulation.cell_state() : CellState{};
    const HistoryRow row{.measurement = measurement, .cell = &cell, .stage = 1, .sample = &sample};
    const auto quantities = quantities_of(layout_of(simulation.setup(), with_sample));
    row_bytes = history_row(quantities, row).size() + 1;
  } catch (const Error& error) {
    plan.trial_failure = error.what();
  }
  plan.output_seconds = static_cast<double>(plan.history_rows) * seconds_per_row;
}

void write_stages(JsonWriter& json, const std::vector<StagePlan>& stages) {
  json.begin_array("stages");
  for (const StagePlan& stage : stages) {
    json.begin_object();
    json.value("name", stage.name);
    json.value("most_steps", stage.most_steps);
    if (stage.pace) {
      json.value("strain_rate_per_s", stage.pace->rate);
      json.value("inertial_number", stage.pace->inertial_number);
      json.value("advised_strain_rate_per_s", stage.pace->advised_rate);
    }
    json.end();
  }
  json.end();
}

}  // namespace

RunPlan plan_run(const LoadedScene& scene, double timing_seconds) {
  PreparedScene prepared = prepare(scene);
  RunPlan plan;
  describe_assembly(scene, prepared, plan);
  plan.time_step = prepared.time_step;
  plan.step_fraction = scene.config.time.step_fraction;
  plan.limiting_shape =
      scene.shapes[scene.grains[prepared.time_step.limiting.get()].shape.get()].name;
  plan.steps = prepared.steps;
  plan.stages = plan_stages(scene, prepared.time_step.step);
  plan.warnings = scene.warnings;
  plan.overlap = forecast_overlap(scene);
  plan.simulated_time = static_cast<double>(plan.steps) * prepared.time_step.step;
  estimate_memory(plan);
  plan.history_rows = 1 + occasions(plan.steps, scene.config.output.history_interval);
  std::uint64_t row_bytes = 0;
  time_steps(prepared, timing_seconds, scene.config.output.sample, plan, row_bytes);
  estimate_output(scene, row_bytes, plan);
  plan.output_seconds += static_cast<double>(plan.output_bytes) / disk_rate;
  plan.duration = static_cast<double>(plan.steps) * plan.seconds_per_step + plan.output_seconds;
  return plan;
}

std::string plan_text(const RunPlan& plan) {
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<12} {}\n", name, value);
  };
  line("grains", fmt::format("{}, with {} of the library's {}, {:.4g} kg", human_count(plan.grains),
                             plan.shapes_in_use, counted(plan.shapes, "shape"), plan.solid_mass));
  if (plan.density_scaling != 1) {
    line("inertia", fmt::format("SCALED: grains move as if {:.4g} times denser; time step {:.3g} "
                                "times longer",
                                plan.density_scaling, std::sqrt(plan.density_scaling)));
  }
  line("sizes", fmt::format("bounding spheres of {:.4g} to {:.4g} m across", plan.smallest_diameter,
                            plan.largest_diameter));
  line("nodes", fmt::format("{} on all grains", human_count(plan.nodes)));
  if (plan.coarse_nodes) line("", "COARSE: " + plan.coarse_nodes->text);
  line("walls", fmt::format("{}", plan.walls));
  if (plan.cell_size) {
    line("cell", fmt::format("periodic along {}, {:.4g} x {:.4g} x {:.4g} m, {:.1f} % "
                             "solid",
                             plan.cell_axes, plan.cell_size->x, plan.cell_size->y,
                             plan.cell_size->z, 100 * plan.cell_solid_fraction));
  }
  if (plan.membrane_nodes > 0) {
    line("membrane",
         fmt::format("{} nodes where its mould is now; {:.3g} kg/m^2, for the time step",
                     human_count(plan.membrane_nodes), plan.membrane_areal_mass));
  }
  line("bins", fmt::format("{} in use, {:.4g} m wide; {} listed at the start",
                           human_count(plan.occupied_bins), plan.bin_edge,
                           counted(plan.listed_pairs, "pair")));
  line("at start", plan.contacts == 0
                       ? std::string{"nothing touches"}
                       : fmt::format("{}, deepest overlap {:.3g} m ({:.2g} of the smallest grain)",
                                     counted(plan.contacts, "contact"), plan.deepest_overlap,
                                     plan.deepest_overlap / plan.smallest_diameter));
  constexpr double deep = 0.2;  // of the smallest grain
  if (plan.deepest_overlap > deep * plan.smallest_diameter) {
    line("", "DEEP: grains begin inside each other or beyond a wall, and will be thrown out");
  }
  const TimeStepChoice& step = plan.time_step;
  line("time step", step.given
                        ? fmt::format("{:.6g} s, as given", step.step)
                        : fmt::format("{:.6g} s = {} sqrt(m / k)", step.step, plan.step_fraction));
  line("", fmt::format(
               "{} grain {} (shape {}): m = {:.4g} kg, k = {:.4g} N/m{}",
               step.given ? "the rule would look at" : "set by", step.limiting.get(),
               plan.limiting_shape, step.mass, step.stiffness,
               step.given ? fmt::format(", and take {:.4g} s", step.rule_step) : std::string{}));
  if (step.is_too_long()) line("", too_long_text(step));
  if (plan.overlap) {
    line("overlap", overlap_line(*plan.overlap));
    if (plan.overlap->is_too_deep()) {
      line("", "TOO SOFT: the figures of such a run mean nothing; raise the stiffness");
    }
  }
  for (std::size_t n = 0; n < plan.stages.size(); ++n) {
    const auto lines = stage_lines(plan.stages[n], step.step);
    line(fmt::format("stage {}", n + 1), lines.front());
    for (std::size_t more = 1; more < lines.size(); ++more) line("", lines[more]);
  }
  line("steps", fmt::format("{}{}, {:.6g} s simulated", plan.stages.empty() ? "" : "at most ",
                            human_count(plan.steps), plan.simulated_time));
  line("memory", fmt::format("about {} besides the program itself ({} of shapes)",
                             human_bytes(memory_of(plan)), human_bytes(plan.memory_shapes)));
  line("output", fmt::format("about {}: {} history rows, {} ParaView frames, {}",
                             human_bytes(plan.output_bytes), human_count(plan.history_rows),
                             human_count(plan.frames), counted(plan.checkpoints, "checkpoint")));
  for (const std::string& warning : plan.warnings) line("WARNING", warning);
  if (plan.trial_failure) {
    line("trial", "FAILED in the first steps: " + *plan.trial_failure);
  } else {
    if (plan.timed_steps == 0) {
      line("duration", "not known: no steps were timed");
      return text;
    }
    line("duration", fmt::format("about {} on {}", human_duration(plan.duration),
                                 counted(static_cast<std::uint64_t>(plan.threads), "thread")));
    line("", fmt::format("from {} in memory, {:.3g} ms each; steps with more contacts take longer",
                         counted(plan.timed_steps, "step"), 1e3 * plan.seconds_per_step));
  }
  return text;
}

std::string too_long_text(const TimeStepChoice& step) {
  return fmt::format("TOO LONG: above {:.3g} s forces may grow without bound", step.longest());
}

std::string plan_json(const RunPlan& plan) {
  JsonWriter json;
  json.begin_object();
  json.value("valid", true);
  json.value("grains", plan.grains);
  json.value("shapes", plan.shapes);
  json.value("shapes_in_use", plan.shapes_in_use);
  json.value("nodes", plan.nodes);
  if (plan.coarse_nodes) json.value("coarse_nodes", plan.coarse_nodes->text);
  json.value("walls", plan.walls);
  if (plan.cell_size) {
    json.value("cell_periodic", plan.cell_axes);
    json.value("cell_size_x_m", plan.cell_size->x);
    json.value("cell_size_y_m", plan.cell_size->y);
    json.value("cell_size_z_m", plan.cell_size->z);
  }
  json.value("smallest_diameter_m", plan.smallest_diameter);
  json.value("largest_diameter_m", plan.largest_diameter);
  json.value("solid_mass_kg", plan.solid_mass);
  if (plan.membrane_nodes > 0) {
    json.value("membrane_nodes", plan.membrane_nodes);
    json.value("membrane_areal_mass_kg_per_m2", plan.membrane_areal_mass);
  }
  json.value("density_scaling", plan.density_scaling);
  json.value("bin_edge_m", plan.bin_edge);
  json.value("occupied_bins", plan.occupied_bins);
  json.value("listed_pairs", plan.listed_pairs);
  json.value("contacts_at_start", plan.contacts);
  json.value("deepest_overlap_at_start_m", plan.deepest_overlap);
  json.begin_object("time_step");
  json.value("step_s", plan.time_step.step);
  json.value("given", plan.time_step.given);
  json.value("rule_step_s", plan.time_step.rule_step);
  json.value("limiting_grain", plan.time_step.limiting.get());
  json.value("limiting_shape", plan.limiting_shape);
  json.value("mass_kg", plan.time_step.mass);
  json.value("stiffness_N_per_m", plan.time_step.stiffness);
  json.end();
  if (plan.overlap) {
    json.begin_object("foreseen_overlap");
    json.value("stress_Pa", plan.overlap->stress);
    json.value("over_diameter", plan.overlap->ratio);
    json.value("too_deep", plan.overlap->is_too_deep());
    json.end();
  }
  if (!plan.stages.empty()) write_stages(json, plan.stages);
  json.value("steps", plan.steps);
  json.value("simulated_time_s", plan.simulated_time);
  json.value("memory_bytes", memory_of(plan));
  json.value("history_rows", plan.history_rows);
  json.value("frames", plan.frames);
  json.value("checkpoints", plan.checkpoints);
  json.value("output_bytes", plan.output_bytes);
  json.value("threads", plan.threads);
  json.value("timed_steps", plan.timed_steps);
  const auto timed = [&](double seconds) { return plan.timed_steps > 0 ? seconds : unknown; };
  json.value("seconds_per_step", timed(plan.seconds_per_step));
  json.value("duration_s", timed(plan.duration));
  json.begin_array("warnings");
  for (const std::string& warning : plan.warnings) json.value(warning);
  json.end();
  if (plan.trial_failure) json.value("trial_failure", *plan.trial_failure);
  json.end();
  return json.text();
}

}  // namespace reckon
