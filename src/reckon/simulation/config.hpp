// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "reckon/boundary/membrane.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/boundary/wall_control.hpp"
#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/simd_level.hpp"
#include "reckon/domain/decomposition.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// Everything a scene says, as plain values in SI units, already resolved to absolute paths.
/// `scene/` fills it from TOML and checks ranges; the Python module fills the same structs.
/// Field comments give unit, default and range: the reference page is generated from the table in
/// scene/scene_schema.cpp, which repeats none of the numbers below.

/// What grains are made of.
struct MaterialConfig {
  double density{2650};  ///< [kg/m^3], > 0
  double friction{0.5};  ///< Coulomb coefficient between grains, >= 0
  /// Grains are moved as if they were this many times denser, and weigh what they weigh; >= 1.
  double density_scaling{1};

  [[nodiscard]] double inertial_density() const { return density * density_scaling; }
};

enum class ContactLawKind { linear, area, hertz };
/// How touching nodes push. See algorithms in docs/theory.
struct ContactConfig {
  ContactLawKind law{ContactLawKind::area};
  double normal_stiffness{0};  ///< linear: k_n [N/m] per node; area: k_n [N/m^3]; > 0, no default
  double shear_stiffness{0};   ///< same unit; > 0; io defaults it to 0.9 k_n
  double young_modulus{0};     ///< hertz: of the grains [Pa], > 0, no default
  double poisson_ratio{0.2};   ///< hertz: of the grains, in [0, 0.5]
  std::optional<double> restitution;  ///< in (0, 1): adds a normal dashpot; absent: none
  double viscosity{0};                ///< area: a further normal dashpot per area [N s/m^3], >= 0
  std::optional<std::uint32_t>
      node_cap;  ///< linear: pairs with more touching nodes are scaled by cap/n
  MasterRule master{MasterRule::both};
  bool allow_inside{false};  ///< grains may begin inside each other or beyond walls
};

/// Cement between grains; see contact/bond_law.hpp.
struct BondConfig {
  std::optional<double> normal_stiffness;  ///< [N/m^3], > 0; law area: the contact's by default
  std::optional<double> shear_stiffness;   ///< [N/m^3], > 0; default: 0.4 of the normal one
  double tensile_strength{0};              ///< [Pa], > 0, no default
  double shear_strength{0};                ///< [Pa], > 0, no default
  double radius_share{0.5};  ///< of the smaller grain's sphere of equal volume, in (0, 1]
};

/// Forces on every grain other than contacts.
struct BodyForceConfig {
  Vec3 gravity;                      ///< [m/s^2]
  double damping{0};                 ///< global damping xi [1/s], >= 0
  double random_acceleration{0};     ///< each component uniform in [-a, a] [m/s^2], >= 0
  std::uint64_t random_interval{1};  ///< steps between new random accelerations; >= 1
  std::string acceleration_file;     ///< one line "ax ay az" [m/s^2] per grain; empty: none
};

/// A half space; grains are kept on the side that the normal points to.
struct PlaneConfig {
  Vec3 point;   ///< [m]
  Vec3 normal;  ///< any length
};
/// Six planes that look inward, named NAME.x-, NAME.x+, NAME.y-, ... An open top leaves out z+.
struct BoxConfig {
  Vec3 low;   ///< [m]
  Vec3 high;  ///< [m]
  bool open_top{false};
};
/// An infinite cylinder that holds grains inside.
struct CylinderConfig {
  Vec3 point;        ///< on the axis [m]
  Vec3 axis;         ///< any length
  double radius{0};  ///< [m]
};

/// A solid quarter of space with one straight edge: a half of a shear box has one on each side.
struct LedgeConfig {
  Vec3 point;   ///< on the edge [m]
  Vec3 normal;  ///< out of the face beside the edge; any length
  Vec3 top;     ///< out of the other face, at right angles to it; any length
};

struct WallConfig {
  std::string name;
  std::variant<PlaneConfig, BoxConfig, CylinderConfig, LedgeConfig> geometry;
  std::optional<double> friction;          ///< default: the material's
  std::optional<double> normal_stiffness;  ///< default: the contact's
  std::optional<double> shear_stiffness;   ///< default: the contact's
  bool dashpot{true};  ///< whether the contact's restitution also damps this wall
  /// Moments use the node shortened by its depth, r (1 + d/|r|), as the authors' public code does,
  /// instead of the node itself.
  bool shortened_lever{false};
  std::optional<WallMotion> motion;
};

/// A flexible membrane that takes the place of a cylinder wall; see boundary/membrane.hpp.
struct MembraneConfig {
  std::string mould;         ///< the cylinder wall
  double spacing{0};         ///< between nodes [m], > 0, no default
  double modulus{1.5e6};     ///< Young's modulus [Pa], > 0: that of latex
  double thickness{0.3e-3};  ///< [m], > 0
  double friction{0};        ///< Coulomb coefficient with grains, >= 0
  /// Stiffness of grains on it per area [N/m^3]; law area: a tenth of the contact's by default.
  std::optional<double> normal_stiffness;
  MembraneEnds ends{MembraneEnds::sealed};
  std::optional<double> damping;  ///< of its nodes [1/s]; default: a hundredth per time step
};

/// Along which axes a periodic cell repeats itself.
enum class PeriodicAxes { xyz, xy, xz, yz, x, y, z };
/// A cell of space that repeats itself; see grains/periodic_cell.hpp.
struct CellConfig {
  BoxConfig box;
  PeriodicAxes periodic{PeriodicAxes::xyz};
};

/// Where grains leave the simulation: behind a plane, or outside a box.
struct OutflowConfig {
  std::variant<PlaneConfig, BoxConfig> geometry;
};

/// Grains drawn from a library and placed without overlap of bounding spheres, in random
/// orientations, on a jittered grid that fills the region from below.
struct FillPlacement {
  std::uint32_t count{0};
  std::variant<BoxConfig, CylinderConfig> region;  ///< cylinder: with low/high below
  double region_low{0};                            ///< cylinder only: extent along its axis [m]
  double region_high{0};                           ///< [m]
  Vec3 velocity;                                   ///< initial velocity [m/s]
};
/// Explicit grains, one each.
struct ExplicitGrain {
  std::string shape;                            ///< name in the library; empty: by order
  Vec3 position;                                ///< [m]
  std::vector<double> orientation{1, 0, 0, 0};  ///< quaternion w, x, y, z
  Vec3 velocity;                                ///< [m/s]
  Vec3 angular_velocity;                        ///< world frame [rad/s]
  bool fixed{false};                            ///< keeps its velocities whatever the forces
};
/// A table of poses, a line per grain (scene/placement_table.hpp).
struct TablePlacement {
  std::string file;
};
/// Positions and rotations in the legacy text files; shapes are taken in turn.
struct LegacyPlacement {
  std::string positions_file;
  std::string rotations_file;
};

struct GrainsConfig {
  std::string library;  ///< shape library file, or a folder of legacy morphology files
  double voxel{1};      ///< edge of a voxel, the unit of length of legacy files [m]
  std::variant<FillPlacement, std::vector<ExplicitGrain>, LegacyPlacement, TablePlacement>
      placement;
};

struct TimeConfig {
  std::optional<double> step;                      ///< [s]; absent: see choose_time_step
  double step_fraction{0.1};                       ///< in (0, 1]
  std::optional<std::uint64_t> steps;              ///< how many to run; either this or duration
  std::optional<double> duration;                  ///< [s]
  std::optional<double> stop_at_unbalanced_ratio;  ///< ends the run early when at rest
};

/// What moves planes or a cell during a stage; see WallControl and CellControl.
struct ControlConfig {
  std::string wall;  ///< a plane, a side of a box, a pair of sides, or a part of the cell
  WallTarget target{WallTarget::stress};
  double value{0};                   ///< [Pa], [1/s] or [m/s]
  double gain{0.3};                  ///< stress: of the servo, in (0, 1)
  std::optional<double> rate_limit;  ///< stress: [1/s]; io fills it in
};

/// The pressure around the membrane during a stage.
struct MembranePressureConfig {
  double pressure{0};  ///< [Pa]
  double ramp{0};      ///< how long it takes to get there from that of the stage before [s]
};

/// When a stage ends before its time: all that is given must hold at once.
struct StageGoal {
  std::optional<double> unbalanced_ratio;  ///< below
  std::optional<double> stress_error;      ///< of all servos, relative
  std::string wall;                    ///< whose strain and stress; empty: what the stage drives
  std::optional<double> strain;        ///< since the stage began
  std::optional<double> stress_above;  ///< [Pa]
  std::optional<double> stress_below;  ///< likewise [Pa]
  std::optional<double> void_ratio;    ///< not above
  std::optional<double> overlap;       ///< of every node with a grain or wall, below [m]
};

/// One stage of a test. What is absent is as for the whole scene.
struct StageConfig {
  std::string name;
  std::optional<std::uint64_t> steps;  ///< at most; either this or duration
  std::optional<double> duration;      ///< [s]
  std::optional<StageGoal> until;
  std::optional<double> friction;
  std::optional<double> wall_friction;
  std::optional<Vec3> gravity;    ///< [m/s^2]
  std::optional<double> damping;  ///< [1/s]
  std::optional<std::uint64_t> history_interval;
  std::optional<std::uint64_t> fields_interval;
  /// From the first stage on that has it, the membrane is in place.
  std::optional<MembranePressureConfig> membrane;
  bool bond{false};  ///< grains that touch when it begins are cemented
  std::vector<ControlConfig> controls;
};

struct NeighborConfig {
  double skin{0.1};  ///< as a fraction of the smallest bounding radius, > 0
  ContactEngine engine{ContactEngine::near};  ///< changes speed, never results
  SimdLevel simd{SimdLevel::automatic};       ///< changes speed, never results
};

/// How several processes share the work. Changes speed, never results.
struct ParallelConfig {
  DecompositionKind decomposition{DecompositionKind::balanced};
};

struct OutputConfig {
  std::uint64_t history_interval{100};   ///< steps; 0: never
  std::uint64_t fields_interval{0};      ///< steps between ParaView files; 0: only start and end
  bool sample{false};                    ///< stress, strain, fabric in the history
  bool contacts{true};                   ///< write contacts beside grains
  bool surfaces{false};                  ///< write true grain surfaces beside grains
  bool ranks{false};                     ///< write which rank has each grain
  std::uint64_t checkpoint_interval{0};  ///< steps; 0: only at the end
};

struct SceneConfig {
  std::string title;
  std::uint64_t seed{1};
  MaterialConfig material;
  ContactConfig contact;
  std::optional<BondConfig> bond;
  BodyForceConfig body;
  std::vector<WallConfig> walls;
  std::optional<MembraneConfig> membrane;
  std::optional<CellConfig> cell;
  std::vector<OutflowConfig> outflows;
  std::vector<GrainsConfig> grains;
  std::vector<StageConfig> stages;
  TimeConfig time;
  NeighborConfig neighbor;
  ParallelConfig parallel;
  OutputConfig output;
};

}  // namespace reckon
