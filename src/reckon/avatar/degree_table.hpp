// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace reckon {

/// Reads a table that gives spherical-harmonic files their degrees: a header line with columns
/// "Name" and "Nnn", then a line per file. The columns are separated by blanks, or by the commas or
/// semicolons that stand in the header line; then cells may be empty or in double quotes. Returns
/// degree by file name. Throws Error naming the line.
[[nodiscard]] std::map<std::string, std::uint32_t> parse_degree_table(std::string_view text,
                                                                      const std::string& name);

}  // namespace reckon
