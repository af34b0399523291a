// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>

#include "reckon/math/rotation.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon::python {

namespace py = pybind11;

/// Copies, a row for each.
[[nodiscard]] py::array_t<double> rows_of(std::span<const Vec3> vectors);            ///< (n, 3)
[[nodiscard]] py::array_t<double> rows_of(std::span<const Quaternion> quaternions);  ///< (n, 4)
[[nodiscard]] py::tuple tuple_of(const Vec3& v);

/// A copy as a one-dimensional array.
template <class Number>
[[nodiscard]] py::array_t<Number> array_of(std::span<const Number> numbers) {
  return py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

/// field(item) of every item as an array.
template <class Number, class Items, class Field>
[[nodiscard]] py::array_t<Number> column(const Items& items, Field&& field) {
  py::array_t<Number> array(static_cast<py::ssize_t>(items.size()));
  auto* to = array.mutable_data();
  for (const auto& item : items) *to++ = field(item);
  return array;
}

/// vector(item) of every item as rows.
template <class Items, class Field>
[[nodiscard]] py::array_t<double> vectors(const Items& items, Field&& vector) {
  std::vector<std::decay_t<decltype(vector(*items.begin()))>> all;
  all.reserve(items.size());
  for (const auto& item : items) all.push_back(vector(item));
  return rows_of(all);
}

}  // namespace reckon::python
