// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/units.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr Dimension length{0, 1, 0, 0};
constexpr Dimension pressure{1, -1, -2, 0};

TEST(Units, DecimalMultiplesAreRoundedOnce) {
  EXPECT_EQ(parse_quantity("0.2 mm").value, 0.0002);
  EXPECT_EQ(parse_quantity("0.3 um").value, 3e-7);
  EXPECT_EQ(parse_quantity("2.65 g/cm^3").value, 2650.0);
  EXPECT_EQ(parse_quantity("1.1 kN/m^2").value, 1100.0);
  EXPECT_EQ(parse_quantity("1e3MPa").value, 1e9);
  EXPECT_EQ(parse_quantity("-7.1e-3 L").value, -7.1e-6);
  EXPECT_EQ(parse_quantity("12 %").value, 0.12);
}

TEST(Units, OtherMultiples) {
  EXPECT_EQ(parse_quantity("30 deg").value, 30 * (std::numbers::pi / 180));
  EXPECT_EQ(parse_quantity("2 min").value, 120.0);
  EXPECT_EQ(parse_quantity("36 m/h").value, 0.01);
  EXPECT_EQ(parse_quantity("60 rpm").value, 60 * (std::numbers::pi / 30));
}

TEST(Units, DimensionsOfProductsAndPowers) {
  EXPECT_EQ(parse_unit("mm").dimension, length);
  EXPECT_EQ(parse_unit("Pa").dimension, pressure);
  EXPECT_EQ(parse_unit("N/m^2").dimension, pressure);
  EXPECT_EQ(parse_unit("kg m^-1 s^-2").dimension, pressure);
  EXPECT_EQ(parse_unit("kg/m/s/s").dimension, pressure);
  EXPECT_EQ(parse_unit("kg / m * s^-2").dimension, pressure);
  EXPECT_EQ(parse_unit("1/s").dimension, (Dimension{0, 0, -1, 0}));
  EXPECT_EQ(parse_unit("m/s²").dimension, (Dimension{0, 1, -2, 0}));
  EXPECT_EQ(parse_unit("cm³").dimension, (Dimension{0, 3, 0, 0}));
  EXPECT_EQ(parse_unit("rad/s").dimension, (Dimension{0, 0, -1, 1}));
  EXPECT_EQ(parse_unit("").dimension, Dimension{});
}

TEST(Units, LettersThatCouldBePrefixes) {
  EXPECT_EQ(parse_quantity("1 min").value, 60.0);
  EXPECT_EQ(parse_quantity("1 m").value, 1.0);
  EXPECT_EQ(parse_quantity("1 ms").dimension, (Dimension{0, 0, 1, 0}));
  EXPECT_EQ(parse_quantity("1 mPa").value, 0.001);
  EXPECT_EQ(parse_quantity("1 t").value, 1000.0);
  EXPECT_EQ(parse_quantity("1 µm").value, 1e-6);
}

TEST(Units, RefusesWhatIsNoQuantity) {
  for (const char* text : {"",        " ",      "mm",      "1 furlong",       "1 m//s",
                           "1 m/",    "1 m^",   "1 m^1.5", "1 m^99999999999", "--1 m",
                           "1e999",   "nan",    "inf",     "1e400 mm",        "0x10",
                           "1.2.3 m", "1 kmin", "1 m^2^2", "1e99999999999 m", "1 \xff"}) {
    EXPECT_THROW((void)parse_quantity(text), Error) << text;
  }
}

TEST(Units, DescribesDimensions) {
  EXPECT_EQ(describe(pressure), "kg m^-1 s^-2");
  EXPECT_EQ(describe(Dimension{}), "1");
}

}  // namespace
}  // namespace reckon
