// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// Appends the bytes of `value` to a message.
template <class Value>
requires std::is_trivially_copyable_v<Value>
void pack(Bytes& bytes, const Value& value) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof(Value));
  std::memcpy(bytes.data() + end, &value, sizeof(Value));
}

/// Appends a count and that many values.
template <class Value>
requires std::is_trivially_copyable_v<Value>
void pack(Bytes& bytes, std::span<const Value> values) {
  pack(bytes, static_cast<std::uint64_t>(values.size()));
  if (values.empty()) return;
  const std::size_t end = bytes.size();
  bytes.resize(end + values.size_bytes());
  std::memcpy(bytes.data() + end, values.data(), values.size_bytes());
}

/// Takes a message apart in the order in which it was packed.
class Unpacker {
 public:
  explicit Unpacker(const Bytes& bytes) : rest_{bytes} {}

  [[nodiscard]] bool done() const { return rest_.empty(); }

  template <class Value>
  [[nodiscard]] Value take() {
    Value value;
    copy_out(&value, sizeof(Value));
    return value;
  }
  template <class Value>
  [[nodiscard]] std::vector<Value> take_all() {
    std::vector<Value> values(static_cast<std::size_t>(take<std::uint64_t>()));
    copy_out(values.data(), values.size() * sizeof(Value));
    return values;
  }

 private:
  void copy_out(void* to, std::size_t size) {
    if (size > rest_.size()) throw Error{{.problem = "a message between ranks was cut short"}};
    if (size == 0) return;
    std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }

  std::span<const std::byte> rest_;
};

}  // namespace reckon
