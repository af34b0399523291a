// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/parallel/on_root.hpp"

#include <array>
#include <cstring>
#include <exception>
#include <optional>
#include <string>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr std::array text_parts{&ErrorText::place, &ErrorText::problem, &ErrorText::reason,
                                &ErrorText::fix};

/// The four parts one after another, each with a NUL behind it.
Bytes to_bytes(const ErrorText& text) {
  Bytes bytes;
  for (const auto part : text_parts) {
    const std::string& words = text.*part;
    const std::size_t end = bytes.size();
    bytes.resize(end + words.size() + 1);
    std::memcpy(bytes.data() + end, words.c_str(), words.size() + 1);
  }
  return bytes;
}

ErrorText to_text(const Bytes& bytes) {
  ErrorText text;
  const char* next = reinterpret_cast<const char*>(bytes.data());
  for (const auto part : text_parts) {
    text.*part = next;
    next += (text.*part).size() + 1;
  }
  return text;
}

}  // namespace

void on_root(const Communicator& ranks, const std::function<void()>& work) {
  std::optional<ErrorText> failure;
  if (ranks.is_root()) {
    try {
      work();
    } catch (const Error& error) {
      failure = error.text();
    } catch (const std::exception& error) {
      failure = ErrorText{.place = {}, .problem = error.what(), .reason = {}, .fix = {}};
    }
  }
  const Bytes news = ranks.broadcast(failure ? to_bytes(*failure) : Bytes{});
  if (!news.empty()) throw Error{to_text(news)};
}

}  // namespace reckon
