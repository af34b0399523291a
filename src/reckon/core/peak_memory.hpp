// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace reckon {

/// The most memory that this process has held at once [bytes]; 0 where the system does not report
/// it.
[[nodiscard]] std::uint64_t peak_memory();

}  // namespace reckon
