// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>

#include <memory>
#include <utility>

#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// No impl: a single rank. No MPI call is made, so a serial run does not start MPI.
struct Communicator::Impl {
  MPI_Comm handle;
  int rank;
  int size;
};

/// The MPI communicator behind `ranks`, and the other way round. Only in parallel/ and domain/.
struct MpiAccess {
  [[nodiscard]] static MPI_Comm handle(const Communicator& ranks) {
    return ranks.impl_ ? ranks.impl_->handle : MPI_COMM_SELF;
  }
  /// The ranks of `handle`, which must outlive what is returned.
  [[nodiscard]] static Communicator ranks(MPI_Comm handle) {
    auto impl = std::make_shared<Communicator::Impl>();
    impl->handle = handle;
    MPI_Comm_rank(handle, &impl->rank);
    MPI_Comm_size(handle, &impl->size);
    return Communicator{std::move(impl)};
  }
};

}  // namespace reckon
