// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace reckon {

/// The text as valid UTF-8 (RFC 3629): each byte that is none becomes U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// The text as a terminal and a log may show it: control characters and bytes that are no UTF-8
/// become \xNN. A file's name could otherwise move the cursor or forge lines. Ends of lines and
/// tabs stay.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace reckon
