// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/degree_table.hpp"
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
                    "0,0,3.5449,0\n1;0;0.01;0\n1,1,0.02,-0.01\n",
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

Target degree_table_target() {
  return {.name = "degree_table",
          .valid_inputs =
              [] {
                return std::vector<std::string>{
                    "Name volume Nnn\na.dat 3.5 26\n\nb.dat 1 12\n",
                    "\xef\xbb\xbfName,\"volume\",Nnn\r\n\"a, b.dat\",,26\r\nc.dat,1, 12\r\n",
                    "Name;volume;Nnn\na.dat;3,5;26\n"};
              },
          .read = [](const std::string& input) { (void)parse_degree_table(input, "table"); }};
}

}  // namespace reckon::fuzz
