// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace reckon::testing {

/// Makes calls of the system fail, as a full or a broken disk does. failing_calls.cpp replaces
/// open, read, pread, write, pwrite, lseek, ftruncate, fsync, close and rename of the process, also
/// for the libraries in it.
struct FailingCall {
  const char* call{nullptr};  ///< its name; "write" stands for pwrite, too, and "read" for pread
  const char* file{""};       ///< a part of the name of the file that it is about
  std::uint64_t number{0};    ///< which of the calls for such files fails, from 1 on; 0: none
  bool lasting{false};        ///< whether all later ones fail, too
  bool half{false};           ///< writes store half of their data, instead of failing
};

/// From now on. Counts from 1 again.
void set_failing_call(const FailingCall& failing);
/// Whether a call has failed since.
[[nodiscard]] bool call_has_failed();

}  // namespace reckon::testing
