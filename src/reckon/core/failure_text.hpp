// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>

#include "reckon/core/error.hpp"

namespace reckon {

/// The text of an exception for a user, also of one that is not ours: a memory that is used up, a
/// file system that refuses.
[[nodiscard]] ErrorText failure_text(const std::exception& failure);

/// Whether the machine is the reason and not the input: no memory, a disk that takes no more.
[[nodiscard]] bool is_failure_of_machine(const std::exception& failure);

}  // namespace reckon
