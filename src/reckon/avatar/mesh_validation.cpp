// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "reckon/avatar/disjoint_sets.hpp"
#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/self_intersection.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr double smallest_size = 1e-9;  // [m]
constexpr double largest_size = 1e6;    // [m]
// A triangle lower than this part of the mesh's size has no area, and a volume smaller than this
// part of its cube is none: both are what rounding leaves of zero.
constexpr double flat = 1e-12;

constexpr const char* repair = "Repair the mesh in a mesh editor and write it again.";

std::string text(const Vec3& at) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", at.x, at.y, at.z);
}

class Validation {
 public:
  Validation(const TriangleMesh& mesh, const std::string& name) : mesh_{mesh}, name_{name} {}

  void run() {
    check_numbers();
    check_size();
    check_areas();
    const std::vector<HalfEdge> edges = sorted_half_edges(mesh_);
    check_edges(edges);
    check_winding(edges);
    check_parts(edges);
    check_pinches(edges);
    check_volume();
    check_self_intersection();
  }

 private:
  [[noreturn]] void fail(std::string problem, std::string reason, std::string fix) const {
    throw Error{{.place = name_,
                 .problem = std::move(problem),
                 .reason = std::move(reason),
                 .fix = std::move(fix)}};
  }

  [[nodiscard]] const Vec3& corner(std::size_t triangle, std::size_t c) const {
    return mesh_.vertices[mesh_.triangles[triangle][c]];
  }
  [[nodiscard]] std::string edge_text(const HalfEdge& edge) const {
    return fmt::format("side {} of triangle {}, near {}", int{edge.side}, edge.triangle,
                       text(0.5 * mesh_.vertices[edge.low] + 0.5 * mesh_.vertices[edge.high]));
  }

  void check_numbers() const {
    if (mesh_.triangles.empty()) fail("the mesh has no triangles", "", "Give a closed surface.");
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (is_finite(mesh_.vertices[v])) continue;
      fail(fmt::format("vertex {} has a coordinate that is not a finite number", v),
           text(mesh_.vertices[v]), "Check what wrote the mesh.");
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (v < mesh_.vertices.size()) continue;
        fail(fmt::format("triangle {} uses vertex {}, which does not exist", t, v),
             fmt::format("the mesh has {} vertices", mesh_.vertices.size()),
             "Check what wrote the mesh.");
      }
    }
  }

  void check_size() {
    const BoundingBox box = bounding_box(mesh_);
    const Vec3 extent = box.high - box.low;
    size_ = std::max({extent.x, extent.y, extent.z});
    if (size_ == 0) fail("the mesh has no size", "all vertices are " + text(box.low), repair);
    if (size_ < smallest_size || size_ > largest_size) {
      fail(fmt::format("the mesh is {:.3g} m across", size_),
           fmt::format("sizes from {:g} to {:g} m are supported", smallest_size, largest_size),
           "Check the length unit of the file.");
    }
  }

  void check_areas() const {
    std::size_t count = 0;
    std::size_t first = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_flat(mesh_, mesh_.triangles[t], size_)) continue;
      if (count++ == 0) first = t;
    }
    if (count == 0) return;
    if (count == mesh_.triangles.size()) {
      fail("no triangle has an area", fmt::format("all {} are lines or points", count), repair);
    }
    fail(fmt::format("{} of {} triangles have no area", count, mesh_.triangles.size()),
         fmt::format("the first is triangle {}, near {}", first, text(corner(first, 0))),
         "Remove degenerate faces with --repair or in a mesh editor.");
  }

  /// Calls visit(first, last) for the half edges [first, last) of each edge.
  template <class Visit>
  static void for_each_edge(const std::vector<HalfEdge>& edges, Visit&& visit) {
    for (std::size_t first = 0; first < edges.size();) {
      std::size_t last = first + 1;
      while (last < edges.size() && edges[last].same_edge(edges[first])) ++last;
      visit(first, last);
      first = last;
    }
  }

  void check_edges(const std::vector<HalfEdge>& edges) const {
    std::size_t open = 0;
    std::size_t crowded = 0;
    HalfEdge first_open;
    HalfEdge first_crowded;
    for_each_edge(edges, [&](std::size_t first, std::size_t last) {
      if (last - first == 1 && open++ == 0) first_open = edges[first];
      if (last - first > 2 && crowded++ == 0) first_crowded = edges[first];
    });
    if (open > 0) {
      fail(fmt::format("the surface is open: {} edges belong to only one triangle", open),
           "the first is " + edge_text(first_open),
           "Close the holes with --repair or in a mesh editor. If there are none to see, corners "
           "that should be one differ by rounding: --merge joins them.");
    }
    if (crowded > 0) {
      fail(
          fmt::format("the surface is not a simple one: {} edges belong to more than two triangles",
                      crowded),
          "the first is " + edge_text(first_crowded),
          "Remove inner walls and doubled faces in a mesh editor.");
    }
  }

  void check_winding(const std::vector<HalfEdge>& edges) const {
    std::size_t count = 0;
    HalfEdge first_bad;
    for_each_edge(edges, [&](std::size_t first, std::size_t) {
      if (edges[first].ascending == edges[first + 1].ascending && count++ == 0) {
        first_bad = edges[first];
      }
    });
    if (count == 0) return;
    fail(fmt::format("triangles disagree which side is out across {} edges", count),
         "the first is " + edge_text(first_bad),
         "Turn the faces with --repair, or make their orientation consistent in a mesh editor.");
  }

  void check_parts(const std::vector<HalfEdge>& edges) const {
    DisjointSets sets{mesh_.triangles.size()};
    for_each_edge(edges, [&](std::size_t first, std::size_t) {
      sets.join(edges[first].triangle, edges[first + 1].triangle);
    });
    std::size_t parts = 0;
    Vec3 other;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (sets.root(t) != t) continue;
      ++parts;
      if (t != sets.root(0)) other = corner(t, 0);
    }
    if (parts == 1) return;
    fail(fmt::format("the mesh has {} separate parts", parts),
         fmt::format("one near {}, another near {}", text(corner(0, 0)), text(other)),
         "Take each part as a grain with --parts split, or give every grain its own file. Loose "
         "fragments go with --repair; remove inner cavities.");
  }

  /// Around a vertex of a surface its triangles form one fan. Corners are joined across the edges
  /// at their vertex; more sets than vertices mean that some vertex has two fans.
  void check_pinches(const std::vector<HalfEdge>& edges) const {
    const auto corner_at = [&](std::uint32_t triangle, std::uint32_t vertex) {
      const TriangleMesh::Triangle& t = mesh_.triangles[triangle];
      return 3 * triangle + (t[0] == vertex ? 0U : t[1] == vertex ? 1U : 2U);
    };
    DisjointSets sets{3 * mesh_.triangles.size()};
    for_each_edge(edges, [&](std::size_t first, std::size_t) {
      for (const std::uint32_t v : {edges[first].low, edges[first].high}) {
        sets.join(corner_at(edges[first].triangle, v), corner_at(edges[first + 1].triangle, v));
      }
    });
    std::vector<bool> has_fan(mesh_.vertices.size(), false);
    for (std::uint32_t c = 0; c < 3 * mesh_.triangles.size(); ++c) {
      if (sets.root(c) != c) continue;
      const std::uint32_t v = mesh_.triangles[c / 3][c % 3];
      if (has_fan[v]) {
        fail(fmt::format("the surface pinches itself at vertex {}", v),
             "it touches itself in one point at " + text(mesh_.vertices[v]), repair);
      }
      has_fan[v] = true;
    }
  }

  void check_volume() const {
    const double volume = solid_properties(mesh_).volume;
    if (!(std::abs(volume) > flat * size_ * size_ * size_)) {
      fail("the surface encloses no volume", fmt::format("{:.3g} m^3", volume), repair);
    }
    if (volume < 0) {
      fail("the triangles face inward", fmt::format("the volume is {:.3g} m^3", volume),
           "Turn the faces with --repair, or flip them all in a mesh editor.");
    }
  }

  void check_self_intersection() const {
    const auto pair = first_self_intersection(mesh_);
    if (!pair) return;
    fail("the surface touches or crosses itself",
         fmt::format("first at triangles {} and {}, near {}", pair->first, pair->second,
                     text(corner(pair->first, 0))),
         repair);
  }

  const TriangleMesh& mesh_;
  const std::string& name_;
  double size_{0};  // largest extent
};

}  // namespace

bool is_flat(const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle, double extent) {
  const Vec3 a = mesh.vertices[triangle[1]] - mesh.vertices[triangle[0]];
  const Vec3 b = mesh.vertices[triangle[2]] - mesh.vertices[triangle[0]];
  const double longest = std::max({norm(a), norm(b), norm(b - a)});
  // Twice the area over the longest side is the triangle's height.
  return !(norm(cross(a, b)) > flat * extent * longest);
}

void require_closed_surface(const TriangleMesh& mesh, const std::string& name) {
  Validation{mesh, name}.run();
}

}  // namespace reckon
