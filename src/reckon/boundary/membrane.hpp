// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reckon/boundary/enclosure.hpp"
#include "reckon/boundary/membrane_mesh.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/contact/area_law.hpp"
#include "reckon/core/id.hpp"
#include "reckon/grains/grains.hpp"

namespace reckon {

/// How the rings at the ends are held by the planes there.
enum class MembraneEnds {
  sealed,  ///< fixed to the plane
  sliding  ///< in the plane, but free to move within it
};

/// What a membrane is, apart from where.
struct MembraneSetup {
  WallId mould;              ///< the cylinder whose place it takes
  double spacing{0};         ///< between nodes [m]
  double bond_stiffness{0};  ///< [N/m]
  AreaLaw contact;           ///< between its nodes and grains
  double friction{0};        ///< Coulomb coefficient between it and grains
  MembraneEnds ends{MembraneEnds::sealed};
  double areal_mass{0};  ///< [kg/m^2]
  double damping{0};     ///< global damping of its nodes [1/s]
};

/// Bonds of equal-sided triangles that act like a sheet with Young's modulus times thickness `Et`
/// [N/m], and Poisson's ratio 1/3: k = sqrt(3)/2 Et [N/m].
[[nodiscard]] double membrane_bond_stiffness(double modulus_times_thickness);

/// The mass per area [kg/m^2] that lets nodes of a membrane like this oscillate `phase` radians per
/// step at most (leapfrog is stable below 2), with the stiffest of bonds, of two grains that touch
/// a node, and of the pressure.
[[nodiscard]] double membrane_areal_mass(const MembraneSetup& setup, double highest_pressure,
                                         double time_step, double phase);

struct MembraneNode {
  Vec3 position;        ///< at the step [m]
  Vec3 velocity;        ///< half a step before [m/s]
  EnergyLedger ledger;  ///< `wall_work` is that of the pressure and of what holds the ends

  friend bool operator==(const MembraneNode&, const MembraneNode&) = default;
};

/// The memory of a membrane's node that touches a grain.
struct MembraneSpring {
  std::uint32_t node{0};
  GrainId grain;
  Vec3 shear_force;        ///< on the node [N]
  Vec3 normal;             ///< unit, out of the grain
  double dashpot_push{0};  ///< along the normal [N]

  friend bool operator==(const MembraneSpring&, const MembraneSpring&) = default;
};
/// A spring and the whole force on the node.
struct MembraneTouch {
  MembraneSpring spring;
  Vec3 force;  ///< [N]
};

/// All that a checkpoint must hold of a membrane. Empty before it has taken its place.
struct MembraneState {
  CylinderPlace start;  ///< where it took its place, at rest
  WallId floor;         ///< the planes at its ends
  WallId lid;
  Vec3 floor_start;                     ///< displacements of the planes then [m]
  Vec3 lid_start;                       ///< [m]
  std::vector<MembraneNode> nodes;      ///< see MembraneMesh
  std::vector<MembraneSpring> springs;  ///< sorted by node, then grain
  double pressure_before{0};            ///< at the end of the stage before [Pa]
  double volume_at_stage_start{0};      ///< [m^3]
  double height_at_stage_start{0};      ///< [m]

  [[nodiscard]] bool in_place() const { return !nodes.empty(); }
  friend bool operator==(const MembraneState&, const MembraneState&) = default;
};

/// A flexible membrane around a sample between two planes: nodes in rings, joined by bonds that
/// pull but do not push (rubber folds), a pressure from outside at right angles to each triangle,
/// and grains that nodes may not enter. Every rank holds all of it and moves it alike.
///
/// Nodes move like grains, by leapfrog with global damping (motion/integrator.hpp). Only
/// quasi-static tests make sense, so their mass is chosen for the time step instead of from rubber.
class Membrane {
 public:
  explicit Membrane(MembraneSetup setup) : setup_{setup} {}

  /// Puts it, at rest, where the mould is between two planes.
  void take_place(const CylinderPlace& place, WallId floor, WallId lid,
                  std::span<const WallPose> poses);
  /// Goes on from a checkpoint. Throws Error when the state does not fit this membrane.
  void adopt(MembraneState state);

  [[nodiscard]] bool in_place() const { return state_.in_place(); }
  [[nodiscard]] const MembraneSetup& setup() const { return setup_; }
  [[nodiscard]] const MembraneMesh& mesh() const { return mesh_; }
  [[nodiscard]] const MembraneState& state() const { return state_; }
  [[nodiscard]] std::span<const MembraneNode> nodes() const { return state_.nodes; }
  /// Last step's springs of one node, by grain.
  [[nodiscard]] std::span<const MembraneSpring> springs_of(std::uint32_t node) const;

  /// Takes the end rings along with the planes. To be called before evaluate().
  void follow(std::span<const WallPose> poses);
  /// Forces on all nodes; `touches` are those of all ranks, in any order.
  void evaluate(std::vector<MembraneTouch> touches, double pressure);
  /// Moves all nodes on by one step, and keeps the springs of the last evaluation.
  void advance(double time_step);
  /// A stage begins at the current step, after one whose pressure ended at this.
  void begin_stage(double pressure_before);

  // As of the last evaluate().
  [[nodiscard]] std::span<const MembraneTouch> touches() const { return touches_; }
  [[nodiscard]] bool is_touched(std::uint32_t node) const {
    return first_touch_[node + 1] > first_touch_[node];
  }
  [[nodiscard]] double pressure() const { return pressure_; }  ///< [Pa]
  [[nodiscard]] Vec3 force_on(std::uint32_t node) const { return forces_[node].total; }
  /// The space between it and its planes: its exact volume and height, and the box around the
  /// cylinder of that volume and height. The planes' areas are volume over height.
  [[nodiscard]] Enclosure enclosure(std::size_t wall_count) const;
  [[nodiscard]] Enclosure enclosure_at_stage_start(std::size_t wall_count) const;
  /// At the step, with velocities as the mean of both half steps [J].
  [[nodiscard]] double kinetic_energy(std::uint32_t node, double time_step) const;
  /// Stored in its bonds; each bond shared by its two nodes [J].
  [[nodiscard]] double bond_energy(std::uint32_t node) const { return forces_[node].stored; }
  /// Lost up to this step.
  [[nodiscard]] EnergyLedger ledger(std::uint32_t node) const;
  [[nodiscard]] bool is_finite() const;

 private:
  struct NodeLoad {
    Vec3 total;        // [N]
    Vec3 pressure;     // of it [N]
    double stored{0};  // in bonds [J]
    double let_go{0};  // by springs that ended at this step [J]
    double volume{0};  // its share [m^3]
  };
  struct Held {
    Vec3 velocity;        // of the plane [m/s]
    bool within_plane{};  // free to move there
  };
  [[nodiscard]] std::optional<Held> held(std::uint32_t node) const;
  [[nodiscard]] Vec3 velocity_after(std::uint32_t node, double time_step) const;
  [[nodiscard]] double mass(std::uint32_t node) const {
    return setup_.areal_mass * mesh_.area(node);
  }
  [[nodiscard]] Vec3 foot() const;
  [[nodiscard]] double height() const;
  void add_sheet(std::uint32_t node, NodeLoad& sum) const;
  void add_contacts(std::uint32_t node, NodeLoad& sum) const;
  [[nodiscard]] Enclosure enclosure_of(double volume, double height, const Vec3& foot,
                                       std::size_t wall_count) const;

  MembraneSetup setup_;
  MembraneMesh mesh_;
  MembraneState state_;
  std::vector<std::uint32_t> first_spring_;  // per node, and one past the end
  WallPose floor_pose_;
  WallPose lid_pose_;

  std::vector<MembraneTouch> touches_;      // by node, then grain
  std::vector<std::uint32_t> first_touch_;  // per node, and one past the end
  std::vector<NodeLoad> forces_;
  double pressure_{0};
  double volume_{0};
};

}  // namespace reckon
