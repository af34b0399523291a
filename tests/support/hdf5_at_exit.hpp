// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/core/hdf5_handle.hpp"

namespace reckon::test {

/// For tests that make writes fail: as in the program, the HDF5 library must not tidy up at exit,
/// where it crashes on files that a full disk kept from being closed.
inline const bool hdf5_skips_cleanup_at_exit = [] {
  skip_hdf5_cleanup_at_exit();
  return true;
}();

}  // namespace reckon::test
