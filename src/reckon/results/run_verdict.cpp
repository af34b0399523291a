// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/run_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "reckon/results/run_record.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/results/stage_report.hpp"
#include "reckon/simulation/measurement.hpp"
#include "reckon/simulation/setup.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A history with the quantities that the checks need.
class Evidence {
 public:
  explicit Evidence(const RunEvidence& evidence)
      : scene_{evidence.scene},
        history_{evidence.history},
        columns_{evidence.history},
        coarse_nodes_{evidence.coarse_nodes},
        ended_{evidence.status != "running"} {}

  [[nodiscard]] const SceneConfig& scene() const { return scene_; }
  [[nodiscard]] const HistoryTable& history() const { return history_; }
  [[nodiscard]] const RecordedSpacing& coarse_nodes() const { return coarse_nodes_; }
  [[nodiscard]] std::size_t rows() const { return history_.rows.size(); }
  /// Whether no session is at work on the run.
  [[nodiscard]] bool ended() const { return ended_; }
  /// NaN where there is no such column.
  [[nodiscard]] double at(std::size_t row, std::string_view column) const {
    return columns_.has(column) ? columns_.at(row, column) : unknown;
  }
  /// The stage that a row belongs to, as a place in the scene.
  [[nodiscard]] std::optional<std::size_t> stage_of(std::size_t row) const {
    const double stage = at(row, "stage");
    if (!(stage >= 1) || stage > static_cast<double>(scene_.stages.size())) return std::nullopt;
    return static_cast<std::size_t>(stage) - 1;
  }
  [[nodiscard]] bool is_last_of_stage(std::size_t row) const {
    return row + 1 == rows() || stage_of(row + 1) != stage_of(row);
  }
  /// Whether figures are taken from a row: it is the last one of the run or of a stage, or belongs
  /// to a stage that shears the sample.
  [[nodiscard]] bool counts(std::size_t row) const {
    if (is_last_of_stage(row)) return true;
    const auto stage = stage_of(row);
    return stage && is_driven(scene_.stages[*stage]);
  }
  /// "at step 1200, stage shear"
  [[nodiscard]] std::string place(std::size_t row) const {
    const auto stage = stage_of(row);
    return fmt::format("at step {:.0f}{}", at(row, "step"),
                       stage ? ", stage " + scene_.stages[*stage].name : std::string{});
  }
  /// The row with the largest value of a column among those that count, if that is above `limit`.
  [[nodiscard]] std::optional<std::size_t> worst(std::string_view column, double limit) const {
    std::optional<std::size_t> found;
    for (std::size_t row = 0; row < rows(); ++row) {
      if (!counts(row) || !(at(row, column) > limit)) continue;
      if (!found || at(row, column) > at(*found, column)) found = row;
    }
    return found;
  }

 private:
  const SceneConfig& scene_;
  const HistoryTable& history_;
  HistoryColumns columns_;
  const RecordedSpacing& coarse_nodes_;
  bool ended_;
};

void check_void_ratio(const Evidence& evidence, RunVerdict& verdict) {
  std::optional<std::size_t> worst;
  for (std::size_t row = 0; row < evidence.rows(); ++row) {
    if (!evidence.counts(row) || !(evidence.at(row, "void_ratio") < 0)) continue;
    if (!worst || evidence.at(row, "void_ratio") < evidence.at(*worst, "void_ratio")) worst = row;
  }
  if (!worst) return;
  verdict.add("negative_void_ratio",
              fmt::format("void ratio {:.3f} {}: there is less space than the grains have volume",
                          evidence.at(*worst, "void_ratio"), evidence.place(*worst)));
}

void check_overlap(const Evidence& evidence, RunVerdict& verdict) {
  const auto worst = evidence.worst("overlap_ratio", overlap_limit);
  if (!worst) return;
  verdict.add("deep_overlap",
              fmt::format("an overlap of {:.3g} % of a grain's diameter {}, above {:.2g} %: the "
                          "contacts are too soft for their load",
                          100 * evidence.at(*worst, "overlap_ratio"), evidence.place(*worst),
                          100 * overlap_limit));
}

/// The reported overlap is that of the nodes. What they cannot see must be small as well.
void check_spacing(const Evidence& evidence, RunVerdict& verdict) {
  const RecordedSpacing& spacing = evidence.coarse_nodes();
  if (spacing.text.empty()) return;
  if (spacing.unseen > overlap_limit) return verdict.add("coarse_nodes", spacing.text);
  verdict.notes.push_back(spacing.text);
}

void check_grains(const Evidence& evidence, RunVerdict& verdict) {
  if (const auto worst = evidence.worst("outside", 0)) {
    verdict.add("grains_outside",
                fmt::format("{:.0f} grain(s) behind a wall {}", evidence.at(*worst, "outside"),
                            evidence.place(*worst)));
  }
  if (evidence.rows() == 0) return;
  const std::size_t last = evidence.rows() - 1;
  const bool is_sample = !evidence.scene().stages.empty() && evidence.at(last, "volume_m3") > 0;
  if (is_sample && evidence.at(last, "departed") > 0) {
    verdict.add("grains_lost", fmt::format("{:.0f} grain(s) have left the sample by an outflow",
                                           evidence.at(last, "departed")));
  }
}

void check_rates(const Evidence& evidence, RunVerdict& verdict) {
  for (const StageFinding& found : stage_findings(evidence.scene(), evidence.history())) {
    if (found.quasi_static()) continue;
    verdict.add(
        "too_fast",
        fmt::format("stage {} is too fast: inertial number {}, above {}; lower its rate",
                    found.stage, human_beside(found.inertial_number, quasi_static_inertial_number),
                    quasi_static_inertial_number));
  }
}

/// The measures of rest in a row; runs of earlier versions did not write all of them.
Measurement rest_of(const Evidence& evidence, std::size_t row) {
  Measurement m;
  m.unbalanced_ratio = evidence.at(row, "unbalanced_ratio");
  m.carried_share = evidence.at(row, "carried_share");
  m.kinetic_ratio = evidence.at(row, "kinetic_ratio");
  if (std::isnan(m.carried_share)) m.carried_share = 0.5 * evidence.at(row, "coordination");
  if (std::isnan(m.kinetic_ratio)) m.kinetic_ratio = 0;
  return m;
}

void add_unrest(const Evidence& evidence, std::size_t row, double asked, const Measurement& m,
                RunVerdict& verdict) {
  verdict.add("not_at_rest",
              fmt::format("not at rest {}: unbalanced ratio {:.2g} (asked for: below {:.2g}), "
                          "contacts carry {:.3g} % of the mass, kinetic ratio {:.2g}",
                          evidence.place(row), m.unbalanced_ratio, asked, 100 * m.carried_share,
                          m.kinetic_ratio));
}

/// A run that was to stop at rest must be at rest at its end. A stage that was to bring the sample
/// to rest may miss its goal by a factor of ten before what follows is worthless.
void check_rest(const Evidence& evidence, RunVerdict& verdict) {
  if (evidence.rows() == 0) return;
  const SceneConfig& scene = evidence.scene();
  const std::size_t last = evidence.rows() - 1;
  if (const auto asked = scene.time.stop_at_unbalanced_ratio; asked && evidence.ended()) {
    const Measurement m = rest_of(evidence, last);
    if (!is_at_rest(m, *asked)) add_unrest(evidence, last, *asked, m, verdict);
  }
  constexpr double tolerance = 10;
  for (std::size_t row = 0; row < evidence.rows(); ++row) {
    const auto stage = evidence.stage_of(row);
    if (!stage || !evidence.is_last_of_stage(row)) continue;
    if (row == last && !evidence.ended()) continue;
    const auto& goal = scene.stages[*stage].until;
    if (!goal || !goal->unbalanced_ratio) continue;
    const Measurement m = rest_of(evidence, row);
    if (std::isnan(m.unbalanced_ratio)) continue;
    if (is_at_rest(m, tolerance * *goal->unbalanced_ratio)) continue;
    add_unrest(evidence, row, *goal->unbalanced_ratio, m, verdict);
  }
}

/// A run that was not to come to rest, as a drum or a hopper, may end in motion; but one in free
/// fall under gravity has not shown anything yet.
void note_flight(const Evidence& evidence, RunVerdict& verdict) {
  if (evidence.rows() == 0 || evidence.scene().body.gravity == Vec3{}) return;
  const std::size_t last = evidence.rows() - 1;
  const Measurement m = rest_of(evidence, last);
  const auto says_so = [](const VerdictReason& reason) { return reason.code == "not_at_rest"; };
  const bool is_told = std::ranges::any_of(verdict.reasons, says_so);
  if (is_told || !(m.carried_share < rest_carried_share)) return;
  verdict.notes.push_back(fmt::format("not at rest {}: contacts carry {:.3g} % of the mass",
                                      evidence.place(last), 100 * m.carried_share));
}

constexpr auto checks = {check_spacing, check_void_ratio, check_overlap, check_grains,
                         check_rates,   check_rest,       note_flight};

}  // namespace

void RunVerdict::add(std::string code, std::string text) {
  reasons.push_back({std::move(code), std::move(text)});
}

RunVerdict verdict_on(const RunEvidence& evidence) {
  RunVerdict verdict;
  if (evidence.status == "failed") verdict.add("failed", "the run failed: " + evidence.message);
  const Evidence found{evidence};
  for (const auto& check : checks) check(found, verdict);
  return verdict;
}

RunVerdict verdict_on(const RunFolder& folder, const SceneConfig& scene,
                      const HistoryTable& history) {
  const RecordedOutcome outcome = recorded_outcome(folder.own(folder.json()));
  return verdict_on({scene, history, outcome.status, outcome.message, outcome.coarse_nodes});
}

RunVerdict verdict_of(const RunFolder& folder) {
  const SceneConfig scene = scene_of_run(folder);
  const std::filesystem::path file = folder.own(folder.history());
  HistoryTable history;
  if (std::filesystem::exists(file)) {
    history = read_history(file);
    require_columns(file, history, quantity_groups(make_walls(scene)));
  }
  return verdict_on(folder, scene, history);
}

std::string verdict_text(const RunVerdict& verdict) {
  std::string text;
  if (!verdict.valid()) text = "THE FIGURES OF THIS RUN MEAN NOTHING:\n";
  for (const VerdictReason& reason : verdict.reasons) text += "  - " + reason.text + '\n';
  for (const std::string& note : verdict.notes) text += "note: " + note + '\n';
  return text;
}

void write_verdict(JsonWriter& json, const RunVerdict& verdict) {
  json.value("valid", verdict.valid());
  json.begin_array("reasons");
  for (const VerdictReason& reason : verdict.reasons) {
    json.begin_object();
    json.value("code", reason.code);
    json.value("text", reason.text);
    json.end();
  }
  json.end();
  json.begin_array("notes");
  for (const std::string& note : verdict.notes) json.value(note);
  json.end();
}

}  // namespace reckon
