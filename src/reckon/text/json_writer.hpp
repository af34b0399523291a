// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace reckon {

/// Writes JSON (RFC 8259), indented by two spaces, for programs that read the output of reckon.
/// Numbers read back as the same bits; infinities and NaN, which JSON lacks, become null.
///
///   JsonWriter json;                      {
///   json.begin_object();                    "steps": 10,
///   json.value("steps", 10);                "walls": [
///   json.begin_array("walls");                "floor"
///   json.value("floor");                    ]
///   json.end(); json.end();               }
class JsonWriter {
 public:
  void begin_object(std::string_view key = {}) { begin(key, '{', '}'); }
  void begin_array(std::string_view key = {}) { begin(key, '[', ']'); }
  void end();

  void value(std::string_view key, std::string_view text);
  void value(std::string_view key, const char* text) { value(key, std::string_view{text}); }
  void value(std::string_view key, double number);
  void value(std::string_view key, bool truth) { raw(key, truth ? "true" : "false"); }
  template <std::integral Integer>
  void value(std::string_view key, Integer number) {
    raw(key, std::to_string(number));
  }
  /// An element of an array.
  void value(std::string_view text) { value({}, text); }

  /// The text so far, with a line end; complete when all that began has ended.
  [[nodiscard]] std::string text() const { return out_ + '\n'; }

 private:
  void begin(std::string_view key, char open, char close);
  void raw(std::string_view key, std::string_view text);
  void next_place(std::string_view key);

  std::string out_;
  std::vector<char> closers_;  // of what has begun
  bool first_{true};           // whether the next thing is the first of its parent
};

/// A JSON string with its quotes, in UTF-8 whatever the text is (valid_utf8); TOML reads it as
/// well.
[[nodiscard]] std::string json_text(std::string_view text);

}  // namespace reckon
