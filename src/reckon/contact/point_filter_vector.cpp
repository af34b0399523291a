// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The vector variants of PointFilter: Highway compiles this file once for each set of instructions.
#define HWY_DISABLED_TARGETS (~(HWY_AVX2 | HWY_AVX3 | HWY_NEON | HWY_EMU128 | HWY_SCALAR))
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reckon/contact/point_filter_vector.cpp"
#include <hwy/foreach_target.h>  // must come first

#include <hwy/highway.h>

#include <algorithm>
#include <array>

#include "reckon/contact/point_filter.hpp"

HWY_BEFORE_NAMESPACE();
namespace reckon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t block = 16;  // points that are handled together: a cluster

using Floats = hn::CappedTag<float, block>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVector = hn::Vec<Floats>;
using IntVector = hn::Vec<Ints>;

/// One array per coordinate, of points or of corners.
template <std::size_t count>
struct alignas(64) Lanes {
  std::array<std::array<float, block>, count> of;
};

HWY_INLINE FloatVector between(FloatVector low, FloatVector high, FloatVector part) {
  return hn::Add(low, hn::Mul(part, hn::Sub(high, low)));
}

HWY_INLINE FloatVector squared_norm(FloatVector x, FloatVector y, FloatVector z) {
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

/// The corners of cells. Plain loads: they beat the gathers of today's machines.
HWY_INLINE void gather_from_grid(const FilterTarget& t, IntVector i, IntVector j, IntVector k,
                                 Lanes<8>& corner) {
  const Ints di;
  alignas(64) std::array<std::int32_t, block> first{};
  hn::Store(hn::Add(hn::Add(i, hn::Mul(j, hn::Set(di, t.row))), hn::Mul(k, hn::Set(di, t.layer))),
            di, first.data());
  for (std::size_t lane = 0; lane < hn::Lanes(di); ++lane) {
    const float* const v = t.values + first[lane];
    const float* const w = v + t.layer;
    corner.of[0][lane] = v[0];
    corner.of[1][lane] = v[1];
    corner.of[2][lane] = v[t.row];
    corner.of[3][lane] = v[t.row + 1];
    corner.of[4][lane] = w[0];
    corner.of[5][lane] = w[1];
    corner.of[6][lane] = w[t.row];
    corner.of[7][lane] = w[t.row + 1];
  }
}

void gather_from_band(const FilterTarget& t, IntVector i, IntVector j, IntVector k,
                      Lanes<8>& corner) {
  const Ints di;
  alignas(64) std::array<std::array<std::int32_t, block>, 3> cell{};
  hn::Store(i, di, cell[0].data());
  hn::Store(j, di, cell[1].data());
  hn::Store(k, di, cell[2].data());
  for (std::size_t lane = 0; lane < hn::Lanes(di); ++lane) {
    const auto phi = t.band->corners(cell[0][lane], cell[1][lane], cell[2][lane]);
    for (std::size_t c = 0; c < 8; ++c) corner.of[c][lane] = phi[c];
  }
}

/// phi at points of the grid.
HWY_INLINE FloatVector phi_at(const FilterTarget& t, FloatVector x, FloatVector y, FloatVector z) {
  const Floats d;
  const Ints di;
  const auto cell_of = [&](FloatVector g, std::size_t axis) HWY_ATTR {
    return hn::Min(hn::ConvertTo(di, g), hn::Set(di, t.last_cell[axis]));
  };
  const IntVector i = cell_of(x, 0);
  const IntVector j = cell_of(y, 1);
  const IntVector k = cell_of(z, 2);
  Lanes<8> corner;
  if (t.band != nullptr) {
    gather_from_band(t, i, j, k, corner);
  } else {
    gather_from_grid(t, i, j, k, corner);
  }
  const auto along_x = [&](std::size_t c, FloatVector part) HWY_ATTR {
    return between(hn::Load(d, corner.of[c].data()), hn::Load(d, corner.of[c + 1].data()), part);
  };
  const FloatVector px = hn::Sub(x, hn::ConvertTo(d, i));
  const FloatVector py = hn::Sub(y, hn::ConvertTo(d, j));
  const FloatVector pz = hn::Sub(z, hn::ConvertTo(d, k));
  return between(between(along_x(0, px), along_x(2, px), py),
                 between(along_x(4, px), along_x(6, px), py), pz);
}

/// clearance_of for one vector of points.
HWY_INLINE FloatVector clearances_of(const FilterTarget& t, FloatVector x, FloatVector y,
                                     FloatVector z, FloatVector r) {
  const Floats d;
  const FloatVector zero = hn::Zero(d);
  const auto coordinate = [&](std::size_t i) HWY_ATTR {
    return hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(d, t.turn[3 * i]), x),
                                   hn::Mul(hn::Set(d, t.turn[3 * i + 1]), y)),
                           hn::Mul(hn::Set(d, t.turn[3 * i + 2]), z)),
                   hn::Set(d, t.shift[i]));
  };
  const FloatVector gx = coordinate(0);
  const FloatVector gy = coordinate(1);
  const FloatVector gz = coordinate(2);
  const FloatVector center_distance = hn::Sqrt(squared_norm(hn::Sub(gx, hn::Set(d, t.center[0])),
                                                            hn::Sub(gy, hn::Set(d, t.center[1])),
                                                            hn::Sub(gz, hn::Set(d, t.center[2]))));
  const FloatVector from_sphere = hn::Sub(hn::Sub(center_distance, hn::Set(d, t.radius)), r);
  const auto near = hn::Le(from_sphere, hn::Set(d, t.skin));
  if (hn::AllFalse(d, near)) return from_sphere;

  // The others stay within the grid so that they can be looked up without harm.
  const auto inside_of = [&](FloatVector g, std::size_t axis) HWY_ATTR {
    return hn::IfThenElseZero(near, hn::Min(hn::Max(g, zero), hn::Set(d, t.high[axis])));
  };
  const FloatVector ix = inside_of(gx, 0);
  const FloatVector iy = inside_of(gy, 1);
  const FloatVector iz = inside_of(gz, 2);
  const FloatVector outside = squared_norm(hn::Sub(gx, ix), hn::Sub(gy, iy), hn::Sub(gz, iz));
  const FloatVector from_phi = hn::Mul(phi_at(t, ix, iy, iz), hn::Set(d, t.phi_to_clearance));
  const FloatVector positive = hn::Max(from_phi, zero);
  const FloatVector from_grid = hn::IfThenElse(
      hn::Gt(outside, zero), hn::Sqrt(hn::Add(outside, hn::Mul(positive, positive))), from_phi);
  return hn::IfThenElse(near, hn::Max(from_sphere, hn::Sub(from_grid, r)), from_sphere);
}

void filter(const FilterTarget& target, const FilterPoints& points, float* clearance) {
  const Floats d;
  Lanes<4> point{};
  alignas(64) std::array<float, block> found{};
  for (std::size_t first = 0; first < points.count; first += block) {
    const std::size_t count = std::min(block, points.count - first);
    // What a shorter last block leaves beyond its end is of the block before: harmless.
    std::copy_n(points.x + first, count, point.of[0].begin());
    std::copy_n(points.y + first, count, point.of[1].begin());
    std::copy_n(points.z + first, count, point.of[2].begin());
    if (points.radius != nullptr) std::copy_n(points.radius + first, count, point.of[3].begin());
    for (std::size_t n = 0; n < count; n += hn::Lanes(d)) {
      const auto load = [&](std::size_t c) HWY_ATTR { return hn::Load(d, point.of[c].data() + n); };
      hn::Store(clearances_of(target, load(0), load(1), load(2), load(3)), d, found.data() + n);
    }
    std::copy_n(found.begin(), count, clearance + first);
  }
}

}  // namespace

PointFilter filter_of_target() { return filter; }

}  // namespace reckon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reckon {

PointFilter vector_point_filter([[maybe_unused]] SimdLevel level) {
  [[maybe_unused]] const auto runs = [](std::int64_t target) {
    return (hwy::SupportedTargets() & target) != 0;
  };
#if HWY_TARGETS & HWY_AVX2
  if (level == SimdLevel::avx2 && runs(HWY_AVX2)) return N_AVX2::filter_of_target();
#endif
#if HWY_TARGETS & HWY_AVX3
  if (level == SimdLevel::avx512 && runs(HWY_AVX3)) return N_AVX3::filter_of_target();
#endif
#if HWY_TARGETS & HWY_NEON
  if (level == SimdLevel::neon && runs(HWY_NEON)) return N_NEON::filter_of_target();
#endif
  return nullptr;
}

}  // namespace reckon
#endif
