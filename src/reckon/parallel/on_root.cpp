// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/parallel/on_root.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <exception>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/core/failure_text.hpp"
#include "reckon/core/write_failure.hpp"

namespace reckon {
namespace {

constexpr std::array text_parts{&ErrorText::place, &ErrorText::problem, &ErrorText::reason,
                                &ErrorText::fix};

/// A byte for whether the machine failed, then the four parts, each with a NUL behind it.
Bytes to_bytes(const ErrorText& text, bool machine_failed) {
  Bytes bytes{std::byte{machine_failed}};
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
  const char* next = reinterpret_cast<const char*>(bytes.data()) + 1;
  for (const auto part : text_parts) {
    text.*part = next;
    next += (text.*part).size() + 1;
  }
  return text;
}

}  // namespace

void on_root(const Communicator& ranks, const std::function<void()>& work) {
  Bytes failure;
  if (ranks.is_root()) {
    try {
      work();
    } catch (const std::exception& error) {
      failure = to_bytes(failure_text(error), is_failure_of_machine(error));
    }
  }
  const Bytes news = ranks.broadcast(failure);
  if (news.empty()) return;
  if (news.front() != std::byte{0}) throw MachineFailure{to_text(news)};
  throw Error{to_text(news)};
}

}  // namespace reckon
