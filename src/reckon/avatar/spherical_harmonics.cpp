// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/spherical_harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

// Coefficients are printed with ten digits; a real radius leaves no more than their rounding.
constexpr double real_tolerance = 1e-6;

struct Term {
  std::int64_t n;
  std::int64_t m;
  std::complex<double> value;
  std::size_t line;
};

std::vector<Term> parse_terms(TextReader& reader) {
  std::vector<Term> terms;
  while (reader.next_line()) {
    const std::string_view first = reader.next_token();
    if (first.empty() || first.front() == '#') continue;
    Term term{};
    term.n = reader.to_integer(first, "degree n");
    term.m = reader.next_integer("order m");
    const double real = reader.next_double("real part");
    term.value = {real, reader.next_double("imaginary part")};
    term.line = reader.line_number();
    constexpr std::int64_t highest = SphericalHarmonicBasis::highest_degree;
    if (term.n < 0 || term.n > highest) {
      reader.fail("degree " + std::to_string(term.n) + " is out of range",
                  "0 to " + std::to_string(highest), "Check that the lines read 'n m Re Im'.");
    }
    if (term.m < -term.n || term.m > term.n) {
      reader.fail("order " + std::to_string(term.m) + " does not belong to degree " +
                      std::to_string(term.n),
                  "m runs from -n to n", "Check that the lines read 'n m Re Im'.");
    }
    if (const std::string_view extra = reader.next_token();
        !extra.empty() && extra.front() != '#') {
      reader.fail("there is more than four numbers", "found " + in_quotes(extra),
                  "Check that the lines read 'n m Re Im'.");
    }
    terms.push_back(term);
  }
  return terms;
}

[[noreturn]] void fail(const std::string& name, std::string problem, std::string reason,
                       std::string fix) {
  throw Error{{.place = name,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

std::string label(std::int64_t n, std::int64_t m) {
  return "(" + std::to_string(n) + ", " + std::to_string(m) + ")";
}

/// Sorted terms must name every (n, m) once, for m from -n or, throughout the file, from 0.
void require_complete(const std::vector<Term>& terms, bool with_negative, const std::string& name) {
  std::size_t at = 0;
  for (std::int64_t n = 0; n <= terms.back().n; ++n) {
    for (std::int64_t m = with_negative ? -n : 0; m <= n; ++m, ++at) {
      if (at < terms.size() && terms[at].n == n && terms[at].m == m) continue;
      if (at > 0 && at < terms.size() && terms[at].n == terms[at - 1].n &&
          terms[at].m == terms[at - 1].m) {
        fail(name + ", line " + std::to_string(terms[at].line),
             "coefficient " + label(terms[at].n, terms[at].m) + " is given twice", "",
             "Remove one of the two lines.");
      }
      fail(name, "coefficient " + label(n, m) + " is missing",
           "the file reaches degree " + std::to_string(terms.back().n) +
               ", and every order of each degree up to it is needed",
           "Complete the file, or cut it after the last complete degree.");
    }
  }
  if (at < terms.size()) {
    fail(name + ", line " + std::to_string(terms[at].line),
         "coefficient " + label(terms[at].n, terms[at].m) + " is given twice", "",
         "Remove one of the two lines.");
  }
}

/// A real radius needs a_n,-m = (-1)^m conj(a_nm).
void require_real(const std::vector<Term>& terms, const std::string& name) {
  const double scale = std::abs(terms.front().value);
  for (const Term& term : terms) {
    // Degree n stands at n^2 ... (n + 1)^2 - 1, order m at n^2 + n + m.
    const Term& mirror = terms[static_cast<std::size_t>(term.n * term.n + term.n - term.m)];
    const std::complex<double> expected = (term.m % 2 == 0 ? 1.0 : -1.0) * std::conj(mirror.value);
    if (std::abs(term.value - expected) <= real_tolerance * scale) continue;
    fail(name + ", line " + std::to_string(term.line),
         "coefficients " + label(term.n, term.m) + " and " + label(term.n, -term.m) +
             " do not give a real radius",
         "a(n,-m) must be (-1)^m times the complex conjugate of a(n,m)",
         "Check that the file holds radii r(theta, phi) with the Condon-Shortley phase.");
  }
}

}  // namespace

SphericalHarmonicBasis::SphericalHarmonicBasis(std::uint32_t degree) : degree_{degree} {
  if (degree > highest_degree) {
    throw Error{{.place = "spherical harmonics",
                 .problem = "degree " + std::to_string(degree) + " is too high",
                 .reason = "the limit is " + std::to_string(highest_degree),
                 .fix = "Truncate at a lower degree."}};
  }
  along_.resize(count(degree));
  back_.resize(count(degree));
  diagonal_.resize(degree + 1);
  diagonal_[0] = 1 / std::sqrt(4 * std::numbers::pi);
  for (std::uint32_t m = 0; m <= degree; ++m) {
    const double mm = m;
    if (m > 0) diagonal_[m] = -std::sqrt((2 * mm + 1) / (2 * mm));
    for (std::uint32_t n = m + 1; n <= degree; ++n) {
      const double nn = n;
      const double scale = (4 * nn * nn - 1) / (nn * nn - mm * mm);
      along_[index(n, m)] = std::sqrt(scale);
      back_[index(n, m)] =
          n < m + 2
              ? 0
              : std::sqrt(scale * ((nn - 1) * (nn - 1) - mm * mm) / (4 * (nn - 1) * (nn - 1) - 1));
    }
  }
}

double SphericalHarmonicBasis::evaluate(std::span<const std::complex<double>> coefficients,
                                        const Vec3& direction) const {
  const double cos_theta = direction.z;
  const double sin_theta = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  const double cos_phi = sin_theta > 0 ? direction.x / sin_theta : 1;
  const double sin_phi = sin_theta > 0 ? direction.y / sin_theta : 0;
  double sum = 0;
  double diagonal = 1;
  double cos_m = 1;
  double sin_m = 0;
  for (std::uint32_t m = 0; m <= degree_; ++m) {
    diagonal *= m == 0 ? diagonal_[0] : diagonal_[m] * sin_theta;
    double before = 0;
    double legendre = diagonal;
    double column = 0;  // sum over n of Re(a_nm exp(i m phi)) P_nm
    for (std::uint32_t n = m; n <= degree_; ++n) {
      if (n > m) {
        const double next =
            along_[index(n, m)] * cos_theta * legendre - back_[index(n, m)] * before;
        before = legendre;
        legendre = next;
      }
      const std::complex<double>& a = coefficients[index(n, m)];
      column += (a.real() * cos_m - a.imag() * sin_m) * legendre;
    }
    sum += m == 0 ? column : 2 * column;  // m and -m contribute conjugates
    const double cos_next = cos_m * cos_phi - sin_m * sin_phi;
    sin_m = sin_m * cos_phi + cos_m * sin_phi;
    cos_m = cos_next;
  }
  return sum;
}

SphericalHarmonicGrain parse_spherical_harmonics(std::string_view text, const std::string& name,
                                                 double unit_in_metres) {
  if (!(unit_in_metres > 0) || !std::isfinite(unit_in_metres)) {
    fail(name, "has no usable length unit", std::to_string(unit_in_metres) + " m",
         "Give a unit above zero, such as 0.001 for millimetres.");
  }
  std::string plain{text};
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  TextReader reader{plain, name};
  std::vector<Term> terms = parse_terms(reader);
  if (terms.empty()) {
    fail(name, "holds no coefficients", "expected lines 'n m Re Im'", "Check the file.");
  }
  std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
    return std::tie(a.n, a.m, a.line) < std::tie(b.n, b.m, b.line);
  });
  const bool with_negative =
      std::any_of(terms.begin(), terms.end(), [](const Term& term) { return term.m < 0; });
  require_complete(terms, with_negative, name);
  if (with_negative) require_real(terms, name);

  SphericalHarmonicGrain grain{static_cast<std::uint32_t>(terms.back().n), {}, name};
  for (const Term& term : terms) {
    if (term.m >= 0) grain.coefficients.push_back(unit_in_metres * term.value);
  }
  return grain;
}

SphericalHarmonicGrain read_spherical_harmonics(const std::filesystem::path& path,
                                                double unit_in_metres) {
  return parse_spherical_harmonics(read_file(path), path.string(), unit_in_metres);
}

SphericalHarmonicGrain truncated(SphericalHarmonicGrain grain, std::uint32_t degree) {
  if (degree > grain.degree) {
    fail(grain.name, "cannot be truncated at degree " + std::to_string(degree),
         "it reaches degree " + std::to_string(grain.degree), "Choose a lower degree.");
  }
  grain.degree = degree;
  grain.coefficients.resize(SphericalHarmonicBasis::count(degree));
  return grain;
}

TriangleMesh surface_mesh(const SphericalHarmonicGrain& grain, std::uint32_t frequency) {
  const SphericalHarmonicBasis basis{grain.degree};
  TriangleMesh mesh = geodesic_sphere(frequency);
  for (Vec3& vertex : mesh.vertices) {
    const double radius = basis.evaluate(grain.coefficients, vertex);
    if (!(radius > 0) || !std::isfinite(radius)) {
      fail(grain.name, "is not star-shaped: its radius is not positive everywhere",
           "r = " + std::to_string(radius) + " m towards (" + std::to_string(vertex.x) + ", " +
               std::to_string(vertex.y) + ", " + std::to_string(vertex.z) + ")",
           "Truncate at a lower degree, or check the coefficients.");
    }
    vertex = radius * vertex;
  }
  return mesh;
}

}  // namespace reckon
