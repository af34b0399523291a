// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/output/background_writer.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/results/run_record.hpp"
#include "reckon/run/run.hpp"
#include "reckon/run/run_outputs.hpp"
#include "reckon/run/run_start.hpp"
#include "reckon/scene/node_spacing.hpp"
#include "reckon/simulation/performance.hpp"

namespace reckon {

/// All that a session writes into its folder. Exists only on the root.
class RunFiles {
 public:
  /// Takes hold of the folder and makes it ready. Throws Error as ready_folder does.
  RunFiles(const SceneReading& reading, const LoadedScene& scene, const PreparedScene& prepared,
           std::uint64_t steps, const RunOptions& options, const RunHooks& hooks);

  [[nodiscard]] bool resumed() const { return resumed_; }
  /// Where the session begins. To be taken once.
  [[nodiscard]] SimulationState take_start();
  /// See Checkpoint.
  [[nodiscard]] std::optional<std::uint64_t> goal_met_since() const {
    return checkpoint_.goal_met_since;
  }

  void note(const std::string& text);           ///< in the log and to the caller
  void note_coarse(const CoarseNodes& coarse);  ///< likewise, and in the verdict
  void log(const std::string& text) const;      ///< only in the log
  void begin(HistoryRow at_start);              ///< the first row of a fresh run
  /// Fills in the energy at the start.
  void append_history(HistoryRow row);
  /// Fields and checkpoints are written in the background; a later call throws their errors.
  void write_fields(FieldsAtStep fields);
  /// A checkpoint that is not due by the scene is replaced by the next one.
  void write_checkpoint(SimulationState state, std::optional<std::uint64_t> goal_met_since);
  /// Waits until all of it is written.
  void finish_writing();
  void write_record(const std::string& status, const RunProgress& progress,
                    std::span<const RankPerformance> performance);
  /// Evaluates the history of a session that ends with this status; later records hold the verdict.
  [[nodiscard]] RunVerdict judge(const SceneConfig& scene, const std::string& status);
  /// Puts the latest checkpoint into the advice of an error, and the failure into the record.
  [[nodiscard]] ErrorText fail(ErrorText text, const RunProgress& progress);

  // As of the last finish_writing().
  [[nodiscard]] bool history_has(std::uint64_t step) const { return outputs_->history_has(step); }
  [[nodiscard]] bool fields_have(std::uint64_t step) const { return outputs_->fields_have(step); }
  /// Whether the run has ended according to run.json.
  [[nodiscard]] bool record_says_ended() const;
  [[nodiscard]] std::filesystem::path checkpoint_file() const;
  [[nodiscard]] HistoryTable history() const { return read_history(folder_.history()); }
  [[nodiscard]] const std::string& performance_text() const { return performance_text_; }
  [[nodiscard]] double energy_at_start() const { return checkpoint_.energy_at_start; }

 private:
  void in_background(BackgroundWriter::Job job);

  const RunHooks& hooks_;
  OutputConfig config_;
  RunFolder folder_;
  std::optional<FolderLock> lock_;
  std::optional<RunLog> log_;
  std::optional<RunOutputs> outputs_;
  Checkpoint checkpoint_;  // all but its state
  bool resumed_{false};
  std::optional<std::uint64_t> latest_;
  RunRecord record_;
  double output_seconds_{0};                   // in which the caller waited
  std::atomic<double> background_seconds_{0};  // in which it did not
  std::string performance_text_;               // as of the last write_record
  BackgroundWriter writer_;                    // last: its jobs use the rest
};

}  // namespace reckon
