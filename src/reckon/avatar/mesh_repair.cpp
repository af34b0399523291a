// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_repair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "reckon/avatar/disjoint_sets.hpp"
#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/mesh_parts.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

using Triangle = TriangleMesh::Triangle;

std::size_t remove_doubled(TriangleMesh& mesh) {
  std::set<Triangle> seen;
  const std::size_t before = mesh.triangles.size();
  std::erase_if(mesh.triangles, [&](Triangle t) {
    std::sort(t.begin(), t.end());
    return !seen.insert(t).second;
  });
  return before - mesh.triangles.size();
}

void remove_fragments(TriangleMesh& mesh, MeshRepair& repair) {
  const std::vector<std::uint32_t> part = parts_of(mesh);
  std::vector<double> area(part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1, 0.0);
  double whole = 0;
  for (std::size_t t = 0; t < part.size(); ++t) {
    area[part[t]] += triangle_area(mesh, mesh.triangles[t]);
    whole += triangle_area(mesh, mesh.triangles[t]);
  }
  const double largest = area.empty() ? 0 : *std::max_element(area.begin(), area.end());
  const auto is_fragment = [&](double a) { return a < largest_fragment * largest; };
  for (const double a : area) {
    if (!is_fragment(a)) continue;
    ++repair.fragments;
    repair.fragments_area = std::max(repair.fragments_area, a / whole);
  }
  if (repair.fragments == 0) return;
  std::vector<bool> keep(part.size());
  for (std::size_t t = 0; t < part.size(); ++t) keep[t] = !is_fragment(area[part[t]]);
  mesh = submesh(mesh, keep);
}

/// Around a corner the triangles form fans, joined across edges. All fans but the one with the most
/// triangles go, again and again, since new ones may come of it.
std::size_t remove_pinches(TriangleMesh& mesh) {
  const std::size_t before = mesh.triangles.size();
  for (;;) {
    const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
    const auto corner_at = [&](std::uint32_t triangle, std::uint32_t vertex) {
      const Triangle& t = mesh.triangles[triangle];
      return 3 * triangle + (t[0] == vertex ? 0U : t[1] == vertex ? 1U : 2U);
    };
    DisjointSets fans{3 * mesh.triangles.size()};
    for (std::size_t e = 1; e < edges.size(); ++e) {
      if (!edges[e].same_edge(edges[e - 1])) continue;
      for (const std::uint32_t v : {edges[e].low, edges[e].high}) {
        fans.join(corner_at(edges[e].triangle, v), corner_at(edges[e - 1].triangle, v));
      }
    }
    std::vector<std::uint32_t> size(3 * mesh.triangles.size(), 0);
    for (std::uint32_t c = 0; c < size.size(); ++c) ++size[fans.root(c)];
    std::vector<std::uint32_t> widest(mesh.vertices.size(), 0);  // a fan's root and 1
    for (std::uint32_t c = 0; c < size.size(); ++c) {
      std::uint32_t& best = widest[mesh.triangles[c / 3][c % 3]];
      if (best == 0 || size[c] > size[best - 1]) best = fans.root(c) + 1;
    }
    std::vector<bool> keep(mesh.triangles.size(), true);
    for (std::uint32_t c = 0; c < size.size(); ++c) {
      if (widest[mesh.triangles[c / 3][c % 3]] != fans.root(c) + 1) keep[c / 3] = false;
    }
    if (std::find(keep.begin(), keep.end(), false) == keep.end()) break;
    mesh = submesh(mesh, keep);
  }
  return before - mesh.triangles.size();
}

/// Turns triangles so that neighbours agree. A surface with one side stays in disagreement.
/// Returns for each triangle whether it was turned.
std::vector<bool> agree_on_sides(TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  struct Neighbour {
    std::uint32_t triangle;
    bool disagrees;
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (!edges[e].same_edge(edges[e - 1])) continue;
    const bool disagrees = edges[e].ascending == edges[e - 1].ascending;
    neighbours[edges[e].triangle].push_back({edges[e - 1].triangle, disagrees});
    neighbours[edges[e - 1].triangle].push_back({edges[e].triangle, disagrees});
  }
  std::vector<bool> turned(mesh.triangles.size(), false);
  std::vector<bool> seen(mesh.triangles.size(), false);
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    seen[start] = true;
    open.push_back(start);
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (const Neighbour& next : neighbours[t]) {
        if (seen[next.triangle]) continue;
        seen[next.triangle] = true;
        turned[next.triangle] = turned[t] != next.disagrees;
        open.push_back(next.triangle);
      }
    }
  }
  for (std::size_t t = 0; t < turned.size(); ++t) {
    if (turned[t]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return turned;
}

/// Turns every piece that encloses a negative volume.
void face_outward(TriangleMesh& mesh, std::vector<bool>& turned) {
  const std::vector<std::uint32_t> part = parts_of(mesh);
  std::vector<double> volume(part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1,
                             0.0);
  const Vec3 origin = mesh.vertices.empty() ? Vec3{} : mesh.vertices.front();
  for (std::size_t t = 0; t < part.size(); ++t) {
    const auto corner = [&](std::size_t c) { return mesh.vertices[mesh.triangles[t][c]] - origin; };
    volume[part[t]] += dot(corner(0), cross(corner(1), corner(2))) / 6;
  }
  for (std::size_t t = 0; t < part.size(); ++t) {
    if (volume[part[t]] >= 0) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (t < turned.size()) turned[t] = !turned[t];
  }
}

/// A triangle without area lies along its longest side. It and the neighbour behind that side make
/// a triangle with a corner on its side: that corner is joined to the opposite one instead. False
/// when there is no such neighbour.
bool absorb(TriangleMesh& mesh, std::size_t flat) {
  Triangle& own = mesh.triangles[flat];
  const auto side_length = [&](std::size_t s) {
    return norm(mesh.vertices[own[(s + 1) % 3]] - mesh.vertices[own[s]]);
  };
  std::size_t side = 0;
  for (std::size_t s = 1; s < 3; ++s) {
    if (side_length(s) > side_length(side)) side = s;
  }
  const std::uint32_t from = own[side];
  const std::uint32_t to = own[(side + 1) % 3];
  const std::uint32_t middle = own[(side + 2) % 3];
  for (Triangle& behind : mesh.triangles) {
    for (std::size_t s = 0; s < 3; ++s) {
      if (behind[s] != to || behind[(s + 1) % 3] != from) continue;
      const std::uint32_t opposite = behind[(s + 2) % 3];
      if (opposite == middle) return false;
      own = {middle, from, opposite};
      behind = {opposite, to, middle};
      return true;
    }
  }
  return false;
}

std::size_t absorb_flat(TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  const Vec3 size = box.high - box.low;
  const double extent = std::max({size.x, size.y, size.z});
  std::size_t absorbed = 0;
  // Turning an edge may leave another triangle flat, which the next round takes.
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    bool found = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!is_flat(mesh, mesh.triangles[t], extent) || !absorb(mesh, t)) continue;
      ++absorbed;
      found = true;
    }
    if (!found) break;
  }
  return absorbed;
}

}  // namespace

std::vector<std::string> MeshRepair::text() const {
  std::vector<std::string> lines;
  const auto add = [&](std::size_t count, std::string line) {
    if (count > 0) lines.push_back(std::move(line));
  };
  add(corners.merged, corners.text());
  add(doubled_triangles,
      fmt::format("removed {} that were there twice", counted(doubled_triangles, "triangle")));
  add(fragments, fmt::format("removed {}, the largest with {:.2g} % of the surface",
                             counted(fragments, "loose fragment"), 100 * fragments_area));
  add(pinched_triangles, fmt::format("removed {} at corners where two sheets meet",
                                     counted(pinched_triangles, "triangle")));
  add(turned_triangles,
      fmt::format("turned {} to face outward", counted(turned_triangles, "triangle")));
  double closed = 0;
  std::size_t longest = 0;
  for (const FilledHole& hole : holes) {
    closed += hole.area;
    longest = std::max(longest, hole.edges);
  }
  add(holes.size(),
      fmt::format("closed {}, the longest of {} edges, with {:.2g} % of the surface in all",
                  counted(holes.size(), "hole"), longest, 100 * closed / surface_area));
  add(flat_triangles, fmt::format("absorbed {} without area", counted(flat_triangles, "triangle")));
  return lines;
}

MeshRepair repair_mesh(TriangleMesh& mesh, const std::string& name,
                       std::optional<double> distance) {
  MeshRepair repair;
  repair.corners = merge_corners(mesh, distance);
  mesh = std::exchange(repair.corners.mesh, {});
  repair.doubled_triangles = remove_doubled(mesh);
  remove_fragments(mesh, repair);
  mesh = with_own_corners(mesh);
  repair.pinched_triangles = remove_pinches(mesh);
  std::vector<bool> turned = agree_on_sides(mesh);
  repair.holes = fill_holes(mesh, name);
  face_outward(mesh, turned);
  repair.turned_triangles =
      static_cast<std::size_t>(std::count(turned.begin(), turned.end(), true));
  repair.flat_triangles = absorb_flat(mesh);
  repair.surface_area = surface_area(mesh);
  return repair;
}

}  // namespace reckon
