// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "reckon/avatar/disjoint_sets.hpp"
#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/avatar/self_intersection.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

bool lies_in(const BoundingBox& inner, const BoundingBox& outer) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.low[axis] < outer.low[axis] || inner.high[axis] > outer.high[axis]) return false;
  }
  return true;
}

std::uint32_t count_of(const std::vector<std::uint32_t>& part) {
  return part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;
}

/// The triangles of each group as a mesh, with the vertices that they use, in order of first use.
std::vector<TriangleMesh> grouped(const TriangleMesh& mesh, const std::vector<std::uint32_t>& group,
                                  std::uint32_t count) {
  std::vector<std::uint32_t> order(group.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return group[a] < group[b]; });
  std::vector<TriangleMesh> meshes(count);
  std::vector<std::uint32_t> user(mesh.vertices.size(), none);  // the last group that used it
  std::vector<std::uint32_t> number(mesh.vertices.size());      // the vertex's number there
  for (const std::uint32_t t : order) {
    TriangleMesh& own = meshes[group[t]];
    TriangleMesh::Triangle renumbered{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangles[t][c];
      if (user[v] != group[t]) {
        user[v] = group[t];
        number[v] = static_cast<std::uint32_t>(own.vertices.size());
        own.vertices.push_back(mesh.vertices[v]);
      }
      renumbered[c] = number[v];
    }
    own.triangles.push_back(renumbered);
  }
  return meshes;
}

void append(TriangleMesh& whole, const TriangleMesh& own) {
  const auto first = static_cast<std::uint32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), own.vertices.begin(), own.vertices.end());
  for (const auto& [a, b, c] : own.triangles) {
    whole.triangles.push_back({first + a, first + b, first + c});
  }
}

/// Throws unless no part without a fault lies inside another. They do not cross.
void require_side_by_side(const std::vector<SolidPart>& parts, const std::string& name) {
  std::vector<std::optional<TriangleBvh>> trees(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].fault) trees[p].emplace(parts[p].mesh);
  }
  for (std::size_t inner = 0; inner < parts.size(); ++inner) {
    for (std::size_t outer = 0; outer < parts.size(); ++outer) {
      if (inner == outer || !trees[inner] || !trees[outer]) continue;
      if (!lies_in(trees[inner]->bounds(), trees[outer]->bounds())) continue;
      if (trees[outer]->signed_distance(parts[inner].mesh.vertices.front()) > 0) continue;
      throw Error{{.place = fmt::format("{}, part {}", name, inner + 1),
                   .problem = fmt::format("lies inside part {}", outer + 1),
                   .reason = "whether it is a cavity or a second grain cannot be known",
                   .fix = "Remove one of the two in a mesh editor."}};
    }
  }
}

/// Throws unless the parts without a fault neither touch nor cross.
void require_apart(const std::vector<SolidPart>& parts, const std::string& name) {
  TriangleMesh whole;
  std::vector<std::size_t> owner;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].fault) continue;
    append(whole, parts[p].mesh);
    owner.resize(whole.triangles.size(), p);
  }
  if (whole.triangles.empty()) return;
  const auto pair = first_self_intersection(whole);
  if (!pair) return;
  const Vec3& at = whole.vertices[whole.triangles[pair->first][0]];
  throw Error{{.place = fmt::format("{}, part {}", name, owner[pair->first] + 1),
               .problem = fmt::format("touches or crosses part {}", owner[pair->second] + 1),
               .reason = fmt::format("near ({:.6g}, {:.6g}, {:.6g}) m", at.x, at.y, at.z),
               .fix = "Move the parts apart, or join them, in a mesh editor."}};
}

}  // namespace

std::vector<std::uint32_t> parts_of(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  DisjointSets sets{mesh.triangles.size()};
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].same_edge(edges[e - 1])) sets.join(edges[e].triangle, edges[e - 1].triangle);
  }
  std::vector<std::uint32_t> part(mesh.triangles.size());
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < part.size(); ++t) {
    const std::uint32_t root = sets.root(t);  // the lowest triangle of the part
    part[t] = root == t ? count++ : part[root];
  }
  return part;
}

TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<bool>& keep) {
  std::vector<std::uint32_t> group(keep.size());
  for (std::size_t t = 0; t < keep.size(); ++t) group[t] = keep[t] ? 0 : 1;
  return std::move(grouped(mesh, group, 2).front());
}

LargestPart largest_part(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> part = parts_of(mesh);
  std::vector<TriangleMesh> parts = grouped(mesh, part, count_of(part));
  LargestPart result;
  double largest = 0;
  double sum = 0;
  for (TriangleMesh& own : parts) {
    const double volume = std::abs(enclosed_volume(own));
    sum += volume;
    if (volume < largest) continue;
    largest = volume;
    result.mesh = std::move(own);
  }
  result.others = parts.empty() ? 0 : parts.size() - 1;
  if (largest > 0) result.others_volume = (sum - largest) / largest;
  return result;
}

TriangleMesh with_own_corners(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> part = parts_of(mesh);
  TriangleMesh whole;
  for (const TriangleMesh& own : grouped(mesh, part, count_of(part))) append(whole, own);
  return whole;
}

std::vector<SolidPart> separate_solids(const TriangleMesh& mesh, const std::string& name) {
  const std::vector<std::uint32_t> part = parts_of(mesh);
  std::vector<SolidPart> parts;
  for (TriangleMesh& own : grouped(mesh, part, count_of(part))) {
    parts.push_back({std::move(own), {}});
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    try {
      require_closed_surface(parts[p].mesh,
                             parts.size() == 1 ? name : fmt::format("{}, part {}", name, p + 1));
    } catch (const Error& error) {
      parts[p].fault = error;
    }
  }
  require_apart(parts, name);
  require_side_by_side(parts, name);
  return parts;
}

}  // namespace reckon
