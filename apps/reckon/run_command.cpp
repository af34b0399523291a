// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "run_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "exit_codes.hpp"
#include "progress.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/output/history.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/parallel/communicator.hpp"
#include "reckon/parallel/on_root.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/results/stage_report.hpp"
#include "reckon/run/run.hpp"
#include "reckon/text/human.hpp"
#include "reckon/text/json_writer.hpp"
#include "scene_input.hpp"
#include "standard_streams.hpp"
#include "stop_signal.hpp"
#include "thread_limit.hpp"

namespace reckon::app {
namespace {

struct RunCommandOptions {
  std::string scene;
  std::string folder;
  int threads{0};
  std::uint64_t steps{0};
  bool resume{false};
  bool overwrite{false};
  bool quiet{false};
  bool json{false};
  double safety_minutes{10};
};

std::filesystem::path run_folder(const RunCommandOptions& options) {
  if (!options.folder.empty()) return options.folder;
  return std::filesystem::path{options.scene}.stem().string() + ".run";
}

std::string resume_hint(const RunCommandOptions& options) {
  return fmt::format("reckon run {}{} --resume", shell_word(options.scene),
                     options.folder.empty() ? "" : " --out " + shell_word(options.folder));
}

std::string result_text(const RunReport& report, const std::filesystem::path& folder) {
  const RunProgress& progress = report.progress;
  const Measurement& last = report.last;
  const auto made = static_cast<double>(progress.step - progress.first_step);
  std::string text = verdict_text(report.verdict);
  text += fmt::format("{} at step {} ({:.6g} s simulated) after {}, {:.3g} steps/s\n",
                      report.end == RunEnd::at_rest ? "came to rest" : "complete", progress.step,
                      progress.time, human_duration(progress.wall_seconds),
                      progress.wall_seconds > 0 ? made / progress.wall_seconds : 0);
  text += fmt::format(
      "  contacts {} ({} with walls), coordination number {:.3g}, unbalanced ratio {:.3g}\n",
      last.contacts + last.wall_contacts, last.wall_contacts, last.coordination,
      last.unbalanced_ratio);
  text += fmt::format(
      "  kinetic energy {:.4g} J, fastest grain {:.3g} m/s, deepest overlap {:.3g} m\n",
      last.energy.translation + last.energy.rotation, last.largest_speed, last.deepest_overlap);
  text += fmt::format("  energy balance error {:.2g} J", report.energy_error);
  if (report.energy_turnover > 0) {
    text += fmt::format(", {:.2g} of the energy turned over",
                        std::abs(report.energy_error) / report.energy_turnover);
  }
  text += fmt::format("\n{}{}", report.stages, report.performance);
  text += fmt::format("  tables    {}\n  ParaView  {}\n", (folder / "history.csv").string(),
                      (folder / "grains.pvd").string());
  return text;
}

void print_json(const RunReport& report, const SceneConfig& scene,
                const std::filesystem::path& folder) {
  const RunProgress& progress = report.progress;
  JsonWriter json;
  json.begin_object();
  write_verdict(json, report.verdict);
  json.value("folder", folder.string());
  json.value("status", report.end == RunEnd::at_rest ? "at rest" : "complete");
  json.value("nothing_to_do", report.end == RunEnd::nothing_to_do);
  json.value("wall_s", progress.wall_seconds);
  write_measured(json, report.measured);
  json.value("energy_error_J", report.energy_error);
  json.value("energy_turnover_J", report.energy_turnover);
  json.begin_array("driven_stages");
  for (const StageFinding& found :
       stage_findings(scene, read_history(RunFolder{folder}.history()))) {
    json.begin_object();
    json.value("stage", found.stage);
    json.value("peak_friction_angle_deg", found.shear.peak_friction_angle);
    json.value("strain_at_peak", found.shear.strain_at_peak);
    json.value("final_friction_angle_deg", found.shear.final_friction_angle);
    if (found.free_volume) {
      json.value("dilatancy_angle_deg", found.shear.dilatancy_angle);
      json.value("final_dilatancy_angle_deg", found.shear.final_dilatancy_angle);
    }
    json.value("axial_strain", found.axial_strain);
    json.value("total_axial_strain", found.total_axial_strain);
    json.value("axial_deviator_at_start_Pa", found.deviator_at_start);
    json.value("axial_deviator_at_end_Pa", found.deviator_at_end);
    json.value("void_ratio", found.void_ratio);
    if (found.has_walls) {
      json.value("stress_disagreement", found.stress_disagreement);
      json.value("largest_stress_disagreement", found.largest_disagreement);
    }
    json.value("inertial_number", found.inertial_number);
    json.end();
  }
  json.end();
  json.end();
  fmt::print("{}", json.text());
}

/// Threads of each rank where the user has not chosen: an even share of the machine's processors,
/// within the processors that the launcher gives this rank.
int default_thread_count(const Communicator& ranks) {
  const long processors = ::sysconf(_SC_NPROCESSORS_ONLN);
  const int share = static_cast<int>(processors) / ranks.machine().size();
  return std::clamp(share, 1, thread_count());
}

void set_threads(const RunCommandOptions& options, const Communicator& ranks) {
  if (options.threads > 0) {
    set_thread_count(options.threads);
  } else if (ranks.size() > 1 &&
             std::getenv("OMP_NUM_THREADS") == nullptr) {  // NOLINT(concurrency-mt-unsafe)
    set_thread_count(default_thread_count(ranks));
  }
}

/// Returns on all ranks, with the scene on the root; with faults it ends the command on all.
SceneInput read_scene_on_root(const RunCommandOptions& options, const Communicator& ranks) {
  SceneInput input;
  on_root(ranks, [&] { input = read_scene(options.scene); });
  if (ranks.any(!input.reading.faults.empty())) {
    if (ranks.is_root()) print_faults(options.scene, input.reading);
    throw CLI::RuntimeError{input_at_fault};
  }
  return input;
}

void run(const RunCommandOptions& options, const Communicator& ranks, bool launched) {
  set_threads(options, ranks);
  const SceneInput input = read_scene_on_root(options, ranks);
  const bool quiet = options.quiet || options.json || !ranks.is_root();
  const RunOptions run_options{
      .folder = run_folder(options),
      .resume = options.resume,
      .overwrite = options.overwrite,
      .steps = options.steps > 0 ? std::optional{options.steps} : std::nullopt,
      .safety_interval = 60 * options.safety_minutes};
  ProgressDisplay display{quiet, !launched};
  RunHooks hooks;
  hooks.stop_requested = [] { return stop_signal() != 0; };
  hooks.progressed = [&](const RunProgress& progress) { display.show(progress); };
  hooks.note = [&](const std::string& text) {
    if (quiet) return;
    display.clear();
    say(printable(text) + '\n');
  };
  watch_stop_signals();
  if (!quiet) {
    const std::string& title = input.scene.config.title;
    say(printable(fmt::format("{} -> {}\n", title.empty() ? options.scene : title,
                              run_options.folder.string())));
  }
  RunReport report;
  try {
    report = run_scene(input.reading, input.scene, run_options, hooks, ranks);
  } catch (...) {
    display.clear();
    throw;
  }
  display.clear();
  if (report.end == RunEnd::interrupted) {
    const int signal = stop_signal() == SIGINT ? SIGINT : SIGTERM;
    if (ranks.is_root()) {
      const std::string text =
          fmt::format("reckon: stopped by {} at step {} of {}; checkpoint written\n  {}\n",
                      signal == SIGINT ? "Ctrl-C" : "SIGTERM, SIGUSR1 or SIGHUP",
                      report.progress.step, report.progress.steps, resume_hint(options));
      std::fputs(text.c_str(), stderr);  // fmt::print would throw where the terminal is gone
    }
    throw CLI::RuntimeError{signal == SIGINT ? interrupted : terminated};
  }
  if (options.json && ranks.is_root()) {
    print_json(report, input.scene.config, run_options.folder);
  }
  if (options.quiet && !options.json && ranks.is_root() && !report.verdict.valid()) {
    std::fputs(printable(verdict_text(report.verdict)).c_str(), stderr);
  }
  if (quiet) return;
  if (report.end == RunEnd::nothing_to_do) {
    say(verdict_text(report.verdict));
    say("the run is complete already: nothing to do\n");
  } else {
    say(printable(result_text(report, run_options.folder)));
  }
}

}  // namespace

void add_run_command(CLI::App& app, const Communicator& ranks, bool launched) {
  CLI::App* command = app.add_subcommand("run", "Run a scene, or resume a run");
  auto options = std::make_shared<RunCommandOptions>();
  command->add_option("scene", options->scene, "Scene file (TOML)")->required();
  command->add_option("--out", options->folder,
                      "Folder for the run's files (default: name of the scene + .run)");
  command
      ->add_option(
          "--threads", options->threads,
          "Number of threads of each process (default: an even share of the machine); changes "
          "no result")
      ->check(CLI::Range(1, most_threads));
  command
      ->add_option("--steps", options->steps, "Last step of the run (default: as the scene gives)")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000'000'000}));
  CLI::Option* resume = command->add_flag(
      "--resume", options->resume,
      "Resume from the latest good checkpoint; the results have the same bits as without the "
      "break. Without a checkpoint the run starts from the beginning");
  command->add_flag("--overwrite", options->overwrite, "Replace the run that is in the folder")
      ->excludes(resume);
  command
      ->add_option(
          "--safety-minutes", options->safety_minutes,
          "Minutes of wall-clock time between further checkpoints; 0: only those of the scene")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet,
                    "Print only errors, and the reasons why results are not valid");
  command->add_flag("--json", options->json, "At the end, answer in JSON, and print nothing else");
  command->footer(
      std::string{"Examples:\n"
                  "  reckon run settle.toml\n"
                  "  reckon run settle.toml --out /scratch/settle --threads 8\n"
                  "  reckon run settle.toml --resume               after a break\n"
                  "  reckon run settle.toml --resume --steps 50000  longer\n"
                  "  mpirun -np 4 reckon run settle.toml --threads 2   4 processes\n\n"
                  "Ctrl-C, SIGTERM, SIGUSR1 and SIGHUP stop the run after the step, with a "
                  "checkpoint. A second signal stops it at once.\n\n"} +
      exit_code_footer);
  command->callback([options, &ranks, launched] { run(*options, ranks, launched); });
}

}  // namespace reckon::app
