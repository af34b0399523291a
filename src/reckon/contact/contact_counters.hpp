// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace reckon {

/// How much work the search for contacts did; summed over steps. They tell why a run is fast or
/// slow and do not depend on threads.
struct ContactCounters {
  std::uint64_t evaluations{0};   ///< calls of evaluate()
  std::uint64_t pairs{0};         ///< listed
  std::uint64_t due{0};           ///< pairs that could not be skipped
  std::uint64_t tested_nodes{0};  ///< phi looked up
  std::uint64_t cells_read{0};    ///< of which the grid was read for
  std::uint64_t touching_pairs{0};
  std::uint64_t touching_nodes{0};
  std::uint64_t lists_checked{0};   ///< net motion compared with a list's allowance
  std::uint64_t lists_made{0};      ///< near lists made anew
  std::uint64_t listed_nodes{0};    ///< nodes in those
  std::uint64_t searched_nodes{0};  ///< nodes looked at for those

  ContactCounters& operator+=(const ContactCounters& b) {
    evaluations += b.evaluations;
    pairs += b.pairs;
    due += b.due;
    tested_nodes += b.tested_nodes;
    cells_read += b.cells_read;
    touching_pairs += b.touching_pairs;
    touching_nodes += b.touching_nodes;
    lists_checked += b.lists_checked;
    lists_made += b.lists_made;
    listed_nodes += b.listed_nodes;
    searched_nodes += b.searched_nodes;
    return *this;
  }
  /// What was counted since `b`.
  [[nodiscard]] ContactCounters operator-(const ContactCounters& b) const {
    return {evaluations - b.evaluations,
            pairs - b.pairs,
            due - b.due,
            tested_nodes - b.tested_nodes,
            cells_read - b.cells_read,
            touching_pairs - b.touching_pairs,
            touching_nodes - b.touching_nodes,
            lists_checked - b.lists_checked,
            lists_made - b.lists_made,
            listed_nodes - b.listed_nodes,
            searched_nodes - b.searched_nodes};
  }
  friend bool operator==(const ContactCounters&, const ContactCounters&) = default;
};

}  // namespace reckon
