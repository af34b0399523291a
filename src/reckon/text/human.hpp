// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace reckon {

/// "640 B", "12.3 MB"; powers of 1000.
[[nodiscard]] std::string human_bytes(std::uint64_t bytes);
/// "0.42 s", "3 min 20 s", "2 h 05 min", "3 d 04 h".
[[nodiscard]] std::string human_duration(double seconds);
/// "12,345,678"
[[nodiscard]] std::string human_count(std::uint64_t count);
/// "1 grain", "12,345 grains": for nouns whose plural ends in s.
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view noun);
/// A number with as many digits, two at least, as show on which side of a limit it lies.
[[nodiscard]] std::string human_beside(double value, double limit);
/// A word of a command that can be pasted into a shell, in quotes if it needs them.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace reckon
