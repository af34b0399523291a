// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/error.hpp"
#include "reckon/domain/balanced_decomposition.hpp"

namespace reckon {

std::vector<Region> bisect(const Communicator& /*ranks*/, std::span<const Vec3> /*positions*/,
                           std::span<const double> /*costs*/, int /*parts*/) {
  throw Error{{.problem = "decomposition \"balanced\" is not in this build",
               .reason = "it was configured without Zoltan",
               .fix = "Choose \"grid\", or build with -DRECKON_ZOLTAN=ON."}};
}

}  // namespace reckon
