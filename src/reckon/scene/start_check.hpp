// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "reckon/simulation/setup.hpp"

namespace reckon {

/// Faults of the positions of grains at the start: in the same pose twice, inside each other, or
/// beyond a wall. Contacts would be silent about such grains or throw them out. Where the scene
/// allows it (contact.allow_inside), these are warnings.
class StartCheck {
 public:
  /// Key, problem, fix.
  using Fault = std::function<void(std::string, std::string, std::string)>;
  using Warn = std::function<void(std::string)>;

  /// `first_ids` are those of the grains of each [[grains]] table.
  StartCheck(const LoadedScene& scene, std::span<const std::uint32_t> first_ids, Fault fault,
             Warn warn);

  void run();

 private:
  /// Where a grain comes from: a key of the scene, and words for a message.
  struct Origin {
    std::string key;
    std::string words;
  };
  [[nodiscard]] Origin origin_of(GrainId grain) const;
  /// "grain 4 (row 5 of poses.csv)"
  [[nodiscard]] std::string name_of(GrainId grain) const;
  void check_copies();
  void check_inside();
  void check_walls();
  void report(GrainId grain, std::string problem, const std::string& fix);

  const LoadedScene& scene_;
  std::span<const std::uint32_t> first_ids_;
  Fault fault_;
  Warn warn_;
};

}  // namespace reckon
