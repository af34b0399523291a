// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/run_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "reckon/core/file.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/output/performance_report.hpp"

namespace reckon {

RunFiles::RunFiles(const SceneReading& reading, const LoadedScene& scene,
                   const PreparedScene& prepared, std::uint64_t steps, const RunOptions& options,
                   const RunHooks& hooks)
    : hooks_{hooks}, config_{scene.config.output}, folder_{options.folder} {
  if (folder_.has_content() && !std::filesystem::is_directory(folder_.root())) {
    throw Error{{.place = folder_.root().string(),
                 .problem = "this is a file, not a folder",
                 .reason = {},
                 .fix = "Give another name with --out."}};
  }
  folder_.create();
  lock_.emplace(folder_.root());
  RunStart start = ready_folder(folder_, options, first_checkpoint(scene, prepared), hooks.note);
  resumed_ = start.resumed;
  checkpoint_ = std::move(start.checkpoint);
  const std::uint64_t first_step = checkpoint_.state.step;
  if (resumed_) latest_ = first_step;
  folder_.create_subfolders();
  log_.emplace(folder_.log());
  write_file(folder_.scene(), reading.text);
  write_file(folder_.resolved(), resolved_scene(scene.config, prepared, steps));
  outputs_.emplace(folder_, scene, prepared,
                   OutputSchedule{scene.config, checkpoint_.state.stage_starts},
                   resumed_ ? std::optional{first_step} : std::nullopt);
  if (const std::string lost = outputs_->lost_rows(); !lost.empty()) note(lost);
  record_.started = utc_now();
  record_.scene = scene.config.title;
  record_.grains = scene.grains.size();
  record_.shapes = scene.shapes.size();
  record_.time_step = prepared.time_step.step;
  record_.first_step = first_step;
  record_.steps = steps;
}

SimulationState RunFiles::take_start() { return std::move(checkpoint_.state); }

void RunFiles::log(const std::string& text) const { log_->write(text); }

void RunFiles::note(const std::string& text) {
  log(text);
  if (hooks_.note) hooks_.note(text);
}

void RunFiles::note_coarse(const CoarseNodes& coarse) {
  record_.coarse_nodes = {coarse.text, coarse.unseen};
  note("COARSE: " + coarse.text);
}

void RunFiles::begin(HistoryRow at_start) {
  checkpoint_.energy_at_start = at_start.measurement.energy.total();
  append_history(at_start);
}

void RunFiles::append_history(HistoryRow row) {
  Stopwatch watch;
  row.energy_at_start = checkpoint_.energy_at_start;
  outputs_->append_history(row);
  output_seconds_ += watch.lap();
}

void RunFiles::in_background(BackgroundWriter::Job job) {
  Stopwatch watch;
  writer_.submit([this, job = std::move(job)] {
    Stopwatch busy;
    job();
    background_seconds_ = background_seconds_ + busy.lap();
  });
  output_seconds_ += watch.lap();
}

void RunFiles::write_fields(FieldsAtStep fields) {
  in_background([this, fields = std::move(fields)] { outputs_->write_fields(fields); });
}

void RunFiles::write_checkpoint(SimulationState state,
                                std::optional<std::uint64_t> goal_met_since) {
  in_background([this, state = std::move(state), goal_met_since]() mutable {
    const std::uint64_t step = state.step;
    // A run resumed from here needs the rows before.
    outputs_->sync_history();
    checkpoint_.state = std::move(state);
    checkpoint_.goal_met_since = goal_met_since;
    reckon::write_checkpoint(folder_.checkpoint(step), checkpoint_);
    checkpoint_.state = {};
    if (latest_ && *latest_ != step && !is_due(*latest_, config_.checkpoint_interval)) {
      std::filesystem::remove(folder_.checkpoint(*latest_));
    }
    latest_ = step;
  });
}

void RunFiles::finish_writing() {
  Stopwatch watch;
  writer_.finish();
  output_seconds_ += watch.lap();
}

void RunFiles::write_record(const std::string& status, const RunProgress& progress,
                            std::span<const RankPerformance> performance) {
  record_.status = status;
  record_.step = progress.step;
  record_.wall_seconds = progress.wall_seconds;
  record_.ranks = performance.size();
  record_.output_seconds = output_seconds_;
  if (!performance.empty()) record_.list_rebuilds = performance.front().list_rebuilds;
  write_run_record(folder_.json(), record_);
  const PerformanceOfRun run{performance, record_.grains, progress.wall_seconds, output_seconds_,
                             background_seconds_};
  write_file(folder_.performance(), performance_json(run));
  performance_text_ = performance_table(run);
}

RunVerdict RunFiles::judge(const SceneConfig& scene, const std::string& status) {
  record_.verdict = verdict_on({.scene = scene,
                                .history = history(),
                                .status = status,
                                .coarse_nodes = record_.coarse_nodes});
  return *record_.verdict;
}

bool RunFiles::record_says_ended() const {
  const std::string status = recorded_status(folder_.own(folder_.json()));
  return status == "complete" || status == "at rest";
}

std::filesystem::path RunFiles::checkpoint_file() const {
  return latest_ ? folder_.checkpoint(*latest_) : std::filesystem::path{};
}

ErrorText RunFiles::fail(ErrorText text, const RunProgress& progress) {
  try {
    writer_.finish();
  } catch (const std::exception&) {
    // The first failure is reported.
  }
  if (!text.fix.empty()) text.fix += ' ';
  text.fix += latest_ ? fmt::format("The last checkpoint is {} (step {}).",
                                    checkpoint_file().string(), *latest_)
                      : std::string{"There is no checkpoint yet."};
  record_.message = Error{text}.what();
  log(fmt::format("failed: {}", record_.message));
  record_.status = "failed";
  record_.step = progress.step;
  record_.wall_seconds = progress.wall_seconds;
  try {
    write_run_record(folder_.json(), record_);
  } catch (const std::exception&) {
    // The failure that is reported may itself be a full disk.
    overwrite_run_record(folder_.json(), record_);
  }
  return text;
}

}  // namespace reckon
