// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/math/rotation.hpp"

namespace reckon {

/// The eigenvalues of a symmetric matrix and an orthonormal basis of its eigenvectors.
struct SymmetricEigen {
  Vec3 values;   ///< ascending
  Mat3 vectors;  ///< row i belongs to value i; length 1; handedness and signs are not fixed
};

/// Jacobi's method: plane rotations zero one off-diagonal component after the other until all have
/// vanished. For a 3x3 matrix it is as accurate as any method, also for equal eigenvalues, and it
/// takes only square roots in a fixed order, so the bits are the same on every machine. Only the
/// lower triangle of `matrix` is read; its components must be finite.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Mat3& matrix);

}  // namespace reckon
