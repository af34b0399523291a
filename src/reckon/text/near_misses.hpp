// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

/// Advice on values that are nearly right, in scenes and on the command line: each function returns
/// what to write instead, as a sentence, or an empty text when it has no such advice.
namespace reckon {

/// On a number that cannot be read: a decimal comma ("0,5") or signs between digits ("2 650").
[[nodiscard]] std::string advice_on_number(std::string_view written);

/// On a whole number that cannot be read: "1e5", "10k", "1,000".
[[nodiscard]] std::string advice_on_whole_number(std::string_view written);

/// On a unit that is not known: "m3", "KN", "seconds".
[[nodiscard]] std::string advice_on_unit(std::string_view written);

/// On a line that is not TOML: a number with a unit or a text without quotation marks, `True`,
/// `.5`, `key: value`, and the like.
[[nodiscard]] std::string advice_on_toml_line(std::string_view line);

}  // namespace reckon
