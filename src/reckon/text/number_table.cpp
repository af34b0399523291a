// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/number_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

constexpr std::string_view separators = " \t,\r";

[[noreturn]] void fail(const std::filesystem::path& file, std::size_t line, std::string problem,
                       std::string reason) {
  throw Error{{.place = fmt::format("{}:{}", file.string(), line),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = {}}};
}

}  // namespace

std::vector<double> read_number_table_text(std::string_view text, std::size_t width,
                                           const std::filesystem::path& file) {
  text = without_byte_order_mark(text);
  std::vector<double> values;
  std::size_t line_number = 0;
  std::size_t first_empty = 0;  // number of an empty line; only allowed at the end
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    if (line.starts_with('#')) continue;
    std::size_t count = 0;
    for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;
         at = line.find_first_not_of(separators, at)) {
      const std::size_t stop = std::min(line.find_first_of(separators, at), line.size());
      std::string_view word = line.substr(at, stop - at);
      at = stop;
      if (word.starts_with('+')) word.remove_prefix(1);
      double value = 0;
      const auto [last, code] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (code != std::errc{} || last != word.data() + word.size() || !std::isfinite(value)) {
        fail(file, line_number, fmt::format("\"{}\" is not a finite number", word.substr(0, 40)),
             fmt::format("number {} of the line", count + 1));
      }
      values.push_back(value);
      ++count;
    }
    if (count == 0 && first_empty == 0) first_empty = line_number;
    if (count == 0) continue;
    if (first_empty != 0) fail(file, first_empty, "is an empty line between others", {});
    if (count != width) {
      fail(file, line_number, fmt::format("has {} numbers", count),
           fmt::format("{} are needed", width));
    }
  }
  return values;
}

template <std::size_t width>
std::vector<std::array<double, width>> read_number_table(const std::filesystem::path& file) {
  const std::vector<double> values = read_number_table_text(read_file(file), width, file);
  std::vector<std::array<double, width>> rows(values.size() / width);
  for (std::size_t n = 0; n < rows.size() * width; ++n) rows[n / width][n % width] = values[n];
  return rows;
}

template std::vector<std::array<double, 3>> read_number_table<3>(const std::filesystem::path&);
template std::vector<std::array<double, 4>> read_number_table<4>(const std::filesystem::path&);
template std::vector<std::array<double, 8>> read_number_table<8>(const std::filesystem::path&);

}  // namespace reckon
