// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "damage.hpp"

namespace reckon::fuzz {

/// A sealed HDF5 file (reckon/core/hdf5_file.hpp) in one of two conditions: damaged anywhere, which
/// its seal must betray; or with numbers of some datasets replaced, datasets removed, or datasets
/// with other extents, and then sealed again, so that only the reader's own checks can find it.
/// `folder` is for temporary files.
[[nodiscard]] std::string damaged_sealed_file(std::string_view input, RandomStream& random,
                                              const std::filesystem::path& folder);

}  // namespace reckon::fuzz
