// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/spherical_harmonics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "expect_error.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

Vec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// The C++ library's own spherical Legendre functions are the oracle.
TEST(SphericalHarmonicBasis, AgreesWithTheStandardLibrary) {
  constexpr std::uint32_t degree = 60;
  const SphericalHarmonicBasis basis{degree};
  RandomStream random{1, RandomPurpose::other, 0};
  for (int trial = 0; trial < 300; ++trial) {
    const auto n = static_cast<std::uint32_t>(random.uniform(0, degree + 1));
    const auto m = static_cast<std::uint32_t>(random.uniform(0, n + 1));
    const double theta = random.uniform(0, std::numbers::pi);
    const double phi = random.uniform(-std::numbers::pi, std::numbers::pi);
    std::vector<std::complex<double>> a(SphericalHarmonicBasis::count(degree));
    a[SphericalHarmonicBasis::index(n, m)] = {m == 0 ? 0.0 : 0.3, 0};
    a[SphericalHarmonicBasis::index(n, m)] += std::complex<double>{0.4, m == 0 ? 0 : -0.7};
    const std::complex<double> y = std::sph_legendre(n, m, theta) * std::polar(1.0, m * phi);
    const std::complex<double> term = a[SphericalHarmonicBasis::index(n, m)] * y;
    const double expected = m == 0 ? term.real() : 2 * term.real();
    ASSERT_NEAR(basis.evaluate(a, direction(theta, phi)), expected, 2e-13) << n << ' ' << m;
  }
}

// At every degree, sum over m of |Y_nm|^2 is (2n + 1) / (4 pi), the poles included.
TEST(SphericalHarmonicBasis, HighDegreesObeyTheAdditionTheorem) {
  constexpr std::uint32_t n = SphericalHarmonicBasis::highest_degree;
  const SphericalHarmonicBasis basis{n};
  for (const Vec3& at : {Vec3{0, 0, -1}, direction(0.4, -2)}) {
    double sum = 0;
    std::vector<std::complex<double>> a(SphericalHarmonicBasis::count(n));
    for (std::uint32_t m = 0; m <= n; ++m) {
      auto& one = a[SphericalHarmonicBasis::index(n, m)];
      one = 1;
      const double real = basis.evaluate(a, at) / (m == 0 ? 1 : 2);
      one = {0, m == 0 ? 0.0 : 1.0};
      const double imaginary = basis.evaluate(a, at) / 2;
      one = 0;
      sum += (m == 0 ? 1 : 2) * (real * real + imaginary * imaginary);
    }
    EXPECT_NEAR(sum / ((2 * n + 1) / (4 * std::numbers::pi)), 1, 1e-10);
  }
}

// r = 2 + x-term: Y_11 carries the Condon-Shortley phase, so a_11 < 0 points towards +x.
TEST(SphericalHarmonicGrain, PhaseAndUnitAreRight) {
  const double y00 = 1 / std::sqrt(4 * std::numbers::pi);
  const double y11 = std::sqrt(3 / (8 * std::numbers::pi));
  std::ostringstream text;
  text.precision(17);
  text << "# a comment\n0 0 " << 2 / y00 << " 0\n1 1 " << -0.25 / y11 << " 0\n\n1 0 0 0\n1 -1 "
       << 0.25 / y11 << " 0\n";
  const auto grain = parse_spherical_harmonics(text.str(), "pear", 1e-3);
  const SphericalHarmonicBasis basis{grain.degree};
  EXPECT_NEAR(basis.evaluate(grain.coefficients, {1, 0, 0}), 2.5e-3, 1e-17);
  EXPECT_NEAR(basis.evaluate(grain.coefficients, {-1, 0, 0}), 1.5e-3, 1e-17);
  EXPECT_NEAR(basis.evaluate(grain.coefficients, {0, 1, 0}), 2e-3, 1e-17);
  const auto sphere = truncated(grain, 0);
  for (const Vec3& v : surface_mesh(sphere, 4).vertices) EXPECT_NEAR(norm(v), 2e-3, 1e-17);
  // Lines with m < 0 only repeat the others.
  text.str("");
  text << "0 0 " << 2 / y00 << " 0\n1 1 " << -0.25 / y11 << " 0\n1 0 0 0\n";
  EXPECT_EQ(parse_spherical_harmonics(text.str(), "pear", 1e-3).coefficients, grain.coefficients);
}

TEST(SphericalHarmonicGrain, BadInputIsNamed) {
  const auto parse = [](const char* text) {
    return [text] { (void)parse_spherical_harmonics(text, "grain.dat", 1e-3); };
  };
  using test::expect_error;
  expect_error(parse(""), {"grain.dat", "no coefficients"});
  expect_error(parse("0 0 1 0\n1 0 0 0\n1 1 0 0\n2 0 0 0\n2 2 0 0\n"), {"(2, 1) is missing"});
  expect_error(parse("0 0 1 0\n2 0 0 0\n2 1 0 0\n2 2 0 0\n"), {"(1, 0) is missing"});
  expect_error(parse("0 0 1 0\n1 0 0 0\n1 1 0 0\n1 1 0 0\n"), {"line 4", "(1, 1)", "twice"});
  expect_error(parse("0 0 1 0\n1 0 0 0\n1 1 0 0\n1 -1 0.1 0\n"), {"real radius", "(1, -1)"});
  expect_error(parse("0 0 1 0\n1 0 0 0.1\n1 1 0 0\n1 -1 0 0\n"), {"real radius", "(1, 0)"});
  expect_error(parse("0 0 1 zero\n"), {"line 1", "imaginary part", "'zero'"});
  expect_error(parse("0 0 1\n"), {"line 1", "imaginary part", "line ends"});
  expect_error(parse("0 0 nan 0\n"), {"line 1", "real part", "not finite"});
  expect_error(parse("0 0 1 0 7\n"), {"line 1", "four numbers"});
  expect_error(parse("1000000000 0 1 0\n"), {"line 1", "degree 1000000000", "512"});
  expect_error(parse("1 2 1 0\n"), {"line 1", "order 2", "degree 1"});
  expect_error([] { (void)parse_spherical_harmonics("0 0 1 0", "g", 0); }, {"unit"});
  expect_error([] { (void)read_spherical_harmonics("/nowhere/a.dat", 1); }, {"/nowhere/a.dat"});
  const auto grain = parse_spherical_harmonics("0 0 1 0\n1 0 5 0\n1 1 0 0\n", "grain.dat", 1);
  expect_error([&] { (void)surface_mesh(grain, 3); }, {"grain.dat", "not star-shaped", "r = -"});
  expect_error([&] { (void)truncated(grain, 2); }, {"grain.dat", "reaches degree 1"});
}

struct MeasuredGrain {
  std::string file;
  double volume;  // mm^3
  double area;    // mm^2
  std::uint32_t degree;
};

std::vector<MeasuredGrain> read_table(const std::string& path) {
  std::ifstream file{path};
  std::vector<MeasuredGrain> grains;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream row{line};
    MeasuredGrain grain;
    double skip = 0;
    row >> grain.file;
    for (int n = 0; n < 6; ++n) row >> skip;
    row >> grain.volume >> grain.area >> skip >> skip >> skip >> grain.degree;
    if (row) grains.push_back(grain);
  }
  return grains;
}

// X-ray computed tomography of crushed stone: 64 grains against their measured table.
TEST(SphericalHarmonicGrain, RealGrainsHaveTheirMeasuredVolumeAndArea) {
  const std::string folder = RECKON_SOURCE_DIR "/../shared/data/aggregate57/";
  const std::vector<MeasuredGrain> table = read_table(folder + "FDOT-57-geom.dat");
  if (table.empty()) GTEST_SKIP() << "no measured grains in " << folder;
  double worst_volume = 0;
  double worst_area = 0;
  int count = 0;
  for (const MeasuredGrain& measured : table) {
    const std::string path = folder + "anm/" + measured.file;
    if (!std::ifstream{path}) continue;  // the table holds more grains than the folder
    const auto grain = truncated(read_spherical_harmonics(path, 1e-3), measured.degree);
    const SolidProperties solid = solid_properties(surface_mesh(grain, 64));
    const double volume_error = solid.volume / (1e-9 * measured.volume) - 1;
    const double area_error = solid.surface_area / (1e-6 * measured.area) - 1;
    EXPECT_LT(std::abs(volume_error), 0.015) << measured.file;
    EXPECT_LT(std::abs(area_error), 0.02) << measured.file;
    worst_volume = std::max(worst_volume, std::abs(volume_error));
    worst_area = std::max(worst_area, std::abs(area_error));
    ++count;
  }
  EXPECT_EQ(count, 64);
  std::printf("worst of %d grains: volume %.2f %%, area %.2f %%\n", count, 100 * worst_volume,
              100 * worst_area);
}

}  // namespace
}  // namespace reckon
