// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_mass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reckon/math/symmetric_eigen.hpp"

namespace reckon {
namespace {

// Components this close in size count as equally large when a direction is chosen.
constexpr double equal_components = 1e-6;

/// Sums over tetrahedra between `origin` and the triangles, relative to `origin`.
struct Moments {
  double volume{0};
  Vec3 first;         // integral of x
  Vec3 second;        // integrals of xx, yy, zz
  Vec3 second_mixed;  // integrals of yz, xz, xy
};

Moments moments_about(const Vec3& origin, const TriangleMesh& mesh) {
  Moments sum;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    const Vec3 a = mesh.vertices[triangle[0]] - origin;
    const Vec3 b = mesh.vertices[triangle[1]] - origin;
    const Vec3 c = mesh.vertices[triangle[2]] - origin;
    const Vec3 s = a + b + c;
    const double det = dot(cross(a, b), c);
    // A tetrahedron with one corner at the origin: volume det/6, integral of x_i det s_i / 24,
    // integral of x_i x_j det (a_i a_j + b_i b_j + c_i c_j + s_i s_j) / 120.
    sum.volume += det / 6;
    sum.first += (det / 24) * s;
    sum.second += (det / 120) * (hadamard(a, a) + hadamard(b, b) + hadamard(c, c) + hadamard(s, s));
    const auto mixed = [](const Vec3& v) { return Vec3{v.y * v.z, v.x * v.z, v.x * v.y}; };
    sum.second_mixed += (det / 120) * (mixed(a) + mixed(b) + mixed(c) + mixed(s));
  }
  return sum;
}

Vec3 with_direction(const Vec3& axis) {
  const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) >= (1 - equal_components) * largest) return axis[i] < 0 ? -axis : axis;
  }
  return axis;
}

/// The direction across `axis` that is nearest to an axis of the mesh's frame.
Vec3 nearest_axis_across(const Vec3& axis) {
  Vec3 best;
  for (int i = 0; i < 3; ++i) {
    Vec3 unit;
    unit[i] = 1;
    const Vec3 across = unit - dot(unit, axis) * axis;
    if (norm(across) > (1 + equal_components) * norm(best)) best = across;
  }
  return with_direction(normalized(best));
}

Mat3 axes_of(const Mat3& vectors, const Vec3& moments) {
  const double tolerance = degenerate_moments * std::abs(moments.z);
  const bool low_pair = moments.y - moments.x <= tolerance;
  const bool high_pair = moments.z - moments.y <= tolerance;
  if (low_pair && high_pair) return {};
  if (low_pair) {
    const Vec3 z = with_direction(vectors.row_z);
    const Vec3 x = nearest_axis_across(z);
    return {x, cross(z, x), z};
  }
  const Vec3 x = with_direction(vectors.row_x);
  const Vec3 y = high_pair ? nearest_axis_across(x) : with_direction(vectors.row_y);
  return {x, y, cross(x, y)};
}

}  // namespace

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    area += triangle_area(mesh, triangle);
  }
  return area;
}

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Vec3 origin = mesh.vertices[mesh.triangles.front()[0]];
  double sixfold = 0;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    sixfold += dot(cross(mesh.vertices[triangle[0]] - origin, mesh.vertices[triangle[1]] - origin),
                   mesh.vertices[triangle[2]] - origin);
  }
  return sixfold / 6;
}

SolidProperties solid_properties(const TriangleMesh& mesh) {
  SolidProperties solid;
  if (mesh.triangles.empty()) return solid;
  solid.surface_area = surface_area(mesh);
  // Second moments are taken about the centroid itself: shifting them there by the parallel axis
  // theorem would cancel digits for a mesh far from its origin.
  const Vec3 start = mesh.vertices[mesh.triangles.front()[0]];
  const Moments rough = moments_about(start, mesh);
  solid.centroid = start + rough.first / rough.volume;
  const Moments sum = moments_about(solid.centroid, mesh);
  solid.volume = sum.volume;
  solid.centroid += sum.first / sum.volume;  // what rounding left over
  solid.inertia = {{sum.second.y + sum.second.z, -sum.second_mixed.z, -sum.second_mixed.y},
                   {-sum.second_mixed.z, sum.second.x + sum.second.z, -sum.second_mixed.x},
                   {-sum.second_mixed.y, -sum.second_mixed.x, sum.second.x + sum.second.y}};
  return solid;
}

PrincipalFrame principal_frame(const SolidProperties& properties) {
  const SymmetricEigen eigen = symmetric_eigen(properties.inertia);
  return {properties.centroid, axes_of(eigen.vectors, eigen.values), eigen.values};
}

TriangleMesh to_frame(TriangleMesh mesh, const PrincipalFrame& frame) {
  for (Vec3& vertex : mesh.vertices) vertex = frame.rotation * (vertex - frame.origin_mesh);
  return mesh;
}

TriangleMesh to_principal_frame(TriangleMesh mesh) {
  const PrincipalFrame frame = principal_frame(solid_properties(mesh));
  return to_frame(std::move(mesh), frame);
}

}  // namespace reckon
