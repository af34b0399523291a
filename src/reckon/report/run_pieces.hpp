// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "reckon/io/run_folder.hpp"

namespace reckon {

/// How much of a long run goes into a page.
struct PageLimits {
  std::size_t frames{60};          ///< saved times in the three-dimensional view
  std::size_t history_rows{5000};  ///< rows of the history
};

/// `most` of these steps, evenly spread, with the first and the last; all where there are fewer.
[[nodiscard]] std::vector<std::uint64_t> spread_steps(const std::vector<std::uint64_t>& steps,
                                                      std::size_t most);

/// The steps of a run whose fields go into a page.
[[nodiscard]] std::vector<std::uint64_t> frame_steps(const RunFolder& folder,
                                                     const PageLimits& limits);

/// All that a page shows of a run but the grains at each saved time, as a Piece: the history, the
/// shapes with their surfaces, walls, the scene, what ran and how long it took. Throws Error when
/// the folder holds no run, or what it holds is damaged. What is missing is left out.
[[nodiscard]] std::string head_piece(const RunFolder& folder, const PageLimits& limits);

/// Grains and contacts at one saved step, as a Piece. Throws Error as read_fields does.
[[nodiscard]] std::string frame_piece(const RunFolder& folder, std::uint64_t step);

}  // namespace reckon
