// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/displacement_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// By how much the rows of a rotation matrix may miss length one, squared; and what that can do to
/// a distance of matrices, with the rounding of turn_distance itself.
constexpr double squared_length_tolerance = 1e-14;
constexpr double turn_slack = 1e-13;

constexpr double round_up = 1 + 4 * std::numeric_limits<double>::epsilon();

}  // namespace

double turn_distance(const Mat3& from, const Mat3& to) {
  const double frobenius_squared = squared_norm(to.row_x - from.row_x) +
                                   squared_norm(to.row_y - from.row_y) +
                                   squared_norm(to.row_z - from.row_z);
  return std::sqrt(0.5 * frobenius_squared) * round_up + turn_slack;
}

bool is_rotation(const Mat3& matrix) {
  // The homogeneous form scales all rows alike.
  return std::abs(squared_norm(matrix.row_x) - 1) <= squared_length_tolerance;
}

void DisplacementBound::begin(std::span<const GrainFrame> frames, const CellMotion* cell) {
  cell_.reset();
  if (cell != nullptr && cell->deformation != UpperMat3::identity()) cell_ = *cell;
  const bool same_slots =
      std::equal(frames.begin(), frames.end(), seen_.begin(), seen_.end(),
                 [](const GrainFrame& frame, const Seen& seen) { return frame.id == seen.id; });
  if (!same_slots) reorder(frames);
  trustworthy_ = true;
}

double DisplacementBound::motion_of(const GrainFrame& now, const Seen& before) const {
  const double turned = now.shape->bounding_radius * turn_distance(before.rotation, now.rotation);
  if (!cell_) return norm(now.position - before.position) + turned;
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  return norm(now.position - cell_->carried(before.position)) + 0.5 * cell_->of_pair() +
         rounding * (norm(now.position) + norm(cell_->center)) + turned;
}

void DisplacementBound::follow(std::span<const GrainFrame> frames, std::size_t first,
                               std::size_t last) {
  const double bad = parallel_max(last - first, 0, [&](std::size_t n) {
    const std::size_t slot = first + n;
    const GrainFrame& now = frames[slot];
    Seen& before = seen_[slot];
    if (cell_ || now.position != before.position || now.rotation != before.rotation) {
      path_lengths_[slot] = (path_lengths_[slot] + motion_of(now, before)) * round_up;
      before.position = now.position;
      before.rotation = now.rotation;
    }
    return is_rotation(now.rotation) ? 0.0 : 1.0;
  });
  trustworthy_ = trustworthy_ && bad == 0;
}

void DisplacementBound::reorder(std::span<const GrainFrame> frames) {
  std::vector<std::uint32_t> by_id(seen_.size());
  for (std::uint32_t slot = 0; slot < by_id.size(); ++slot) by_id[slot] = slot;
  std::sort(by_id.begin(), by_id.end(),
            [&](std::uint32_t s, std::uint32_t t) { return seen_[s].id < seen_[t].id; });
  std::vector<Seen> seen(frames.size());
  std::vector<double> travelled(frames.size(), 0.0);
  for (std::size_t slot = 0; slot < frames.size(); ++slot) {
    const GrainFrame& frame = frames[slot];
    const auto old =
        std::lower_bound(by_id.begin(), by_id.end(), frame.id,
                         [&](std::uint32_t s, GrainId id) { return seen_[s].id < id; });
    if (old != by_id.end() && seen_[*old].id == frame.id) {
      seen[slot] = seen_[*old];
      travelled[slot] = path_lengths_[*old];
    } else {
      seen[slot] = {frame.id, frame.position, frame.rotation};
    }
  }
  seen_ = std::move(seen);
  path_lengths_ = std::move(travelled);
}

}  // namespace reckon
