// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace reckon {

/// The files of a stack of slices in the order of the numbers in their names, and what was assumed.
struct SliceOrder {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> remarks;
};

/// Orders slices by the one number that varies between their names: "img2" comes before "img10".
/// A number may have a decimal point, and a sign where some names have one and others do not, or
/// where it follows a blank, an underscore or an equals sign. Several numbers may vary if all of
/// them give the same order.
///
/// Throws Error, with the names, when numbers are missing or occur twice, when the names belong to
/// several series, and when two orders are possible.
[[nodiscard]] SliceOrder order_slices(std::vector<std::filesystem::path> files,
                                      const std::string& folder);

}  // namespace reckon
