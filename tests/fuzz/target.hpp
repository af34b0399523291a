// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "damage.hpp"

namespace reckon::fuzz {

/// A reader that must answer any input with success or with reckon::Error.
struct Target {
  std::string name;
  /// Small inputs that it accepts, which together use all of its features.
  std::function<std::vector<std::string>()> valid_inputs;
  std::function<void(const std::string& input)> read;
  /// How inputs are damaged where bytes are not enough, e.g. below a checksum.
  std::function<std::string(std::string_view input, RandomStream& random)> damage{damaged};
  /// How many times dearer than parsing a small text; so many times fewer cases are run.
  std::size_t cost{1};
};

/// Every reader of the library.
[[nodiscard]] std::vector<Target> all_targets();

}  // namespace reckon::fuzz
