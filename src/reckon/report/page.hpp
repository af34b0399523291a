// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "reckon/report/run_pieces.hpp"

namespace reckon {

/// The page without data, as `viewer/` makes it, or nothing where this program was built without.
[[nodiscard]] std::string_view viewer_page();

/// The page with the data of these runs in it: one file that needs nothing else. `progressed` is
/// called with the number of saved times so far and in total. Saved times that cannot be read are
/// left out; `note` is called with the reason. Throws Error when a folder holds no run, or where
/// this program was built without the page.
[[nodiscard]] std::string report_page(
    std::span<const RunFolder> runs, const PageLimits& limits,
    const std::function<void(std::size_t done, std::size_t total)>& progressed = {},
    const std::function<void(const std::string&)>& note = {});

/// The page that requests its data from its server (report/watch_server.hpp).
[[nodiscard]] std::string live_page();

}  // namespace reckon
