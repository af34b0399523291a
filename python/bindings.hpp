// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace reckon::python {

void bind_shapes(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_runs(pybind11::module_& module);

}  // namespace reckon::python
