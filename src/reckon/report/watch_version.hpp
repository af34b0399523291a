// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reckon/output/run_folder.hpp"

namespace reckon {

/// A word that changes when a run has written something: a hash over the names, lengths and times
/// of its files.
[[nodiscard]] std::string version_of(const RunFolder& folder);

}  // namespace reckon
