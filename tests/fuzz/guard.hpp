// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace reckon::fuzz {

/// While it exists, a crash, a report of a sanitizer, or more than `seconds` of computing keep the
/// input that caused it, in the file `path`, before they end the program. One at a time.
class Guard {
 public:
  Guard(const std::string& path, std::string_view input, int seconds);
  ~Guard();
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
};

}  // namespace reckon::fuzz
