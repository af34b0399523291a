// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The near engine: touching nodes in lanes, the nodes near them in lists.
#include <algorithm>
#include <bit>
#include <optional>
#include <variant>

#include "reckon/contact/grain_contacts.hpp"
#include "reckon/contact/grain_pair.hpp"
#include "reckon/contact/near_skin.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {

/// The steps of run(), for the pairs of one chunk:
///
///   place     all nodes that touched before, eight at a time, in the grids of their slaves
///   retest    those that left their cell or let go; the latter go back to the near lists
///   search    the near lists in which a node may have begun to touch; it gets a lane
///   share     what all nodes of a pair have in common
///   law       at all nodes, eight at a time
///   sum       node by node to pairs, in node order
class GrainContacts::ChunkStep {
 public:
  ChunkStep(GrainContacts& contacts, LaneChunk& chunk, std::span<const GrainFrame> frames,
            double time_step, bool use_near_lists)
      : all_{contacts},
        chunk_{chunk},
        frames_{frames},
        time_step_{time_step},
        use_near_lists_{use_near_lists},
        scratch_{contacts.scratch()} {}

  template <ContactLaw Law>
  void run(const Law& law) {
    all_.lanes_.begin(chunk_);
    place();
    retest();
    if (chunk_.has_spheres) meet_active_spheres();
    if (use_near_lists_) {
      search_near_lists();
    } else {
      search_all_nodes();
    }
    share();
    all_.law_of_nodes_(all_.settings_.law, all_.settings_.friction, time_step_, now(), chunk_.lanes,
                       scratch_.work);
    sum(law);
  }

 private:
  using Slot = SlotLists::Slot;
  static constexpr Slot none = SlotLists::none;

  /// Both grains of a pair; b as a meets it.
  struct Grains {
    const GrainFrame& a;
    std::optional<GrainFrame> image;
    const GrainFrame& b;

    Grains(GrainContacts& all, std::size_t p, std::span<const GrainFrame> frames)
        : a{frames[all.pairs_[p].slot_a]}, b{all.image_of_b(p, frames, image)} {}
    [[nodiscard]] const GrainFrame& master(bool is_b) const { return is_b ? b : a; }
    [[nodiscard]] const GrainFrame& slave(bool is_b) const { return is_b ? a : b; }
    [[nodiscard]] double both_radii() const {
      return a.shape->bounding_radius + b.shape->bounding_radius;
    }
  };

  [[nodiscard]] std::size_t now() const { return all_.lanes_.now(); }
  [[nodiscard]] double path_length(std::size_t p) const {
    const std::span<const double> travelled = all_.displacements_.path_lengths();
    return travelled[all_.pairs_[p].slot_a] + travelled[all_.pairs_[p].slot_b];
  }
  [[nodiscard]] bool has_nodes(std::size_t p) const {
    const std::size_t list = 2 * (p - chunk_.first);
    return chunk_.lists.first(list) != none || chunk_.lists.first(list + 1) != none;
  }
  [[nodiscard]] bool touches(Slot slot) const {
    return (scratch_.touching[slot / lane_count] >> slot % lane_count & 1) != 0;
  }

  void place() {
    const PairImage* images = nullptr;
    if (all_.cell_) {
      scratch_.images.resize(chunk_.count);
      for (const std::uint32_t k : chunk_.active) scratch_.images[k] = image_of(chunk_.first + k);
      images = scratch_.images.data();
    }
    scratch_.work.resize(chunk_.lanes.size());
    scratch_.touching.resize(chunk_.lanes.size());
    all_.place_(frames_, images, chunk_.lanes, scratch_.work);
    for (std::size_t b = 0; b < chunk_.lanes.size(); ++b) {
      std::uint32_t fit = 0;
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        fit |= scratch_.work[b].fits[lane] != 0 ? 1U << lane : 0U;
      }
      scratch_.touching[b] = fit & chunk_.lists.used(b);
      scratch_.counters.tested_nodes +=
          static_cast<std::uint64_t>(std::popcount(scratch_.touching[b]));
    }
  }

  PairImage image_of(std::size_t p) {
    std::optional<GrainFrame> image;
    all_.image_of_b(p, frames_, image);
    if (!image) return {};
    return {true, all_.cell_->shift_of(all_.images_[p]), all_.cell_->velocity_of(all_.images_[p])};
  }

  void retest() {
    for (std::size_t b = 0; b < chunk_.lanes.size(); ++b) {
      std::uint32_t others = chunk_.lists.used(b) & ~scratch_.touching[b];
      for (; others != 0; others &= others - 1) {
        retest(static_cast<Slot>(b * lane_count) + static_cast<Slot>(std::countr_zero(others)));
      }
    }
  }

  void retest(Slot slot) {
    const std::size_t list = chunk_.lanes[slot / lane_count].list[slot % lane_count];
    const std::size_t p = chunk_.first + list / 2;
    const bool b_is_master = list % 2 == 1;
    const Grains grains{all_, p, frames_};
    if (are_spheres(grains.a, grains.b)) {
      chunk_.has_spheres = true;
      return;
    }
    const GrainFrame& master = grains.master(b_is_master);
    const GrainFrame& slave = grains.slave(b_is_master);
    const double margin = rounding_margin(grains.both_radii(), path_length(p));
    NearNode node = node_in(slot, *master.shape);
    double clearance = 0;
    const Vec3 offset = master.position - slave.position;
    if (!spheres_meet(offset, grains.both_radii())) {
      clearance = std::max(norm(offset) - grains.both_radii() - margin, 0.0);
    } else {
      Touch touch;
      clearance =
          NodeTest{master, slave, margin}(NodeTarget{*slave.shape}, node, touch, scratch_.counters);
      if (clearance == check_always) {
        set_node(slot, node, slave, grains.both_radii());
        set_touch(slot, touch, master, slave);
        return;
      }
    }
    chunk_.leaving.push_back(slot);
    const double next_check = path_length(p) + clearance;
    (b_is_master ? all_.near_[p].of_b : all_.near_[p].of_a).take_back(node, next_check);
    all_.next_check_[p] = std::min(all_.next_check_[p], next_check);
  }

  /// What the slot knows of its node.
  [[nodiscard]] NearNode node_in(Slot slot, const ShapeView& master) const {
    const NodeLanes& lanes = chunk_.lanes[slot / lane_count];
    const std::size_t lane = slot % lane_count;
    NearNode node{.node = lanes.node[lane]};
    if (!(lanes.cell.x[lane] >= 0)) {
      node.place_body = master.nodes.position(node.node);
      node.area = master.nodes.area[node.node];
      return node;
    }
    node.place_body = lanes.place_body[lane];
    node.area = lanes.area[lane];
    for (std::size_t c = 0; c < node.cell.c.size(); ++c) node.cell.c[c] = lanes.polynomial[c][lane];
    node.i = static_cast<std::int32_t>(lanes.cell.x[lane]);
    node.j = static_cast<std::int32_t>(lanes.cell.y[lane]);
    node.k = static_cast<std::int32_t>(lanes.cell.z[lane]);
    return node;
  }

  void set_node(Slot slot, const NearNode& node, const GrainFrame& slave, double both_radii) {
    NodeLanes& lanes = chunk_.lanes[slot / lane_count];
    const std::size_t lane = slot % lane_count;
    const ShapeView& shape = *slave.shape;
    lanes.place_body.set(lane, node.place_body);
    lanes.area[lane] = node.area;
    for (std::size_t c = 0; c < node.cell.c.size(); ++c) lanes.polynomial[c][lane] = node.cell.c[c];
    lanes.cell.set(lane, {static_cast<double>(node.i), static_cast<double>(node.j),
                          static_cast<double>(node.k)});
    lanes.grid_origin.set(lane, shape.level_set.origin_body);
    lanes.inverse_spacing[lane] = shape.level_set.inverse_spacing;
    lanes.radius_squared[lane] = shape.bounding_radius * shape.bounding_radius;
    lanes.both_radii_squared[lane] = both_radii * both_radii;
  }

  /// What place() computes for a node that fits.
  void set_touch(Slot slot, const Touch& touch, const GrainFrame& master, const GrainFrame& slave) {
    LaneTouches& touches = scratch_.work[slot / lane_count].touches;
    const std::size_t lane = slot % lane_count;
    const Vec3 lever_slave = touch.lever_world + (master.position - slave.position);
    touches.phi[lane] = touch.phi;
    touches.area[lane] = touch.area;
    touches.gradient.set(lane, touch.gradient_world);
    touches.lever_master.set(lane, touch.lever_world);
    touches.lever_slave.set(lane, lever_slave);
    touches.velocity.set(
        lane, velocity_at(motion_of(master), touch.lever_world, motion_of(slave), lever_slave));
    touches.effective_mass[lane] = master.mass * slave.mass / (master.mass + slave.mass);
    touches.node[lane] = touch.node;
    scratch_.touching[slot / lane_count] |= 1U << lane;
  }

  /// The slot of a node that touches, old or new.
  Slot slot_of(std::size_t p, bool b_is_master, NodeIndex node) {
    const std::size_t k = p - chunk_.first;
    const std::size_t list = 2 * k + (b_is_master ? 1 : 0);
    if (const Slot slot = chunk_.lists.find(list, node); slot != none) return slot;
    const Slot slot = chunk_.insert(list, node, all_.pairs_[p]);
    scratch_.work.resize(chunk_.lanes.size());
    scratch_.touching.resize(chunk_.lanes.size(), 0);
    chunk_.activate(static_cast<std::uint32_t>(k));
    return slot;
  }

  void meet_active_spheres() {
    chunk_.has_spheres = false;
    for (const std::uint32_t k : chunk_.active) {
      const std::size_t p = chunk_.first + k;
      if (!has_nodes(p)) continue;
      const Grains grains{all_, p, frames_};
      if (!are_spheres(grains.a, grains.b)) continue;
      chunk_.has_spheres = true;
      meet_spheres(p, grains);
    }
  }

  void meet_spheres(std::size_t p, const Grains& grains) {
    const double reading = path_length(p);
    for_each_master(all_.settings_.master, grains.a, grains.b, [&](bool is_b, double) {
      const GrainFrame& master = grains.master(is_b);
      const GrainFrame& slave = grains.slave(is_b);
      scratch_.touches.clear();
      const double gap = touch_spheres(master, slave, scratch_.touches);
      for (const Touch& touch : scratch_.touches) {
        set_touch(slot_of(p, is_b, touch.node), touch, master, slave);
      }
      chunk_.has_spheres |= !scratch_.touches.empty();
      const std::size_t list = 2 * (p - chunk_.first) + (is_b ? 1 : 0);
      for (Slot slot = chunk_.lists.first(list); slot != none; slot = chunk_.lists.next(slot)) {
        if (!touches(slot)) chunk_.leaving.push_back(slot);
      }
      const double margin = rounding_margin(grains.both_radii(), reading);
      const double next_check = !use_near_lists_ || (scratch_.touches.empty() && gap < 0)
                                    ? check_always
                                : !scratch_.touches.empty() ? check_never
                                                            : reading + std::max(gap - margin, 0.0);
      all_.next_check_[p] = std::min(next_check, next_check_of_images(reading, grains));
    });
  }

  /// Soon enough for the images that are not nearest.
  [[nodiscard]] double next_check_of_images(double reading, const Grains& grains) const {
    return all_.cell_ ? reading + (all_.image_distance_ - grains.both_radii()) : check_never;
  }

  void search_near_lists() {
    scratch_.due.clear();
    for (std::size_t p = chunk_.first; p < chunk_.first + chunk_.count; ++p) {
      if (!(path_length(p) < all_.next_check_[p]))
        scratch_.due.push_back(static_cast<std::uint32_t>(p));
    }
    // Lists and frames of pairs that move are rarely in the cache.
    constexpr std::size_t ahead = 4;
    const auto for_lists = [&](std::size_t n, auto&& ask) {
      if (n >= scratch_.due.size()) return;
      const std::uint32_t p = scratch_.due[n];
      ask(p, all_.near_[p].of_a);
      ask(p, all_.near_[p].of_b);
    };
    const auto ask_for_head = [&](std::uint32_t p, const NearList& list) {
      list.prefetch();
      prefetch_frame(frames_[all_.pairs_[p].slot_b]);
    };
    const auto ask_for_next_checks = [&](std::uint32_t p, const NearList& list) {
      list.prefetch_next_checks(path_length(p));
    };
    for (std::size_t n = 0; n < ahead; ++n) for_lists(n, ask_for_head);
    for (std::size_t n = 0; n < scratch_.due.size(); ++n) {
      for_lists(n + ahead, ask_for_head);
      for_lists(n + ahead / 2, ask_for_next_checks);
      search_near_lists(scratch_.due[n]);
    }
  }

  void search_near_lists(std::size_t p) {
    const Grains grains{all_, p, frames_};
    if (!has_nodes(p)) ++scratch_.counters.due;
    if (are_spheres(grains.a, grains.b)) {
      if (!has_nodes(p)) meet_spheres(p, grains);
      return;
    }
    const double reading = path_length(p);
    double next_check = next_check_of_images(reading, grains);
    for_each_master(all_.settings_.master, grains.a, grains.b, [&](bool is_b, double) {
      const GrainFrame& master = grains.master(is_b);
      const GrainFrame& slave = grains.slave(is_b);
      const std::size_t list = 2 * (p - chunk_.first) + (is_b ? 1 : 0);
      scratch_.nodes.clear();
      for (Slot slot = chunk_.lists.first(list); slot != none; slot = chunk_.lists.next(slot)) {
        if (touches(slot)) scratch_.nodes.push_back(chunk_.lists.key(slot));
      }
      scratch_.found.clear();
      NearList& near = is_b ? all_.near_[p].of_b : all_.near_[p].of_a;
      next_check = std::min(next_check,
                            near.find_touches(master, slave, reading, all_.filter_, scratch_.nodes,
                                              scratch_.found, scratch_.counters));
      for (const NearList::Found& found : scratch_.found) {
        const Slot slot = slot_of(p, is_b, found.node.node);
        set_node(slot, found.node, slave, grains.both_radii());
        set_touch(slot, found.touch, master, slave);
      }
    });
    all_.next_check_[p] = next_check;
  }

  /// Where the frames do not tell how far grains travel.
  void search_all_nodes() {
    for (std::size_t p = chunk_.first; p < chunk_.first + chunk_.count; ++p) {
      const Grains grains{all_, p, frames_};
      if (!has_nodes(p)) ++scratch_.counters.due;
      if (are_spheres(grains.a, grains.b)) {
        if (!has_nodes(p)) meet_spheres(p, grains);
        continue;
      }
      for_each_master(all_.settings_.master, grains.a, grains.b, [&](bool is_b, double) {
        const GrainFrame& master = grains.master(is_b);
        const GrainFrame& slave = grains.slave(is_b);
        scratch_.touches.clear();
        find_touches(master, slave, scratch_.touches);
        for (const Touch& touch : scratch_.touches) {
          set_touch(slot_of(p, is_b, touch.node), touch, master, slave);
        }
      });
    }
  }

  void share() {
    scratch_.contexts.clear();
    for (const std::uint32_t k : chunk_.active) {
      const Pair& pair = all_.pairs_[chunk_.first + k];
      const GrainFrame& a = frames_[pair.slot_a];
      const GrainFrame& b = frames_[pair.slot_b];
      for_each_master(all_.settings_.master, a, b, [&](bool is_b, double) {
        const Slot first = chunk_.lists.first(2 * k + (is_b ? 1 : 0));
        PairContext context = all_.context_of(a, b, time_step_);
        for (Slot slot = first; slot != none; slot = chunk_.lists.next(slot)) {
          if (!touches(slot)) continue;
          const LaneTouches& touches = scratch_.work[slot / lane_count].touches;
          count_touch(context, touches.area[slot % lane_count], touches.phi[slot % lane_count]);
        }
        for (Slot slot = first; slot != none; slot = chunk_.lists.next(slot)) {
          LaneTouches& touches = scratch_.work[slot / lane_count].touches;
          const std::size_t lane = slot % lane_count;
          touches.total_area[lane] = context.total_area;
          touches.total_volume[lane] = context.total_volume;
          touches.third_moment[lane] = context.third_moment;
          touches.fourth_moment[lane] = context.fourth_moment;
          touches.touching[lane] = context.touching;
        }
        scratch_.contexts.push_back(context);
      });
    }
  }

  template <ContactLaw Law>
  void sum(const Law& law) {
    auto context = scratch_.contexts.begin();
    std::size_t kept = 0;
    for (const std::uint32_t k : chunk_.active) {
      const std::size_t p = chunk_.first + k;
      const GrainFrame& a = frames_[all_.pairs_[p].slot_a];
      const GrainFrame& b = frames_[all_.pairs_[p].slot_b];
      PairForce pair;
      for_each_master(all_.settings_.master, a, b, [&](bool is_b, double weight) {
        add_directed(pair, sum(law, 2 * k + (is_b ? 1 : 0), *context++, weight), is_b);
      });
      all_.forces_[p] = pair;
      all_.finish(p, frames_, scratch_.counters);
      if (has_nodes(p) || all_.bond_of_pair_[p] != no_bond) chunk_.active[kept++] = k;
    }
    chunk_.active.resize(kept);
  }

  /// What the nodes of one list do together: what pair_force() returns.
  template <ContactLaw Law>
  DirectedForce sum(const Law& law, std::size_t list, const PairContext& context, double weight) {
    DirectedForce sum;
    for (Slot slot = chunk_.lists.first(list); slot != none; slot = chunk_.lists.next(slot)) {
      const LaneSprings& before = chunk_.lanes[slot / lane_count].springs[1 - now()];
      LaneSprings& after = chunk_.lanes[slot / lane_count].springs[now()];
      const LaneTouches& node = scratch_.work[slot / lane_count].touches;
      const LaneResponses& responses = scratch_.work[slot / lane_count].responses;
      const std::size_t lane = slot % lane_count;
      if (!touches(slot) || !(responses.steepness[lane] > 0)) {
        sum.friction += before.spring(lane).stored();
        after.set(lane, {});
        continue;
      }
      sum.force += responses.force[lane];
      sum.moment_master += responses.moment_master[lane];
      sum.moment_slave -= responses.moment_slave[lane];
      sum.deepest = std::max(sum.deepest, -node.phi[lane]);
      sum.elastic += responses.elastic[lane];
      sum.friction += responses.friction[lane];
      sum.dashpot += responses.dashpot[lane];
      ++sum.touching;
    }
    scale(sum, weight * law.pair_scale(context));
    sum.stiffness = weight * law.pair_stiffness(context);
    sum.damping = weight * law.pair_damping(context);
    return sum;
  }

  GrainContacts& all_;
  LaneChunk& chunk_;
  std::span<const GrainFrame> frames_;
  double time_step_;
  bool use_near_lists_;
  Scratch& scratch_;
};

void GrainContacts::evaluate_near(std::span<const GrainFrame> frames, double time_step,
                                  bool with_ghosts, bool use_near_lists) {
  const std::size_t first = with_ghosts ? lanes_.interior_chunk_count() : 0;
  const std::size_t last = with_ghosts ? lanes_.chunk_count() : lanes_.interior_chunk_count();
  std::visit(
      [&](const auto& law) {
        parallel_for(last - first, 1, [&](std::size_t n) {
          ChunkStep{*this, lanes_.chunk(first + n), frames, time_step, use_near_lists}.run(law);
        });
      },
      settings_.law);
}

}  // namespace reckon
