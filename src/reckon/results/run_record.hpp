// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "reckon/results/run_verdict.hpp"

namespace reckon {

/// "2026-03-01T12:34:56Z"
[[nodiscard]] std::string utc_now();

/// run.log: a line per event, each with the time of day in UTC. Grows over all sessions of a run.
class RunLog {
 public:
  explicit RunLog(std::filesystem::path path);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  void write(std::string_view line) const;

 private:
  std::filesystem::path path_;
  int descriptor_{-1};
};

/// The content of run.json: the program, the scene, the machine, and how the run ended.
struct RunRecord {
  std::string status;                 ///< running, complete, at rest, interrupted, failed
  std::string message;                ///< of a failure
  std::optional<RunVerdict> verdict;  ///< once the session has ended
  RecordedSpacing coarse_nodes;
  std::string started;  ///< this session [UTC]
  std::string scene;
  std::uint64_t grains{0};
  std::uint64_t shapes{0};
  std::uint64_t ranks{1};
  double time_step{0};  ///< [s]
  std::uint64_t first_step{0};
  std::uint64_t step{0};
  std::uint64_t steps{0};
  double wall_seconds{0};
  double output_seconds{0};
  std::uint64_t list_rebuilds{0};
};

void write_run_record(const std::filesystem::path& path, const RunRecord& record);
/// Likewise where there may be no room for a new file: over the content of the old one, which has
/// room of its own, or else the old one, which is no longer true, is removed.
void overwrite_run_record(const std::filesystem::path& path, const RunRecord& record);

/// What a run.json says of how the run stands. Empty where there is no file or no such key.
struct RecordedOutcome {
  std::string status;
  std::string message;  ///< of a failure
  RecordedSpacing coarse_nodes;
};
[[nodiscard]] RecordedOutcome recorded_outcome(const std::filesystem::path& path);
/// Its status alone.
[[nodiscard]] std::string recorded_status(const std::filesystem::path& path);

}  // namespace reckon
