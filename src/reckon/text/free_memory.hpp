// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace reckon {

/// The memory that this process may still allocate: that of the system, or its own limit [bytes].
/// The largest number where the system does not report it.
[[nodiscard]] std::uint64_t free_memory();

/// Throws Error when `what` needs more memory than there is, before it is allocated.
void require_memory(std::uint64_t bytes, const std::string& what, const std::string& fix);

}  // namespace reckon
