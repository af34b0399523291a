// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// Orthonormal spherical harmonics for m >= 0 at one direction.
///
/// Y_nm = sqrt((2n+1)(n-m)! / (4 pi (n+m)!)) P_nm(cos theta) exp(i m phi), with the
/// Condon-Shortley phase (-1)^m in P_nm. The normalised Legendre functions come from the standard
/// forward column recursion, which is stable far beyond the degrees allowed here (Holmes &
/// Featherstone 2002); exp(i m phi) from repeated multiplication. Square roots only.
class SphericalHarmonicBasis {
 public:
  static constexpr std::uint32_t highest_degree = 512;

  /// Throws Error when degree > highest_degree.
  explicit SphericalHarmonicBasis(std::uint32_t degree);

  [[nodiscard]] std::uint32_t degree() const { return degree_; }

  /// Place of (n, m), 0 <= m <= n, among coefficients.
  [[nodiscard]] static std::size_t index(std::uint32_t n, std::uint32_t m) {
    return std::size_t{n} * (n + 1) / 2 + m;
  }
  [[nodiscard]] static std::size_t count(std::uint32_t degree) { return index(degree + 1, 0); }

  /// The real function sum over n and all m of a_nm Y_nm at a unit vector, where `coefficients`
  /// holds a_nm for m >= 0 by index(), and a_n,-m = (-1)^m conj(a_nm).
  [[nodiscard]] double evaluate(std::span<const std::complex<double>> coefficients,
                                const Vec3& direction) const;

 private:
  std::uint32_t degree_;
  // P_nm = along_[nm] (cos theta P_n-1,m) - back_[nm] P_n-2,m;  P_mm = diagonal_[m] sin theta
  // P_m-1,m-1
  std::vector<double> along_;
  std::vector<double> back_;
  std::vector<double> diagonal_;
};

/// A star-shaped grain, r(theta, phi) = sum a_nm Y_nm with the harmonics above, theta measured from
/// z and phi from x towards y.
struct SphericalHarmonicGrain {
  std::uint32_t degree{0};
  std::vector<std::complex<double>> coefficients;  ///< m >= 0, by SphericalHarmonicBasis::index [m]
  std::string name;                                ///< for messages
};

/// Parses lines `n m Re Im`, in any order, `unit_in_metres` to the metre. All m of a degree up to
/// the highest must be there; those with m < 0 may be left out of the whole file. Empty lines and
/// lines from # on are skipped. Throws Error naming file and line.
[[nodiscard]] SphericalHarmonicGrain parse_spherical_harmonics(std::string_view text,
                                                               const std::string& name,
                                                               double unit_in_metres);
[[nodiscard]] SphericalHarmonicGrain read_spherical_harmonics(const std::filesystem::path& path,
                                                              double unit_in_metres);

/// The grain without the degrees above `degree`. Throws Error when it does not reach that degree.
[[nodiscard]] SphericalHarmonicGrain truncated(SphericalHarmonicGrain grain, std::uint32_t degree);

/// The surface, sampled at the vertices of geodesic_sphere(frequency). Closed, and free of
/// self-intersections since it is star-shaped. Throws Error where r <= 0.
[[nodiscard]] TriangleMesh surface_mesh(const SphericalHarmonicGrain& grain,
                                        std::uint32_t frequency);

}  // namespace reckon
