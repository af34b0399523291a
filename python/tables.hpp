// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "reckon/output/quantities.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/simulation/measurement.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon::python {

/// The quantities of history.csv by their names without units, energies in a dictionary `energy`,
/// the forces on walls as rows of `wall_force` in scene order.
[[nodiscard]] pybind11::dict table_of(const std::vector<MeasuredQuantity>& quantities,
                                      const EnergyBudget& budget);

// Dictionaries of one array per quantity; the names are those of fields/*.vtp.

[[nodiscard]] pybind11::dict table_of(const std::vector<GrainState>& grains);
[[nodiscard]] pybind11::dict table_of(const std::vector<SavedGrain>& grains);
[[nodiscard]] pybind11::dict table_of(const std::vector<ContactRecord>& contacts);

}  // namespace reckon::python
