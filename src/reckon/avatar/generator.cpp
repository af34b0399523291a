// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/generator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/random_variates.hpp"
#include "reckon/avatar/rounded_polyhedron.hpp"
#include "reckon/avatar/spherical_harmonics.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

constexpr std::uint32_t most_faces_allowed = 100;
constexpr std::uint32_t highest_degree_allowed = 100;

[[noreturn]] void fail(const std::string& field, const std::string& value,
                       const std::string& range) {
  throw Error{{.place = "grain statistics",
               .problem = field + " is " + value,
               .reason = "it must lie in " + range,
               .fix = "Correct it."}};
}

void require_range(const char* field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  fail(field, fmt::format("{}", value), fmt::format("[{}, {}]", low, high));
}

void require_spread(const char* field, const Spread& spread, double low, double high) {
  const std::string name = field;
  require_range((name + ".mean").c_str(), spread.mean, low, high);
  // The largest deviation a beta distribution can have; at two thirds of it, it is flat or less.
  const double limit = std::sqrt((spread.mean - low) * (high - spread.mean));
  if (spread.deviation == 0 || (spread.deviation > 0 && spread.deviation < limit)) return;
  fail(name + ".deviation", fmt::format("{}", spread.deviation),
       fmt::format("[0, {:.4g}), for a mean of {} between {} and {}", limit, spread.mean, low,
                   high));
}

/// The random variables of one grain.
struct Form {
  double diameter;
  double elongation;
  double flatness;
  double roundness;
  std::uint32_t faces;
};

double draw_diameter(const GrainStatistics& statistics, RandomStream& random) {
  constexpr int most_draws = 10000;
  double diameter = statistics.median_diameter;
  for (int n = 0; n < most_draws; ++n) {
    diameter = statistics.median_diameter *
               portable::exp(statistics.log_deviation * standard_normal(random));
    if (diameter >= statistics.smallest_diameter && diameter <= statistics.largest_diameter) break;
  }
  return std::clamp(diameter, statistics.smallest_diameter, statistics.largest_diameter);
}

Form draw_form(const GrainStatistics& statistics, RandomStream& random) {
  const auto draw = [&](const Spread& spread, double low, double high) {
    return bounded_variate(random, spread.mean, spread.deviation, low, high);
  };
  Form form{};
  form.diameter = draw_diameter(statistics, random);
  form.elongation = draw(statistics.elongation, GrainStatistics::lowest_ratio, 1);
  form.flatness = draw(statistics.flatness, GrainStatistics::lowest_ratio, 1);
  form.roundness = draw(statistics.roundness, 0, GrainStatistics::highest_roundness);
  const std::uint32_t choices = statistics.most_faces - statistics.fewest_faces + 1;
  form.faces = statistics.fewest_faces + static_cast<std::uint32_t>(random.uniform() * choices);
  return form;
}

/// Directions that keep some distance from each other, as the faces of worn stones do: each is the
/// best of a few random candidates (Mitchell 1991).
std::vector<Vec3> draw_face_normals(std::uint32_t count, RandomStream& random) {
  constexpr int candidates = 6;
  std::vector<Vec3> normals;
  for (std::uint32_t n = 0; n < count; ++n) {
    Vec3 best;
    double best_nearness = 2;
    for (int c = 0; c < candidates; ++c) {
      const Vec3 candidate = random_direction(random);
      double nearness = -1;  // cosine of the angle to the nearest
      for (const Vec3& other : normals) nearness = std::max(nearness, dot(candidate, other));
      if (nearness < best_nearness) {
        best = candidate;
        best_nearness = nearness;
      }
    }
    normals.push_back(best);
  }
  return normals;
}

/// Faces that cut an ellipsoid with half-axes 1, e, e f, each to a depth of its own.
std::vector<HalfSpace> draw_faces(const Form& form, double irregularity, RandomStream& random) {
  const Vec3 half_axes{1, form.elongation, form.elongation * form.flatness};
  const auto tangent = [&](const Vec3& normal) { return norm(hadamard(half_axes, normal)); };
  std::vector<HalfSpace> faces;
  for (const Vec3& normal : draw_face_normals(form.faces, random)) {
    faces.push_back({normal, tangent(normal) * (1 - irregularity * random.uniform())});
  }
  // A box around it all keeps corners from growing long where faces happen to be sparse.
  constexpr double box = 1.15;
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    faces.push_back({axis, box * tangent(axis)});
    faces.push_back({-axis, box * tangent(axis)});
  }
  return faces;
}

/// Coefficients of a Gaussian random field on the unit sphere with the wanted variance.
std::vector<std::complex<double>> draw_roughness(const GrainStatistics& statistics,
                                                 RandomStream& random) {
  std::vector<double> weight(statistics.highest_degree + 1);
  for (std::uint32_t n = statistics.lowest_degree; n <= statistics.highest_degree; ++n) {
    weight[n] = 1 / portable::pow(n, 1 + 2 * statistics.hurst);
  }
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  std::vector<std::complex<double>> coefficients(
      SphericalHarmonicBasis::count(statistics.highest_degree));
  for (std::uint32_t n = statistics.lowest_degree; n <= statistics.highest_degree; ++n) {
    // The 2n + 1 harmonics of degree n share its variance; their squares sum to (2n + 1) / (4 pi).
    const double variance = statistics.roughness * statistics.roughness * weight[n] / total;
    const double deviation = std::sqrt(variance * 4 * std::numbers::pi / (2 * n + 1));
    for (std::uint32_t m = 0; m <= n; ++m) {
      const double part = m == 0 ? deviation : deviation / std::numbers::sqrt2;
      const double real = part * standard_normal(random);
      const double imaginary = m == 0 ? 0 : part * standard_normal(random);
      coefficients[SphericalHarmonicBasis::index(n, m)] = {real, imaginary};
    }
  }
  return coefficients;
}

/// Directions and how much the surface is scaled along each.
struct RoughSphere {
  TriangleMesh sphere;
  std::vector<double> scale;

  RoughSphere(const SphericalHarmonicBasis& basis,
              const std::vector<std::complex<double>>& coefficients, std::uint32_t frequency)
      : sphere{geodesic_sphere(frequency)} {
    for (const Vec3& direction : sphere.vertices) {
      scale.push_back(portable::exp(basis.evaluate(coefficients, direction)));
    }
  }

  [[nodiscard]] TriangleMesh on(const RoundedPolyhedron& body) const {
    TriangleMesh mesh = sphere;
    for (std::size_t v = 0; v < scale.size(); ++v) {
      mesh.vertices[v] *= scale[v] * body.radius(sphere.vertices[v]);
    }
    return mesh;
  }
};

Vec3 extents_of(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  return box.high - box.low;
}

/// Factors along the axes that turn `extents`, in their order of size, into 1 : e : e f, and leave
/// the product of the extents as it is.
Vec3 form_factors(const Vec3& extents, const Form& form) {
  std::array<int, 3> by_size{0, 1, 2};
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](int a, int b) { return extents[a] > extents[b]; });
  const std::array<double, 3> wanted{1, form.elongation, form.elongation * form.flatness};
  Vec3 factors;
  for (std::size_t rank = 0; rank < 3; ++rank) {
    factors[by_size[rank]] = wanted[rank] / extents[by_size[rank]];
  }
  return factors / portable::cbrt(factors.x * factors.y * factors.z);
}

/// The half spaces after moving the centroid to the origin and scaling along the principal axes.
std::vector<HalfSpace> reshaped(const std::vector<HalfSpace>& half_spaces,
                                const PrincipalFrame& frame, const Vec3& factors) {
  std::vector<HalfSpace> result;
  for (const HalfSpace& h : half_spaces) {
    const Vec3 turned = frame.rotation * h.normal;
    const Vec3 normal{turned.x / factors.x, turned.y / factors.y, turned.z / factors.z};
    const double length = norm(normal);
    result.push_back({normal / length, (h.offset - dot(h.normal, frame.origin_mesh)) / length});
  }
  return result;
}

TriangleMesh scaled(TriangleMesh mesh, const Vec3& factors) {
  for (Vec3& v : mesh.vertices) v = hadamard(factors, v);
  return mesh;
}

}  // namespace

void GrainStatistics::validate() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(median_diameter > 0 && median_diameter < infinity)) {
    fail("median_diameter", fmt::format("{} m", median_diameter), "(0, inf)");
  }
  require_range("log_deviation", log_deviation, 0, 2);
  if (!(smallest_diameter >= 0 && smallest_diameter <= median_diameter)) {
    fail("smallest_diameter", fmt::format("{} m", smallest_diameter), "[0, median_diameter]");
  }
  if (!(largest_diameter >= median_diameter)) {
    fail("largest_diameter", fmt::format("{} m", largest_diameter), "[median_diameter, inf]");
  }
  require_spread("elongation", elongation, lowest_ratio, 1);
  require_spread("flatness", flatness, lowest_ratio, 1);
  require_spread("roundness", roundness, 0, highest_roundness);
  require_range("fewest_faces", fewest_faces, 6, most_faces_allowed);
  require_range("most_faces", most_faces, fewest_faces, most_faces_allowed);
  require_range("face_irregularity", face_irregularity, 0, 0.5);
  require_range("roughness", roughness, 0, 0.2);
  require_range("hurst", hurst, 0, 2);
  require_range("lowest_degree", lowest_degree, 2, highest_degree_allowed);
  require_range("highest_degree", highest_degree, lowest_degree, highest_degree_allowed);
}

TriangleMesh generate_grain(const GrainStatistics& statistics, std::uint64_t seed,
                            std::uint64_t index, std::uint32_t frequency) {
  statistics.validate();
  if (frequency < statistics.highest_degree) {
    fail("mesh frequency", fmt::format("{}", frequency),
         fmt::format("[highest_degree = {}, {}]", statistics.highest_degree, highest_frequency));
  }
  RandomStream form_random{seed, RandomPurpose::grain_form, index};
  RandomStream surface_random{seed, RandomPurpose::grain_surface, index};
  const Form form = draw_form(statistics, form_random);
  std::vector<HalfSpace> faces = draw_faces(form, statistics.face_irregularity, form_random);
  const std::vector<std::complex<double>> roughness = draw_roughness(statistics, surface_random);
  const SphericalHarmonicBasis basis{statistics.highest_degree};

  // Cutting and rounding change the form, so the half spaces are adjusted a few times on a coarse
  // mesh. Scaling the half spaces instead of the mesh leaves the corners round.
  constexpr std::uint32_t coarse_frequency = 8;
  constexpr int adjustments = 4;
  const RoughSphere coarse{basis, roughness, coarse_frequency};
  for (int n = 0; n < adjustments; ++n) {
    const TriangleMesh mesh = coarse.on({faces, form.roundness});
    const PrincipalFrame frame = principal_frame(solid_properties(mesh));
    faces = reshaped(faces, frame, form_factors(extents_of(to_frame(mesh, frame)), form));
  }

  // The rest is small and is made exact by scaling along the principal axes, which stay principal.
  const RoughSphere fine{basis, roughness, frequency};
  TriangleMesh grain = to_principal_frame(fine.on({faces, form.roundness}));
  const Vec3 factors = form_factors(extents_of(grain), form);
  grain = scaled(std::move(grain), factors);
  const double volume = solid_properties(grain).volume;
  const double target = std::numbers::pi / 6 * form.diameter * form.diameter * form.diameter;
  const double size = portable::cbrt(target / volume);
  return to_principal_frame(scaled(std::move(grain), {size, size, size}));
}

}  // namespace reckon
