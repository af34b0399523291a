// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "reckon/analysis/sample.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/simulation/measurement.hpp"
#include "reckon/simulation/simulation.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {

/// What was measured at one step.
struct HistoryRow {
  const Measurement& measurement;
  double energy_at_start{0};                 ///< EnergyBudget::total() at step 0 [J]
  const CellState* cell{nullptr};            ///< none without a periodic cell
  std::optional<std::uint64_t> stage{};      ///< counted from 1; none without stages
  const SampleMeasurement* sample{nullptr};  ///< none where it was not measured
};

/// Counts stay whole numbers.
using Number = std::variant<std::uint64_t, double>;

/// The name of a quantity.
struct QuantityName {
  std::string name;                       ///< without its unit, e.g. "momentum"
  std::string unit;                       ///< e.g. "kg m/s"; empty for a pure number
  std::string meaning;                    ///< for the reference
  std::vector<std::string> components{};  ///< "_x", "_y", "_z", ...; empty for a single number
  bool of_wall{false};                    ///< one of the quantities that each wall has

  /// Its columns: name, component and unit, e.g. "momentum_x_kg_m_per_s".
  [[nodiscard]] std::vector<std::string> columns() const;
};

/// One measured quantity. An entry in the table of quantities is sufficient: header and rows of
/// history.csv, its reference page, the page of a report, Python and JSON are made from that table.
struct HistoryQuantity : QuantityName {
  /// Its numbers, as many as it has columns.
  std::function<std::vector<Number>(const HistoryRow&)> numbers;
};

/// Which quantities a run has.
struct HistoryLayout {
  std::span<const Wall> walls;
  bool membrane{false};
  bool cell{false};
  bool bonds{false};
  bool stages{false};
  bool sample{false};
};

[[nodiscard]] HistoryLayout layout_of(const SimulationSetup& setup, bool sample);

/// Quantities that a run has all of, or none.
struct QuantityGroup {
  std::string title;      ///< for the reference
  std::string condition;  ///< which runs have them, as a sentence
  bool (*is_in)(const HistoryLayout&);
  std::vector<HistoryQuantity> quantities;
};

/// The table: everything that a run with these walls may measure.
[[nodiscard]] std::vector<QuantityGroup> quantity_groups(std::span<const Wall> walls);
/// The part of the table that a run has.
[[nodiscard]] std::vector<HistoryQuantity> quantities_of(const HistoryLayout& layout);

/// A quantity with its numbers at some step.
struct MeasuredQuantity : QuantityName {
  std::vector<Number> numbers;
};
[[nodiscard]] std::vector<MeasuredQuantity> measured(std::span<const HistoryQuantity> quantities,
                                                     const HistoryRow& row);

/// Writes a number for each column, by its name.
void write_measured(JsonWriter& json, std::span<const MeasuredQuantity> quantities);

}  // namespace reckon
