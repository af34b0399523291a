// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where touching nodes lie in the grids of their slaves, eight at a time: the expressions of
// place(), LevelSetView::locate() and CellPolynomial, in their order. As in law_lanes.cpp the
// compiler turns the loop over the lanes into vectors.
#define HWY_DISABLED_TARGETS (~(HWY_AVX2 | HWY_AVX3 | HWY_NEON | HWY_EMU128 | HWY_SCALAR))
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reckon/contact/place_lanes.cpp"
#include <hwy/foreach_target.h>  // must come first

#include <hwy/highway.h>

#include "reckon/contact/node_lanes.hpp"
#include "reckon/contact/pair_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace reckon::HWY_NAMESPACE {
namespace {

/// Frames of eight grains.
struct alignas(64) LaneFrames {
  LaneVectors position, row_x, row_y, row_z, velocity, angular_velocity;
  LaneNumbers mass;

  HWY_INLINE void set(std::size_t n, const GrainFrame& frame) {
    position.set(n, frame.position);
    row_x.set(n, frame.rotation.row_x);
    row_y.set(n, frame.rotation.row_y);
    row_z.set(n, frame.rotation.row_z);
    velocity.set(n, frame.velocity);
    angular_velocity.set(n, frame.angular_velocity_world);
    mass[n] = frame.mass;
  }
  HWY_INLINE void shift(std::size_t n, const PairImage& image) {
    position.set(n, position[n] + image.shift);
    velocity.set(n, velocity[n] + image.velocity);
  }
};

HWY_INLINE void gather(std::span<const GrainFrame> frames, const PairImage* images,
                       const NodeLanes& lanes, LaneFrames& master, LaneFrames& slave) {
  for (std::size_t n = 0; n < lane_count; ++n) {
    master.set(n, frames[lanes.master[n]]);
    slave.set(n, frames[lanes.slave[n]]);
  }
  if (images == nullptr) return;
  for (std::size_t n = 0; n < lane_count; ++n) {
    const PairImage& image = images[lanes.list[n] / 2];
    if (image.is_shifted) (lanes.list[n] % 2 == 1 ? master : slave).shift(n, image);
  }
}

// Conditions as numbers, whose product is their conjunction: no branch, one choice each.
HWY_INLINE double flag(bool condition) { return condition ? 1.0 : 0.0; }
HWY_INLINE double is_within_cell(double place) { return flag(place >= 0) * flag(place < 1); }

HWY_INLINE void place_block(const NodeLanes& HWY_RESTRICT lanes,
                            const LaneFrames& HWY_RESTRICT master,
                            const LaneFrames& HWY_RESTRICT slave, LaneWork& work) {
  // Filled in here first: a local object that nothing else refers to.
  LaneTouches touches;
  LaneNumbers fits;
  for (std::size_t n = 0; n < lane_count; ++n) {
    const Mat3 master_rotation{master.row_x[n], master.row_y[n], master.row_z[n]};
    const Mat3 slave_rotation{slave.row_x[n], slave.row_y[n], slave.row_z[n]};
    const Mat3 to_slave = transpose(slave_rotation);
    const Mat3 turn = to_slave * master_rotation;
    const Vec3 offset = master.position[n] - slave.position[n];
    const Vec3 shift = to_slave * offset;
    const Vec3 place = lanes.place_body[n];
    const Vec3 point = turn * place + shift;
    const double inverse_spacing = lanes.inverse_spacing[n];
    const double x = (point.x - lanes.grid_origin.x[n]) * inverse_spacing - lanes.cell.x[n];
    const double y = (point.y - lanes.grid_origin.y[n]) * inverse_spacing - lanes.cell.y[n];
    const double z = (point.z - lanes.grid_origin.z[n]) * inverse_spacing - lanes.cell.z[n];
    const CellPolynomial cell{{lanes.polynomial[0][n], lanes.polynomial[1][n],
                               lanes.polynomial[2][n], lanes.polynomial[3][n],
                               lanes.polynomial[4][n], lanes.polynomial[5][n],
                               lanes.polynomial[6][n], lanes.polynomial[7][n]}};
    const double phi = cell.value(x, y, z);
    const Vec3 gradient_body = inverse_spacing * cell.gradient(x, y, z);
    const Vec3 lever = master_rotation * place;
    const Vec3 lever_slave = lever + offset;
    const RigidMotion master_motion{master.position[n], master.velocity[n],
                                    master.angular_velocity[n]};
    const RigidMotion slave_motion{slave.position[n], slave.velocity[n], slave.angular_velocity[n]};
    fits[n] = is_within_cell(x) * is_within_cell(y) * is_within_cell(z) * flag(phi < 0) *
              flag(squared_norm(point) < lanes.radius_squared[n]) *
              flag(squared_norm(offset) < lanes.both_radii_squared[n]);
    touches.phi[n] = phi;
    touches.area[n] = lanes.area[n];
    touches.gradient.set(n, slave_rotation * gradient_body);
    touches.lever_master.set(n, lever);
    touches.lever_slave.set(n, lever_slave);
    touches.velocity.set(n, velocity_at(master_motion, lever, slave_motion, lever_slave));
    touches.effective_mass[n] = master.mass[n] * slave.mass[n] / (master.mass[n] + slave.mass[n]);
  }
  touches.node = lanes.node;
  work.touches = touches;
  work.fits = fits;
}

__attribute__((flatten)) void place_all(std::span<const GrainFrame> frames, const PairImage* images,
                                        std::span<const NodeLanes> lanes,
                                        std::span<LaneWork> work) {
  LaneFrames master;
  LaneFrames slave;
  for (std::size_t b = 0; b < lanes.size(); ++b) {
    gather(frames, images, lanes[b], master, slave);
    place_block(lanes[b], master, slave, work[b]);
  }
}

}  // namespace

PlaceLanes place_of_target() { return place_all; }

}  // namespace reckon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reckon {

PlaceLanes place_lanes(SimdLevel level) {
  [[maybe_unused]] const SimdLevel resolved = resolve(level);
#if HWY_TARGETS & HWY_AVX2
  if (resolved == SimdLevel::avx2) return N_AVX2::place_of_target();
#endif
#if HWY_TARGETS & HWY_AVX3
  if (resolved == SimdLevel::avx512) return N_AVX3::place_of_target();
#endif
  return HWY_STATIC_DISPATCH(place_of_target)();  // what all machines of this kind have
}

}  // namespace reckon
#endif
