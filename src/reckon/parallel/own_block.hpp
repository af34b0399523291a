// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <span>

namespace reckon {

/// A block of this process alone, zero at first, aligned to a cache line.
class OwnBlock {
 public:
  explicit OwnBlock(std::size_t size)
      : memory_{static_cast<std::byte*>(::operator new(size + 1, alignment))}, size_{size} {
    std::memset(memory_.get(), 0, size_);
  }

  [[nodiscard]] std::span<std::byte> bytes() const { return {memory_.get(), size_}; }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Release {
    void operator()(std::byte* memory) const { ::operator delete(memory, alignment); }
  };

  std::unique_ptr<std::byte, Release> memory_;
  std::size_t size_;
};

}  // namespace reckon
