// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// A block of memory shared by all ranks of a machine, zero at first. Its root writes, all read
/// after a barrier. Alone on its machine, or where the system grants no shared memory, a rank holds
/// a block of its own: then shared() is false and every rank must write its own.
class SharedMemory {
 public:
  /// Collective. `machine` as Communicator::machine() gives it.
  SharedMemory(const Communicator& machine, std::size_t bytes);
  ~SharedMemory();  // collective
  SharedMemory(SharedMemory&&) noexcept;
  SharedMemory& operator=(SharedMemory&&) noexcept;

  [[nodiscard]] std::span<std::byte> bytes() const;  ///< aligned to 64 bytes
  [[nodiscard]] bool shared() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reckon
