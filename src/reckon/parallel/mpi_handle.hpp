// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>

#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// No impl: one rank, alone, and no MPI call is made, so a plain serial run needs no MPI start.
struct Communicator::Impl {
  MPI_Comm handle;
  int rank;
  int size;
};

/// The MPI communicator behind `ranks`, for libraries that speak MPI themselves. Only in domain/.
struct MpiAccess {
  [[nodiscard]] static MPI_Comm handle(const Communicator& ranks) {
    return ranks.impl_ ? ranks.impl_->handle : MPI_COMM_SELF;
  }
};

}  // namespace reckon
