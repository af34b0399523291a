// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

namespace reckon::python {

py::array_t<double> rows_of(std::span<const Vec3> vectors) {
  py::array_t<double> array({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  double* to = array.mutable_data();
  for (const Vec3& v : vectors) {
    *to++ = v.x;
    *to++ = v.y;
    *to++ = v.z;
  }
  return array;
}

py::array_t<double> rows_of(std::span<const Quaternion> quaternions) {
  py::array_t<double> array({static_cast<py::ssize_t>(quaternions.size()), py::ssize_t{4}});
  double* to = array.mutable_data();
  for (const Quaternion& q : quaternions) {
    *to++ = q.w;
    *to++ = q.x;
    *to++ = q.y;
    *to++ = q.z;
  }
  return array;
}

py::tuple tuple_of(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }

}  // namespace reckon::python
