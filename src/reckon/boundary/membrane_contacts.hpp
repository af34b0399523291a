// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/boundary/membrane.hpp"
#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/displacement_bound.hpp"
#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// What a membrane does to one grain at the current step, through all its nodes in it.
struct MembraneForce {
  std::uint32_t slot{0};
  Vec3 force;          ///< on the grain [N]
  Vec3 moment;         ///< about its centre of mass [N m]
  Vec3 place;          ///< mean place of the touching nodes, weighted by their depth [m]
  double deepest{0};   ///< [m]
  double elastic{0};   ///< stored [J]
  double friction{0};  ///< lost in this step [J]
  double dashpot{0};   ///< lost in this step [J]
  /// Sum of the nodes' forces on the grain times their levers about its centre, f (x) l [N m].
  Mat3 first_moment{Vec3{}, Vec3{}, Vec3{}};
  std::uint32_t touching{0};
};

/// Contacts between the grains of one rank and a membrane, which all ranks hold. A node touches a
/// grain when it is inside its distance field (paper, Algorithm 2, with the node for a master).
class MembraneContacts {
 public:
  explicit MembraneContacts(ContactEngine engine) : engine_{engine} {}

  /// To be called when slots hold other grains than before.
  void forget() { listed_grains_.clear(); }
  /// `displacements` has followed these frames, slot by slot; the plain engine does not look at it.
  void evaluate(const Membrane& membrane, std::span<const GrainFrame> frames,
                const DisplacementBound& displacements, double time_step);
  /// Adds the force on one grain, and its losses.
  void add_load(std::size_t slot, Load& load, EnergyLedger& ledger) const;

  /// Of this rank, as of the last evaluate(); to be shared with all ranks.
  [[nodiscard]] std::vector<MembraneTouch> touches() const;
  /// By slot, only of grains that are near the membrane.
  [[nodiscard]] std::span<const MembraneForce> forces() const { return forces_; }
  [[nodiscard]] std::uint64_t lists_made() const { return lists_made_; }

 private:
  /// A grain and the nodes that may touch it before someone has moved too far.
  struct Candidate {
    std::uint32_t slot;
    std::uint32_t first;  // in nodes_
    std::uint32_t count;
  };
  struct Near {
    std::uint32_t node;
    double next_check;  // no touch before the sum of both path lengths reaches it [m]
  };
  struct alignas(64) Scratch {
    std::vector<MembraneTouch> touches;
    std::vector<Touch> found;
  };

  [[nodiscard]] bool lists_serve(const Membrane& membrane, std::span<const GrainFrame> frames);
  void make_lists(const Membrane& membrane, std::span<const GrainFrame> frames);
  void evaluate_candidate(std::size_t c, const Membrane& membrane, const GrainFrame& grain,
                          bool may_skip, double travelled, double time_step, Scratch& scratch);

  ContactEngine engine_;
  std::vector<Candidate> candidates_;
  std::vector<Near> nodes_;
  std::vector<Vec3> listed_grains_;        // where all grains were [m]
  std::vector<Vec3> listed_nodes_;         // where all nodes were [m]
  std::vector<Vec3> seen_nodes_;           // where they were at the last evaluation [m]
  std::vector<double> node_path_lengths_;  // since lists were made [m]
  std::vector<MembraneForce> forces_;
  std::vector<Scratch> scratch_;
  std::uint64_t lists_made_{0};
};

}  // namespace reckon
