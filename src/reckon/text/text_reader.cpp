// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/text_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }

/// from_chars takes no leading plus sign.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  return text;
}

TextReader::TextReader(std::string_view text, std::string name)
    : rest_{without_byte_order_mark(text)}, name_{std::move(name)} {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    fail("is text in UTF-16", "it begins with that encoding's byte-order mark",
         "Save the file as UTF-8 or plain ASCII.");
  }
}

bool TextReader::rest_of_line_is_blank() const {
  return std::all_of(line_.begin(), line_.end(), is_blank);
}

bool TextReader::next_line() {
  if (rest_.empty()) {
    line_ = {};
    return false;
  }
  const std::size_t end = rest_.find_first_of("\r\n");
  line_ = rest_.substr(0, end);
  std::size_t consumed = rest_.size();
  if (end != std::string_view::npos) {
    const bool two = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
    consumed = end + (two ? 2 : 1);
  }
  rest_.remove_prefix(consumed);
  ++line_number_;
  return true;
}

std::string_view TextReader::next_token() {
  std::size_t start = 0;
  while (start < line_.size() && is_blank(line_[start])) ++start;
  std::size_t end = start;
  while (end < line_.size() && !is_blank(line_[end])) ++end;
  const std::string_view token = line_.substr(start, end - start);
  line_.remove_prefix(end);
  return token;
}

std::string_view TextReader::next_token_anywhere() {
  for (;;) {
    const std::string_view token = next_token();
    if (!token.empty() || !next_line()) return token;
  }
}

double TextReader::next_double(std::string_view what) { return to_double(next_token(), what); }

std::int64_t TextReader::next_integer(std::string_view what) {
  return to_integer(next_token(), what);
}

double TextReader::to_double(std::string_view token, std::string_view what) const {
  const std::string_view digits = without_plus(token);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range && end == digits.data() + digits.size()) {
    fail("the " + std::string{what} + " " + in_quotes(token) + " is out of range",
         "double precision reaches from 1e-308 to 1e308", "Correct the number.");
  }
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) {
    fail("expected a number for the " + std::string{what},
         token.empty() ? "the line ends" : "found " + in_quotes(token),
         "Correct the line, or write the file again.");
  }
  if (!std::isfinite(value)) {
    fail("the " + std::string{what} + " is not finite", "found " + in_quotes(token),
         "Check what wrote the file.");
  }
  return value;
}

std::int64_t TextReader::to_integer(std::string_view token, std::string_view what) const {
  const std::string_view digits = without_plus(token);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) {
    fail("expected an integer for the " + std::string{what},
         token.empty() ? "the line ends" : "found " + in_quotes(token),
         "Correct the line, or write the file again.");
  }
  return value;
}

void TextReader::fail(std::string problem, std::string reason, std::string fix) const {
  throw Error{{.place = name_ + ", line " + std::to_string(line_number_),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out = "'";
  for (const char c : text.substr(0, longest)) {
    const auto code = static_cast<unsigned char>(c);
    out += code < 0x20 || code >= 0x7f ? '?' : c;
  }
  return out + (text.size() > longest ? "...'" : "'");
}

std::string lower_case(std::string_view text) {
  std::string out{text};
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

}  // namespace reckon
