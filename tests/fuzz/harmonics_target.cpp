// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/spherical_harmonics.hpp"
#include "targets.hpp"

namespace reckon::fuzz {

Target spherical_harmonics_target() {
  return {.name = "spherical_harmonics",
          .valid_inputs =
              [] {
                return std::vector<std::string>{
                    "0 0 3.5449 0\n"
                    "1 0 0.01 0\n1 1 0.02 -0.01\n"
                    "2 0 0.3 0\n2 1 -0.1 0.2\n2 2 0.05 1e-2\n",
                    "# n m Re Im\n0 0 2.0e0 0.0\n\n"
                    "1 -1 -0.02 -0.01\n1 0 0.01 0\n1 1 0.02 -0.01\n"};
              },
          .read =
              [](const std::string& input) {
                const SphericalHarmonicGrain grain =
                    parse_spherical_harmonics(input, "coefficients", 1e-3);
                (void)surface_mesh(grain, 2);
              },
          .cost = 4};
}

}  // namespace reckon::fuzz
