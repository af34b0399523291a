// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "reckon/core/file.hpp"  // read_file, which most users of a reader need

namespace reckon {

/// Walks through a text line by line and token by token, and keeps the position, so that every
/// complaint names file and line. Tokens are separated by blanks; \n, \r\n and \r end lines. Does
/// not own the text.
class TextReader {
 public:
  /// Skips the byte-order mark of UTF-8. Throws Error for text in UTF-16, which would fall apart.
  TextReader(std::string_view text, std::string name);

  /// Goes to the next line. False at the end of the text.
  bool next_line();

  /// The next token of this line; empty at the end of the line.
  [[nodiscard]] std::string_view next_token();

  /// The next token of this line, or of the first later line that has one; empty at the end.
  [[nodiscard]] std::string_view next_token_anywhere();

  /// A finite number; throws Error naming `what` was expected.
  [[nodiscard]] double next_double(std::string_view what);
  [[nodiscard]] std::int64_t next_integer(std::string_view what);

  /// The same for a token that has been taken already.
  [[nodiscard]] double to_double(std::string_view token, std::string_view what) const;
  [[nodiscard]] std::int64_t to_integer(std::string_view token, std::string_view what) const;

  /// Throws Error for the current line.
  [[noreturn]] void fail(std::string problem, std::string reason, std::string fix) const;

  /// What follows the current line, and what is left of it.
  [[nodiscard]] std::string_view remaining_text() const { return rest_; }
  [[nodiscard]] std::string_view remaining_line() const { return line_; }
  [[nodiscard]] bool rest_of_line_is_blank() const;
  [[nodiscard]] std::size_t line_number() const { return line_number_; }

 private:
  std::string_view rest_;  // after the current line
  std::string_view line_;  // what is left of the current line
  std::string name_;
  std::size_t line_number_{0};
};

/// The text behind the byte-order mark of UTF-8, which some programs put in front of every file.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// A piece of an input for an error text: cut short, control characters replaced.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// With A to Z in lower case; other bytes stay, whatever the locale.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace reckon
