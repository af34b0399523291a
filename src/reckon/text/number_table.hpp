// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace reckon {

/// Reads lines of `width` finite numbers each, separated by blanks or commas, as one array, row by
/// row. Empty lines at the end are left out; lines that begin with # are comments. `file` is for
/// messages. Throws Error with file, line and column.
[[nodiscard]] std::vector<double> read_number_table_text(std::string_view text, std::size_t width,
                                                         const std::filesystem::path& file);

/// The same from a file, row by row.
template <std::size_t width>
[[nodiscard]] std::vector<std::array<double, width>> read_number_table(
    const std::filesystem::path& file);

extern template std::vector<std::array<double, 3>> read_number_table<3>(
    const std::filesystem::path& file);
extern template std::vector<std::array<double, 4>> read_number_table<4>(
    const std::filesystem::path& file);
extern template std::vector<std::array<double, 8>> read_number_table<8>(
    const std::filesystem::path& file);

}  // namespace reckon
