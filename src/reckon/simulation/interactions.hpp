// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/boundary/membrane_contacts.hpp"
#include "reckon/boundary/wall_contacts.hpp"
#include "reckon/contact/grain_contacts.hpp"
#include "reckon/simulation/simulation_setup.hpp"
#include "reckon/simulation/simulation_state.hpp"

namespace reckon {

enum class ContactPartner { grain, wall, membrane };

/// One touching pair: an owned grain, or the ghost of a pair with an owned grain, and its partner.
struct ContactView {
  ContactPartner partner{ContactPartner::grain};
  std::uint32_t slot{0};   ///< of the grain; in a pair of grains, of the lower id
  std::uint32_t other{0};  ///< the slot of the other grain, or the number of the wall
  Vec3 force;              ///< on the grain [N]
  /// On a wall or the membrane: the sum of the nodes' forces times their levers about the centre of
  /// the grain, f (x) l [N m].
  Mat3 first_moment{Vec3{}, Vec3{}, Vec3{}};
  Vec3 membrane_place;        ///< mean place of the membrane's nodes that touch [m]
  double deepest{0};          ///< largest overlap [m]
  double elastic{0};          ///< stored [J]
  std::uint32_t touching{0};  ///< nodes
  bool bonded{false};         ///< and the bond holds
};

/// All contacts of the grains of one rank: with grains, walls and the membrane. The order of a
/// step:
///
///   compute_interior()                     while the states of ghosts are on their way
///   compute_border()                       with these states
///   load_on() for every grain, then commit()
class Interactions {
 public:
  Interactions(const SimulationSetup& setup, const SimulationState& state);

  void set_friction(double between_grains, std::span<const double> on_walls);
  /// Places the walls for one step.
  void move_walls(std::span<const WallPose> poses) { walls_.move_walls(poses); }
  /// Removes a wall with its springs, from the next rebuild on.
  void remove_wall(WallId wall) { walls_.remove(wall); }

  /// Lists all pairs anew. `frames`: the `owned` grains of this rank, then its ghosts.
  void rebuild(std::vector<Pair> pairs, std::span<const GrainFrame> frames, std::size_t owned,
               const AdaptiveSkin& skin);

  /// In a periodic cell, before compute_interior(): the cell, and its motion since the last time.
  void set_cell(const PeriodicCell& cell, const CellMotion& motion) {
    grains_.set_cell(cell, motion);
  }
  /// Pairs of owned grains. The ghosts among `frames` need only their ids.
  void compute_interior(std::span<const GrainFrame> frames, std::size_t owned, double time_step) {
    grains_.evaluate_interior(frames, time_step, owned);
  }
  /// Owned grains and walls; after compute_interior().
  void compute_walls(std::span<const GrainFrame> owned_frames, double time_step) {
    walls_.evaluate(owned_frames, grains_.displacements(), time_step);
  }
  /// Pairs of an owned grain and a ghost.
  void compute_border(std::span<const GrainFrame> frames, double time_step) {
    grains_.evaluate_border(frames, time_step);
  }
  /// Owned grains and the membrane. Returns the touches of this rank.
  [[nodiscard]] std::vector<MembraneTouch> compute_membrane(
      const Membrane& membrane, std::span<const GrainFrame> owned_frames, double time_step) {
    membrane_.evaluate(membrane, owned_frames, grains_.displacements(), time_step);
    return membrane_.touches();
  }

  /// The sum of all contacts of one owned grain: pairs in the order of the partners' ids, then
  /// walls in the order of the scene, then the membrane. Adds the losses to the ledger of the
  /// grain.
  [[nodiscard]] Load load_on(std::size_t slot, EnergyLedger& ledger) const {
    Load load = grains_.load_on(slot, ledger);
    walls_.add_load(slot, load, ledger);
    membrane_.add_load(slot, load, ledger);
    return load;
  }
  /// The springs of this step become the history of the next.
  void commit() {
    grains_.commit();
    walls_.commit();
  }
  /// Sets a bond wherever two grains touch and have none.
  void set_bonds(std::span<const GrainFrame> frames) { grains_.set_bonds(frames); }

  /// Calls visit(ContactView) for every touching pair of the last evaluation: pairs of grains,
  /// pairs with a ghost among them, then walls, then the membrane.
  template <class Visit>
  void visit_contacts(Visit&& visit) const;

  /// Elastic energy of the contacts of one wall, by slot, as of the last evaluation [J].
  template <class Visit>
  void visit_stored_on_wall(WallId wall, Visit&& visit) const;

  [[nodiscard]] GrainContacts& grains() { return grains_; }
  [[nodiscard]] WallContacts& walls() { return walls_; }
  [[nodiscard]] const GrainContacts& grains() const { return grains_; }
  [[nodiscard]] const WallContacts& walls() const { return walls_; }
  [[nodiscard]] const MembraneContacts& membrane() const { return membrane_; }

 private:
  GrainContacts grains_;
  WallContacts walls_;
  MembraneContacts membrane_;
};

template <class Visit>
void Interactions::visit_contacts(Visit&& visit) const {
  for (std::size_t p = 0; p < grains_.pairs().size(); ++p) {
    const PairForce& force = grains_.forces()[p];
    if (!force.holds()) continue;
    const Pair& pair = grains_.pairs()[p];
    visit(ContactView{.partner = ContactPartner::grain,
                      .slot = pair.slot_a,
                      .other = pair.slot_b,
                      .force = force.force_on_a,
                      .deepest = force.deepest,
                      .elastic = force.elastic,
                      .touching = force.touching,
                      .bonded = force.bonded});
  }
  for (std::size_t c = 0; c < walls_.candidates().size(); ++c) {
    const WallForce& force = walls_.forces()[c];
    if (force.touching == 0) continue;
    visit(ContactView{.partner = ContactPartner::wall,
                      .slot = walls_.candidates()[c].slot,
                      .other = walls_.candidates()[c].wall.get(),
                      .force = force.force,
                      .first_moment = force.first_moment,
                      .deepest = force.deepest,
                      .elastic = force.elastic,
                      .touching = force.touching});
  }
  for (const MembraneForce& force : membrane_.forces()) {
    if (force.touching == 0) continue;
    visit(ContactView{.partner = ContactPartner::membrane,
                      .slot = force.slot,
                      .force = force.force,
                      .first_moment = force.first_moment,
                      .membrane_place = force.place,
                      .deepest = force.deepest,
                      .elastic = force.elastic,
                      .touching = force.touching});
  }
}

template <class Visit>
void Interactions::visit_stored_on_wall(WallId wall, Visit&& visit) const {
  for (std::size_t c = 0; c < walls_.forces().size(); ++c) {
    const auto& candidate = walls_.candidates()[c];
    if (candidate.wall == wall) visit(candidate.slot, walls_.forces()[c].elastic);
  }
}

}  // namespace reckon
