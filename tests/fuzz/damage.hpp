// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "reckon/core/random.hpp"

namespace reckon::fuzz {

/// `input` with one to eight injuries, each drawn at random from the kinds that real files suffer
/// and that hostile ones use: flipped bits, lost, doubled and swapped pieces, cut ends, numbers
/// replaced by others that are huge, tiny, negative, no numbers, or at the edge of a type, in text
/// as well as in binary. Depends on `input` and the state of `random` only.
[[nodiscard]] std::string damaged(std::string_view input, RandomStream& random);

/// One of `size` places, evenly; size > 0.
[[nodiscard]] std::size_t draw_below(RandomStream& random, std::size_t size);

/// A number that arithmetic tends to trip over: zeros, infinities, NaN, denormals, edges of
/// integer types.
[[nodiscard]] double draw_nasty_number(RandomStream& random);

}  // namespace reckon::fuzz
