// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/hdf5_handle.hpp"

#include <hdf5.h>

#include <type_traits>

namespace reckon {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>,
              "the headers keep HDF5's types as int64_t and int");

std::recursive_mutex& hdf5_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

}  // namespace

void skip_hdf5_cleanup_at_exit() { H5dont_atexit(); }

QuietHdf5::QuietHdf5() : lock_{hdf5_mutex()} {
  H5Eget_auto2(H5E_DEFAULT, &report_, &report_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, report_, report_data_); }

}  // namespace reckon
