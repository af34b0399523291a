// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "reckon/output/history.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/simulation/config.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {

/// Beyond this share of the smaller grain's diameter, an overlap is no contact any more.
constexpr double overlap_limit = 0.05;

/// One reason why the figures of a run mean nothing.
struct VerdictReason {
  std::string code;  ///< for scripts, e.g. "negative_void_ratio"
  std::string text;  ///< for people: what, how much, where
};

/// Whether the figures of a run mean something. A new reason is one more function in the list
/// `checks` of run_verdict.cpp.
struct RunVerdict {
  std::vector<VerdictReason> reasons;
  std::vector<std::string> notes;  ///< further remarks for the reader

  [[nodiscard]] bool valid() const { return reasons.empty(); }
  void add(std::string code, std::string text);
};

/// Nodes that lie too far apart, as a run has recorded it; see scene/node_spacing.hpp.
struct RecordedSpacing {
  std::string text;  ///< empty: they are close enough
  double unseen{0};  ///< depth to which a partner sinks in without a force, over its thickness
};

/// The history and the record of a run.
struct RunEvidence {
  const SceneConfig& scene;
  const HistoryTable& history;
  /// As in run.json; empty where there is none. A run in progress is not judged for what it has not
  /// reached yet.
  std::string status{};
  std::string message{};  ///< of a failure
  RecordedSpacing coarse_nodes{};
};

/// Tests for negative void ratios, deep overlaps, overlaps that no node sees, grains that are
/// outside or have left a sample, rates that are not quasi-static, a required rest that was not
/// reached, and a failure. Columns that the history lacks, as in runs of earlier versions, give no
/// reason.
[[nodiscard]] RunVerdict verdict_on(const RunEvidence& evidence);
/// The same with what the record of a run adds to its scene and history.
[[nodiscard]] RunVerdict verdict_on(const RunFolder& folder, const SceneConfig& scene,
                                    const HistoryTable& history);
/// The same from the files of a run.
[[nodiscard]] RunVerdict verdict_of(const RunFolder& folder);

/// What comes before all figures: a line, then a line for each reason, then the notes. Empty for a
/// valid run without notes.
[[nodiscard]] std::string verdict_text(const RunVerdict& verdict);
/// `valid`, `reasons` with a code and a text each, and `notes`.
void write_verdict(JsonWriter& json, const RunVerdict& verdict);

}  // namespace reckon
