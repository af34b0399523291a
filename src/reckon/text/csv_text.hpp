// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace reckon {

/// A name as a cell of a CSV table (RFC 4180): in quotes where it holds a comma, a quote, an end of
/// line or blanks at its ends. Programs for tables would take a name that begins with `=`, `+`, `-`
/// or `@` for a formula: an apostrophe goes before it, which they show as text.
[[nodiscard]] std::string csv_text(std::string_view name);

/// The parts of a line between its commas, one at least. Quotation marks have no meaning.
[[nodiscard]] std::vector<std::string_view> comma_separated(std::string_view line);

}  // namespace reckon
