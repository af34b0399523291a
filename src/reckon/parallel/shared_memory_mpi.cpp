// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mpi.h>

#include <cstdint>
#include <cstring>
#include <optional>

#include "reckon/parallel/mpi_handle.hpp"
#include "reckon/parallel/own_block.hpp"
#include "reckon/parallel/shared_memory.hpp"

namespace reckon {

struct SharedMemory::Impl {
  MPI_Win window{MPI_WIN_NULL};
  std::span<std::byte> shared;
  std::optional<OwnBlock> own;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (window != MPI_WIN_NULL) MPI_Win_free(&window);
  }
};

namespace {

constexpr std::size_t cache_line = 64;

/// The root's part of `window` from its first cache line on.
std::span<std::byte> root_part(MPI_Win window, std::size_t bytes) {
  MPI_Aint size = 0;
  int unit = 0;
  void* base = nullptr;
  MPI_Win_shared_query(window, 0, &size, &unit, static_cast<void*>(&base));
  const auto address = reinterpret_cast<std::uintptr_t>(base);
  const std::size_t gap = (cache_line - address % cache_line) % cache_line;
  return {static_cast<std::byte*>(base) + gap, bytes};
}

}  // namespace

SharedMemory::SharedMemory(const Communicator& machine, std::size_t bytes)
    : impl_{std::make_unique<Impl>()} {
  if (machine.size() > 1) {
    MPI_Comm handle = MpiAccess::handle(machine);
    // A machine that grants no shared memory, or too little, must not end the run.
    MPI_Comm_set_errhandler(handle, MPI_ERRORS_RETURN);
    void* base = nullptr;
    const auto own_part = static_cast<MPI_Aint>(machine.is_root() ? bytes + cache_line : 0);
    const int outcome = MPI_Win_allocate_shared(own_part, 1, MPI_INFO_NULL, handle,
                                                static_cast<void*>(&base), &impl_->window);
    MPI_Comm_set_errhandler(handle, MPI_ERRORS_ARE_FATAL);
    if (!machine.any(outcome != MPI_SUCCESS)) {
      impl_->shared = root_part(impl_->window, bytes);
      if (machine.is_root()) std::memset(impl_->shared.data(), 0, bytes);
      machine.barrier();
      return;
    }
    if (outcome == MPI_SUCCESS) MPI_Win_free(&impl_->window);
    impl_->window = MPI_WIN_NULL;
  }
  impl_->own.emplace(bytes);
}

SharedMemory::~SharedMemory() = default;
SharedMemory::SharedMemory(SharedMemory&&) noexcept = default;
SharedMemory& SharedMemory::operator=(SharedMemory&&) noexcept = default;

std::span<std::byte> SharedMemory::bytes() const {
  return impl_->own ? impl_->own->bytes() : impl_->shared;
}
bool SharedMemory::shared() const { return !impl_->own; }

}  // namespace reckon
