// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/failure_text.hpp"

#include <cerrno>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "reckon/core/write_failure.hpp"

namespace reckon {
namespace {

bool is_out_of_memory(const std::exception& failure) {
  const auto* system = dynamic_cast<const std::system_error*>(&failure);
  return dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ||
         dynamic_cast<const std::length_error*>(&failure) != nullptr ||
         (system != nullptr && (system->code() == std::errc::not_enough_memory ||
                                system->code() == std::errc::resource_unavailable_try_again));
}

/// Throws an Error where a file is the cause; nothing else is thrown.
void throw_as_error(const std::filesystem::filesystem_error& failure) {
  throw_write_failure(failure.path1(), failure.code().value());
}

}  // namespace

ErrorText failure_text(const std::exception& failure) {
  if (const auto* error = dynamic_cast<const Error*>(&failure)) return error->text();
  if (is_out_of_memory(failure)) {
    return {.place = {},
            .problem = "there is not enough memory",
            .reason =
                "the machine, or a limit that is in force (ulimit -v, a batch job's share), "
                "gives no more",
            .fix =
                "`reckon check` says what a run takes: use fewer grains or coarser shapes, or "
                "more memory."};
  }
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&failure)) {
    try {
      throw_as_error(*file);
    } catch (const Error& error) {
      return error.text();
    }
  }
  return {.place = {}, .problem = failure.what(), .reason = {}, .fix = {}};
}

bool is_failure_of_machine(const std::exception& failure) {
  if (dynamic_cast<const MachineFailure*>(&failure) != nullptr || is_out_of_memory(failure)) {
    return true;
  }
  const auto* system = dynamic_cast<const std::system_error*>(&failure);
  if (system == nullptr) return false;
  for (const std::errc refused : {std::errc::no_space_on_device, std::errc::file_too_large,
                                  std::errc::io_error, std::errc::read_only_file_system}) {
    if (system->code() == refused) return true;
  }
  return system->code().value() == EDQUOT;
}

}  // namespace reckon
