// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "reckon/core/error.hpp"

namespace reckon {

/// The machine is at fault and not the input: a disk is full or fails, a quota or a limit is
/// reached, the memory is used up. Programs end with another exit code than for other errors.
class MachineFailure : public Error {
 public:
  using Error::Error;
};

/// Throws MachineFailure for a file that was refused with this errno (0: not known). The text names
/// the file system and how much of it is free, and the remedy. Where the user gave the wrong place
/// (a folder that is missing or may not be written) it throws a plain Error.
[[noreturn]] void throw_write_failure(const std::filesystem::path& file, int error_number,
                                      const std::string& problem = "cannot be written");

}  // namespace reckon
