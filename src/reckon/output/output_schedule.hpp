// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reckon/simulation/config.hpp"

namespace reckon {

/// Whether something that happens every `interval` steps happens at `step`; never when 0.
[[nodiscard]] constexpr bool is_due(std::uint64_t step, std::uint64_t interval) {
  return interval > 0 && step % interval == 0;
}

/// At which steps a run writes, given where its stages have begun so far. A stage's last step
/// belongs to it, is the first of the next, and always has a row and fields.
class OutputSchedule {
 public:
  OutputSchedule(const SceneConfig& scene, std::span<const std::uint64_t> stage_starts)
      : output_{scene.output},
        stages_{scene.stages},
        starts_{stage_starts.begin(), stage_starts.end()} {}

  void begin_stage(std::uint64_t step) { starts_.push_back(step); }

  [[nodiscard]] std::uint64_t history_interval(std::uint64_t step) const {
    return interval(step, &StageConfig::history_interval, output_.history_interval);
  }
  [[nodiscard]] bool history_due(std::uint64_t step) const {
    return is_boundary(step) || is_due(step, history_interval(step));
  }
  [[nodiscard]] bool fields_due(std::uint64_t step) const {
    return is_boundary(step) ||
           is_due(step, interval(step, &StageConfig::fields_interval, output_.fields_interval));
  }

 private:
  [[nodiscard]] bool is_boundary(std::uint64_t step) const {
    return step == 0 || std::find(starts_.begin(), starts_.end(), step) != starts_.end();
  }
  [[nodiscard]] std::uint64_t interval(std::uint64_t step,
                                       std::optional<std::uint64_t> StageConfig::*own,
                                       std::uint64_t standard) const {
    std::size_t stage = 0;
    while (stage + 1 < starts_.size() && starts_[stage + 1] < step) ++stage;
    return stage < stages_.size() ? (stages_[stage].*own).value_or(standard) : standard;
  }

  OutputConfig output_;
  std::vector<StageConfig> stages_;
  std::vector<std::uint64_t> starts_;
};

}  // namespace reckon
