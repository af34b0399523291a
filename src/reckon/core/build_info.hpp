// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace reckon {

/// The identity of this program, which a result must record to be traceable.
struct BuildInfo {
  std::string_view version;
  std::string_view revision;  ///< of the source tree; ends in "-dirty" when it had changes
  std::string_view compiler;  ///< name and version
  std::string_view flags;     ///< that the build was configured with
};

[[nodiscard]] BuildInfo build_info();

}  // namespace reckon
