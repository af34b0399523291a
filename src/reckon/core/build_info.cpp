// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/build_info.hpp"

#include "reckon/core/revision.hpp"

namespace reckon {

BuildInfo build_info() {
  return {.version = RECKON_VERSION,
          .revision = RECKON_REVISION,
          .compiler = RECKON_COMPILER,
          .flags = RECKON_COMPILER_FLAGS};
}

}  // namespace reckon
