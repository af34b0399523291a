// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// The ranks of an MPI communicator that another library made, such as mpi4py, by its Fortran
/// handle, which is a number in every MPI. It stays the other's, and must outlive what is returned.
/// Throws Error in a build without MPI.
[[nodiscard]] Communicator communicator_of(int fortran_handle);

}  // namespace reckon
