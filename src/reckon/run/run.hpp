// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/output/quantities.hpp"
#include "reckon/results/run_verdict.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/simulation/measurement.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

struct RunOptions {
  std::filesystem::path folder;        ///< where the run's files go
  bool resume{false};                  ///< go on from the latest good checkpoint in `folder`
  bool overwrite{false};               ///< replace a run that is there
  std::optional<std::uint64_t> steps;  ///< instead of the scene's number of steps
  /// Wall-clock time between checkpoints besides the scene's own; each replaces the one before.
  /// 0: none [s]
  double safety_interval{600};
};

/// Where a run is.
struct RunProgress {
  std::uint64_t first_step{0};  ///< where this session began
  std::uint64_t step{0};
  std::uint64_t steps{0};      ///< where it is to end
  double time{0};              ///< simulated [s]
  double wall_seconds{0};      ///< since this session began
  double unbalanced_ratio{0};  ///< as of the last row of the history
  double kinetic_energy{0};    ///< likewise [J]
};

/// Calls to the caller during a run. All may be empty.
struct RunHooks {
  std::function<bool()> stop_requested;                ///< called after every step
  std::function<void(const RunProgress&)> progressed;  ///< called after every step
  std::function<void(const std::string&)> note;        ///< events in one line each
};

enum class RunEnd {
  complete,       ///< all steps done
  at_rest,        ///< time.stop_at_unbalanced_ratio was met, and lasted
  interrupted,    ///< stop_requested
  nothing_to_do,  ///< the run to resume was complete
};

struct RunReport {
  RunEnd end{RunEnd::complete};
  RunProgress progress;
  Measurement last;  ///< at the last step
  /// All quantities of the run at the last step, as the last row of history.csv has them.
  std::vector<MeasuredQuantity> measured;
  RunVerdict verdict;                ///< whether the figures mean something; on the root
  double energy_error{0};            ///< balance error [J]
  double energy_turnover{0};         ///< stored, lost and come in, as a measure for it [J]
  std::filesystem::path checkpoint;  ///< the latest; on the root
  std::string performance;           ///< see performance_table; on the root
  std::string stages;                ///< see stage_report; on the root
};

/// An Error that came up while steps were being made: not the input's fault, as far as is known.
class RunFailure : public Error {
 public:
  using Error::Error;
};

/// Runs a scene from start or checkpoint to its end, and keeps the folder's files. Whether it runs
/// in one go or is interrupted and resumed, history, fields and checkpoints end up the same to the
/// last bit. Throws Error before the first step for a folder or checkpoint that does not fit, and
/// RunFailure after it, on all ranks. Collective; `reading` and `scene`, which is valid and loaded,
/// are used only on the root, which writes all files.
RunReport run_scene(const SceneReading& reading, const LoadedScene& scene,
                    const RunOptions& options, const RunHooks& hooks,
                    const Communicator& ranks = {});

}  // namespace reckon
