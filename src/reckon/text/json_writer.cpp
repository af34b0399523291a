// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/json_writer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "reckon/core/utf8.hpp"

namespace reckon {

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char letter : valid_utf8(text)) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      out += '\\';
      out += letter;
    } else if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\u{:04x}", code);
    } else {
      out += letter;
    }
  }
  return out + '"';
}

void JsonWriter::begin(std::string_view key, char open, char close) {
  next_place(key);
  out_ += open;
  closers_.push_back(close);
  first_ = true;
}

void JsonWriter::end() {
  const char close = closers_.back();
  closers_.pop_back();
  if (!first_) {
    out_ += '\n';
    out_.append(2 * closers_.size(), ' ');
  }
  out_ += close;
  first_ = false;
}

void JsonWriter::value(std::string_view key, std::string_view text) { raw(key, json_text(text)); }

void JsonWriter::value(std::string_view key, double number) {
  raw(key, std::isfinite(number) ? fmt::format("{}", number) : "null");
}

void JsonWriter::raw(std::string_view key, std::string_view text) {
  next_place(key);
  out_ += text;
}

void JsonWriter::next_place(std::string_view key) {
  if (closers_.empty()) return;
  if (!first_) out_ += ',';
  first_ = false;
  out_ += '\n';
  out_.append(2 * closers_.size(), ' ');
  if (!key.empty()) out_ += json_text(key) + ": ";
}

}  // namespace reckon
