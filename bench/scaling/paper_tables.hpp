// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace reckon::bench {

/// Peng Tan and Nicholas Sitar (2024): Parallel implementation of LS-DEM with hybrid MPI+OpenMP.
/// Computers and Geotechnics 172, 106408.
namespace paper {

constexpr double bin_size = 50;

/// Table 2: strong scaling of 42,684 grains in a cube of 600, 1000 steps.
struct BinRow {
  int ranks;
  double force_seconds;
  int theoretical_bins;
  int actual_bins;
};
constexpr double table_2_edge = 600;
constexpr std::array<BinRow, 20> table_2{{
    {1, 67083.43, 1728, 1728}, {2, 32727.49, 864, 1008}, {4, 17836.61, 432, 588},
    {6, 14422.88, 288, 504},   {8, 12661.43, 216, 343},  {12, 9261.44, 144, 294},
    {16, 6525.09, 108, 245},   {18, 8814.76, 96, 252},   {24, 7118.26, 72, 210},
    {27, 4896.77, 64, 216},    {32, 4940.85, 54, 175},   {36, 5545.15, 48, 180},
    {48, 4495.77, 36, 150},    {54, 4185.16, 32, 144},   {64, 3900.41, 27, 125},
    {72, 3431.75, 24, 120},    {96, 3218.85, 18, 100},   {108, 3486.49, 16, 96},
    {144, 3135.79, 12, 80},    {216, 2758.50, 8, 64},
}};

/// Table 3: weak scaling, 1000 steps.
struct WeakRow {
  int series;
  int grains;
  double edge;
  int ranks;
  int theoretical_bins;
  int actual_bins;
  double seconds;
};
constexpr std::array<WeakRow, 20> table_3{{
    {1, 481, 150, 1, 27, 27, 195.95},         {1, 3848, 300, 8, 27, 64, 321.87},
    {1, 12987, 450, 27, 27, 125, 360.88},     {1, 30784, 600, 64, 27, 125, 386.64},
    {1, 60125, 750, 125, 27, 125, 404.79},    {1, 103896, 900, 216, 27, 125, 399.62},
    {1, 164983, 1050, 343, 27, 125, 398.47},  {1, 246272, 1200, 512, 27, 125, 410.13},
    {2, 1328, 200, 1, 64, 64, 896.66},        {2, 10624, 400, 8, 64, 125, 955.22},
    {2, 35856, 600, 27, 64, 216, 1081.27},    {2, 84992, 800, 64, 64, 216, 1185.02},
    {2, 166000, 1000, 125, 64, 216, 1139.87}, {2, 286848, 1200, 216, 64, 216, 1133.78},
    {2, 455504, 1400, 343, 64, 216, 1155.67}, {2, 679936, 1600, 512, 64, 216, 1172.96},
    {3, 12494, 400, 8, 64, 125, 2501.74},     {3, 99952, 800, 64, 64, 216, 2755.65},
    {3, 337338, 1200, 216, 64, 216, 2984.45}, {3, 799616, 1600, 512, 64, 216, 2991.20},
}};

}  // namespace paper
}  // namespace reckon::bench
