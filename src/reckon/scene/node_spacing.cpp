// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/node_spacing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace reckon {
namespace {

constexpr double coarsest = 0.25;  // spacing over thickness: a ball sinks in by 2 % of itself
constexpr double coarsest_at_edge = 0.2;  // an edge sinks into a face by half a spacing

/// How deep a ball sinks in between the nodes, over its thickness.
double unseen_by(double ratio) { return 0.4 * ratio * ratio; }

/// What matters of a shape here.
struct Grid {
  double spacing;    // between nodes [m]
  double thickness;  // of the ellipsoid with its volume and inertia, at the thinnest [m]
  double radius;     // bounding [m]
  bool is_sphere;    // and needs no nodes for its like and for planes
};

Grid grid_of(const ShapeSummary& shape, bool linear) {
  const ShapeOutline& outline = shape.outline;
  const Vec3& moments = outline.mass.inertia;
  const double sum = moments.x + moments.y + moments.z;
  const double most = std::max({moments.x, moments.y, moments.z});
  const double thinnest = std::max(0.5 * sum - most, 0.0) / outline.mass.volume;  // mean of z^2
  return {std::sqrt(shape.node_area / static_cast<double>(outline.nodes)),
          2 * std::sqrt(5 * thinnest), outline.bounding_radius,
          outline.sphere_radius > 0 && !linear};
}

/// Two shapes of which one is too coarse for the other.
struct Worst {
  std::size_t coarse{0};
  std::size_t partner{0};
  double ratio{0};  // of the one's spacing to the other's thickness

  void look(std::size_t master, std::size_t slave, const std::vector<Grid>& grids) {
    if (grids[master].is_sphere && grids[slave].is_sphere) return;
    const double found = grids[master].spacing / grids[slave].thickness;
    if (found > ratio) *this = {master, slave, found};
  }
};

/// The worst pair when nodes of one grain only are looked at: masters come first in `order`.
Worst worst_in(const std::vector<std::size_t>& order, const std::vector<Grid>& grids) {
  Worst worst;
  std::optional<std::size_t> coarsest_so_far;
  for (const std::size_t shape : order) {
    if (coarsest_so_far) worst.look(*coarsest_so_far, shape, grids);
    if (!coarsest_so_far || grids[shape].spacing > grids[*coarsest_so_far].spacing) {
      coarsest_so_far = shape;
    }
  }
  return worst;
}

/// Of a shape: its grains, and those that move.
struct Count {
  std::size_t all{0};
  std::size_t free{0};
};

/// The worst shape that is too coarse for itself, on a wall or where it meets one that is no finer.
/// With nodes of both grains: the nodes of the smaller grain find the larger one.
Worst worst_alone(const std::vector<Grid>& grids, const std::vector<Count>& counts, bool walls,
                  double allowed) {
  const auto meets_coarse = [&](std::size_t shape) {
    if (counts[shape].free > 0 && (walls || counts[shape].all > 1)) return true;
    for (std::size_t other = 0; other < grids.size(); ++other) {
      if (other == shape || counts[shape].free + counts[other].free == 0) continue;
      const double thinner = std::min(grids[shape].thickness, grids[other].thickness);
      if (counts[other].all > 0 && grids[other].spacing > allowed * thinner) return true;
    }
    return false;
  };
  Worst worst;
  for (std::size_t shape = 0; shape < grids.size(); ++shape) {
    if (counts[shape].all == 0) continue;
    Worst found = worst;
    found.look(shape, shape, grids);
    if (found.ratio > std::max(worst.ratio, allowed) && meets_coarse(shape)) worst = found;
  }
  return worst;
}

}  // namespace

std::optional<CoarseNodes> coarse_nodes(const LoadedScene& scene) {
  const ContactConfig& contact = scene.config.contact;
  std::vector<Grid> grids;
  grids.reserve(scene.shapes.size());
  for (const ShapeSummary& shape : scene.shapes) {
    grids.push_back(grid_of(shape, contact.law == ContactLawKind::linear));
  }
  std::vector<std::size_t> by_id;
  by_id.reserve(scene.grains.size());
  for (const GrainState& grain : scene.grains) by_id.push_back(grain.shape.get());
  std::vector<Count> counts(grids.size());
  for (const GrainState& grain : scene.grains) {
    Count& count = counts[grain.shape.get()];
    ++count.all;
    if (!grain.prescribed) ++count.free;
  }

  const auto nodes_for = [&](std::size_t shape, double spacing) {
    return static_cast<std::uint64_t>(
        std::ceil(scene.shapes[shape].node_area / (spacing * spacing)));
  };
  const auto say = [&](const Worst& worst, double allowed, const std::string& partner,
                       const std::string& also) {
    const double spacing = grids[worst.coarse].spacing;
    const double thickness = grids[worst.partner].thickness;
    const std::string text = fmt::format(
        "nodes of shape {} lie {:.3g} m apart, and {} is {:.3g} m thick: it can sink in between "
        "them, and no force answers. Give shape {} at least {} nodes{}.",
        scene.shapes[worst.coarse].name, spacing, partner, thickness,
        scene.shapes[worst.coarse].name, nodes_for(worst.coarse, allowed * thickness), also);
    return CoarseNodes{text, unseen_by(worst.ratio)};
  };

  if (contact.master != MasterRule::both) {
    std::vector<std::size_t> order = by_id;
    if (contact.master == MasterRule::smaller) {
      std::stable_sort(order.begin(), order.end(), [&](std::size_t s, std::size_t t) {
        return grids[s].radius < grids[t].radius;
      });
    }
    const Worst worst = worst_in(order, grids);
    if (worst.ratio > coarsest) {
      return say(worst, coarsest, "its partner, shape " + scene.shapes[worst.partner].name + ",",
                 ", or take contact.master = \"both\"");
    }
  }
  const auto& walls = scene.config.walls;
  const Worst alone = worst_alone(grids, counts, !walls.empty(), coarsest);
  if (alone.ratio > coarsest) return say(alone, coarsest, "the shape itself", "");
  const bool has_edge = std::any_of(walls.begin(), walls.end(), [](const WallConfig& wall) {
    return std::holds_alternative<LedgeConfig>(wall.geometry);
  });
  if (!has_edge) return std::nullopt;
  for (Grid& grid : grids) grid.is_sphere = false;
  const Worst at_edge = worst_alone(grids, counts, true, coarsest_at_edge);
  if (at_edge.ratio <= coarsest_at_edge) return std::nullopt;
  CoarseNodes found = say(at_edge, coarsest_at_edge, "the shape itself", "");
  found.text = "a ledge has an edge; " + found.text;
  return found;
}

}  // namespace reckon
