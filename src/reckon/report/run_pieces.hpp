// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/output/run_folder.hpp"
#include "reckon/report/run_shapes.hpp"

namespace reckon {

/// How much of a long run goes into a page.
struct PageLimits {
  std::size_t frames{60};          ///< saved times in the three-dimensional view
  std::size_t history_rows{5000};  ///< rows of the history
};

/// `most` of these steps, evenly spread, with the first and the last; all where there are fewer.
[[nodiscard]] std::vector<std::uint64_t> spread_steps(const std::vector<std::uint64_t>& steps,
                                                      std::size_t most);

/// The data of a run for a page, read from its folder at each call. Missing data is left out, so a
/// run in progress can be shown.
class RunPieces {
 public:
  RunPieces(RunFolder folder, PageLimits limits);

  /// The steps whose fields go into the page.
  [[nodiscard]] std::vector<std::uint64_t> frame_steps() const;

  /// All but the grains at each saved time, as a Piece: the history, the shapes with their
  /// surfaces, walls, the scene, what ran and how long it took. Shapes are read once, since they
  /// never change. Steps that are `left_out` are none of its saved times. Throws Error when the
  /// folder holds no run, or what it holds is damaged.
  [[nodiscard]] std::string head(const std::vector<std::uint64_t>& left_out = {});

  /// Grains and contacts at one saved step, as a Piece. Throws Error as read_fields does, and when
  /// a grain has a shape that the run does not have.
  [[nodiscard]] std::string frame(std::uint64_t step);

 private:
  void read_shapes(const SceneConfig& scene);

  RunFolder folder_;
  PageLimits limits_;
  std::optional<RunShapes> shapes_;
};

}  // namespace reckon
