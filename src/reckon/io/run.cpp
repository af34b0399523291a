// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "reckon/core/build_info.hpp"
#include "reckon/core/file.hpp"
#include "reckon/io/checkpoint.hpp"
#include "reckon/io/run_folder.hpp"
#include "reckon/io/run_outputs.hpp"
#include "reckon/io/run_record.hpp"
#include "reckon/io/run_start.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr std::uint64_t rest_interval_without_history = 100;  // steps
constexpr double log_interval = 60;                           // [s]

/// One session of a run.
class Session {
 public:
  Session(const std::string& text, const LoadedScene& scene, PreparedScene prepared,
          const std::string& resolved, std::uint64_t steps, const RunOptions& options,
          const RunHooks& hooks, RunStart start)
      : hooks_{hooks},
        options_{options},
        config_{scene.config},
        folder_{options.folder},
        log_{folder_.log()},
        simulation_{std::move(prepared.setup), start.checkpoint.state},
        checkpoint_{std::move(start.checkpoint)},
        outputs_{folder_, config_.output, simulation_.setup(),
                 start.resumed ? std::optional{checkpoint_.state.step} : std::nullopt},
        resumed_{start.resumed} {
    progress_.first_step = checkpoint_.state.step;
    progress_.step = checkpoint_.state.step;
    progress_.steps = steps;
    progress_.time = simulation_.time();
    record_.started = utc_now();
    record_.scene = config_.title;
    record_.grains = scene.grains.size();
    record_.shapes = scene.shapes->size();
    record_.time_step = simulation_.setup().time_step;
    record_.first_step = progress_.first_step;
    record_.steps = steps;
    write_file(folder_.scene(), text);
    write_file(folder_.resolved(), resolved);
    if (resumed_) latest_checkpoint_ = checkpoint_.state.step;
  }

  RunReport run() {
    try {
      begin();
      RunEnd end = RunEnd::complete;
      bool interrupted = false;
      bool rests = resumed_ && rests_after_history();
      if (resumed_ && (rests || progress_.step >= progress_.steps)) end = RunEnd::nothing_to_do;
      while (!rests && !interrupted && progress_.step < progress_.steps) {
        simulation_.step();
        update_progress();
        rests = write_what_is_due();
        interrupted = !rests && progress_.step < progress_.steps && hooks_.stop_requested &&
                      hooks_.stop_requested();
        if (hooks_.progressed) hooks_.progressed(progress_);
      }
      if (end != RunEnd::nothing_to_do) {
        end = interrupted ? RunEnd::interrupted : rests ? RunEnd::at_rest : RunEnd::complete;
      }
      return finish(end);
    } catch (const Error& error) {
      throw fail(error.text());
    } catch (const std::exception& error) {  // no memory, a file system that refuses
      throw fail({.place = {}, .problem = error.what(), .reason = {}, .fix = {}});
    }
  }

 private:
  void begin() {
    const BuildInfo build = build_info();
    note(fmt::format("reckon {} ({}), {} thread{}, {} grains, time step {:.6g} s", build.version,
                     build.revision, thread_count(), thread_count() == 1 ? "" : "s", record_.grains,
                     record_.time_step));
    if (resumed_) {
      note(fmt::format("resumed from the checkpoint of step {}", progress_.step));
    } else {
      measure();
      checkpoint_.energy_at_start = last_.energy.total();
      outputs_.append_history(last_, checkpoint_.energy_at_start);
      write_fields();
    }
    save_record("running");
  }

  void update_progress() {
    progress_.step = simulation_.step_number();
    progress_.time = simulation_.time();
    progress_.wall_seconds = seconds_since(start_);
  }

  /// Returns whether the assembly has come to rest.
  bool write_what_is_due() {
    const std::uint64_t step = progress_.step;
    bool rests = false;
    if (is_due(step, config_.output.history_interval)) append_history();
    if (is_due(step, rest_interval())) rests = rests_after_history();
    if (is_due(step, config_.output.fields_interval)) write_fields();
    const bool too_long_ago = options_.safety_interval > 0 &&
                              seconds_since(last_checkpoint_time_) >= options_.safety_interval;
    if (is_due(step, config_.output.checkpoint_interval) || too_long_ago) save_checkpoint();
    if (seconds_since(last_log_time_) >= log_interval) {
      last_log_time_ = Clock::now();
      log_.write(
          fmt::format("step {} of {}, {:.6g} s simulated", step, progress_.steps, progress_.time));
    }
    return rests;
  }

  [[nodiscard]] std::uint64_t rest_interval() const {
    if (!config_.time.stop_at_unbalanced_ratio) return 0;
    const std::uint64_t interval = config_.output.history_interval;
    return interval > 0 ? interval : rest_interval_without_history;
  }

  /// Looked at only at fixed steps, so that a resumed run ends where an uninterrupted one does.
  bool rests_after_history() {
    if (!is_due(progress_.step, rest_interval())) return false;
    measure();
    return last_.contacts + last_.wall_contacts > 0 &&
           last_.unbalanced_ratio < *config_.time.stop_at_unbalanced_ratio;
  }

  void measure() {
    if (last_.step == simulation_.step_number() && measured_) return;
    last_ = simulation_.measure();
    measured_ = true;
    progress_.unbalanced_ratio = last_.unbalanced_ratio;
    progress_.kinetic_energy = last_.energy.translation + last_.energy.rotation;
  }

  void append_history() {
    measure();
    outputs_.append_history(last_, checkpoint_.energy_at_start);
  }

  void write_fields() {
    const Clock::time_point start = Clock::now();
    outputs_.write_fields(simulation_);
    record_.output_seconds += seconds_since(start);
  }

  /// A checkpoint that the scene did not ask for gives way to the next one.
  void save_checkpoint() {
    const Clock::time_point start = Clock::now();
    checkpoint_.state = simulation_.state();
    const std::uint64_t step = checkpoint_.state.step;
    write_checkpoint(folder_.checkpoint(step), checkpoint_);
    if (latest_checkpoint_ && *latest_checkpoint_ != step &&
        !is_due(*latest_checkpoint_, config_.output.checkpoint_interval)) {
      std::filesystem::remove(folder_.checkpoint(*latest_checkpoint_));
    }
    latest_checkpoint_ = step;
    last_checkpoint_time_ = Clock::now();
    record_.output_seconds += seconds_since(start);
    save_record("running");
  }

  RunReport finish(RunEnd end) {
    measure();
    if (end != RunEnd::interrupted) {
      if (!outputs_.history_has(progress_.step)) append_history();
      if (!outputs_.fields_have(progress_.step)) write_fields();
    }
    if (end != RunEnd::nothing_to_do && latest_checkpoint_ != progress_.step) save_checkpoint();
    update_progress();
    const char* status = end == RunEnd::interrupted ? "interrupted"
                         : end == RunEnd::at_rest   ? "at rest"
                                                    : "complete";
    log_.write(fmt::format("{} at step {} of {}", status, progress_.step, progress_.steps));
    save_record(status);
    const EnergyBudget& energy = last_.energy;
    return {.end = end,
            .progress = progress_,
            .last = last_,
            .energy_error = energy.total() - checkpoint_.energy_at_start,
            .energy_turnover = energy.translation + energy.rotation + energy.elastic +
                               std::abs(energy.friction) + std::abs(energy.dashpot) +
                               std::abs(energy.damping) + std::abs(energy.body_work) +
                               std::abs(energy.wall_work),
            .checkpoint = folder_.checkpoint(*latest_checkpoint_)};
  }

  RunFailure fail(ErrorText text) {
    if (latest_checkpoint_) {
      if (!text.fix.empty()) text.fix += ' ';
      text.fix +=
          fmt::format("The last checkpoint is {} (step {}).",
                      folder_.checkpoint(*latest_checkpoint_).string(), *latest_checkpoint_);
    } else {
      if (!text.fix.empty()) text.fix += ' ';
      text.fix += "There is no checkpoint yet.";
    }
    RunFailure failure{text};
    record_.message = failure.what();
    log_.write(fmt::format("failed: {}", failure.what()));
    try {
      save_record("failed");
    } catch (const Error&) {
      // The reason for the failure is what counts; a full disk may be that very reason.
    }
    return failure;
  }

  void save_record(const char* status) {
    record_.status = status;
    record_.step = progress_.step;
    record_.wall_seconds = seconds_since(start_);
    record_.list_rebuilds = simulation_.list_rebuilds();
    write_run_record(folder_.json(), record_);
  }

  void note(const std::string& text) {
    log_.write(text);
    if (hooks_.note) hooks_.note(text);
  }

  const RunHooks& hooks_;
  const RunOptions& options_;
  const SceneConfig& config_;
  RunFolder folder_;
  RunLog log_;
  Simulation simulation_;
  Checkpoint checkpoint_;  // its state is that of the latest checkpoint
  RunOutputs outputs_;
  bool resumed_;
  RunRecord record_;
  RunProgress progress_;
  Measurement last_;
  bool measured_{false};
  std::optional<std::uint64_t> latest_checkpoint_;
  Clock::time_point start_{Clock::now()};
  Clock::time_point last_checkpoint_time_{start_};
  Clock::time_point last_log_time_{start_};
};

}  // namespace

RunReport run_scene(const SceneReading& reading, const LoadedScene& scene,
                    const RunOptions& options, const RunHooks& hooks) {
  PreparedScene prepared = prepare(scene);
  const std::uint64_t steps = options.steps.value_or(prepared.steps);
  const RunFolder folder{options.folder};
  Checkpoint first = first_checkpoint(scene, prepared);
  if (folder.has_content() && !std::filesystem::is_directory(folder.root())) {
    throw Error{{.place = folder.root().string(),
                 .problem = "this is a file, not a folder",
                 .reason = {},
                 .fix = "Give another name with --out."}};
  }
  folder.create();
  const FolderLock lock{folder.root()};
  RunStart start = ready_folder(folder, options, std::move(first), hooks.note);
  folder.create_subfolders();
  const std::string resolved = resolved_scene(scene.config, prepared, steps);
  Session session{reading.text, scene, std::move(prepared), resolved, steps,
                  options,      hooks, std::move(start)};
  return session.run();
}

}  // namespace reckon
