// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/parallel/own_block.hpp"
#include "reckon/parallel/shared_memory.hpp"

namespace reckon {

struct SharedMemory::Impl {
  OwnBlock own;
};

SharedMemory::SharedMemory(const Communicator& /*machine*/, std::size_t bytes)
    : impl_{std::make_unique<Impl>(Impl{OwnBlock{bytes}})} {}
SharedMemory::~SharedMemory() = default;
SharedMemory::SharedMemory(SharedMemory&&) noexcept = default;
SharedMemory& SharedMemory::operator=(SharedMemory&&) noexcept = default;
std::span<std::byte> SharedMemory::bytes() const { return impl_->own.bytes(); }
bool SharedMemory::shared() const { return false; }

}  // namespace reckon
