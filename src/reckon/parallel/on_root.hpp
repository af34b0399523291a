// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// Collective. Runs `work` on the root. When it throws there, all ranks throw an Error of the same
/// text, so that none is left waiting for the others.
void on_root(const Communicator& ranks, const std::function<void()>& work);

}  // namespace reckon
