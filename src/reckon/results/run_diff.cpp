// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/run_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <concepts>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "reckon/core/error.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/output/history.hpp"

namespace reckon {
namespace {

std::optional<double> to_number(const std::string& cell) {
  double value = 0;
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (code != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
template <std::integral Integer>
bool same_bits(Integer a, Integer b) {
  return a == b;
}

/// Which component of a row, in words.
std::string component_name(std::uint64_t width, std::uint64_t component) {
  if (width == 3) return fmt::format(", {}", "xyz"[component]);
  if (width == 4) return fmt::format(", {}", "wxyz"[component]);
  return {};
}

/// The subject of a row of a column.
std::string row_name(const std::string& column, std::uint64_t row, const SimulationState& state) {
  if (column.starts_with("/grain/")) return fmt::format("grain {}", state.grains[row].id.get());
  if (column.starts_with("/departed/")) {
    return fmt::format("departed grain {}", state.departed[row].grain.id.get());
  }
  if (column.starts_with("/driven_wall/")) return fmt::format("wall {}", row);
  if (column.starts_with("/stage/")) return fmt::format("stage {}", row + 1);
  if (column.starts_with("/pair/") && row < state.pair_springs.size()) {
    const PairSprings& pair = state.pair_springs[row];
    return fmt::format("pair of grains {} and {}", pair.id_a.get(), pair.id_b.get());
  }
  if (column.starts_with("/bond/")) {
    for (const PairSprings& pair : state.pair_springs) {
      if (pair.bond && row-- == 0) {
        return fmt::format("bond of grains {} and {}", pair.id_a.get(), pair.id_b.get());
      }
    }
  }
  if (column.starts_with("/wall_contact/") && row < state.wall_springs.size()) {
    const WallSprings& contact = state.wall_springs[row];
    return fmt::format("grain {} on wall {}", contact.grain.get(), contact.wall.get());
  }
  if (column.starts_with("/pair_spring/")) {
    for (const PairSprings& pair : state.pair_springs) {
      if (row < pair.springs.size()) {
        return fmt::format("pair of grains {} and {}, node {}", pair.id_a.get(), pair.id_b.get(),
                           pair.springs[row].node);
      }
      row -= pair.springs.size();
    }
  }
  if (column.starts_with("/wall_spring/")) {
    for (const WallSprings& contact : state.wall_springs) {
      if (row < contact.springs.size()) {
        return fmt::format("grain {} on wall {}, node {}", contact.grain.get(), contact.wall.get(),
                           contact.springs[row].node);
      }
      row -= contact.springs.size();
    }
  }
  return fmt::format("row {}", row);
}

template <class Number>
std::optional<Difference> column_difference(const CheckpointColumn& column,
                                            const std::vector<Number>& a,
                                            const std::vector<Number>& b,
                                            const SimulationState& state) {
  if (a.size() != b.size()) {
    return Difference{column.name,
                      "number of rows",
                      std::to_string(a.size() / column.width),
                      std::to_string(b.size() / column.width),
                      {}};
  }
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (same_bits(a[n], b[n])) continue;
    Difference difference{column.name,
                          row_name(column.name, n / column.width, state) +
                              component_name(column.width, n % column.width),
                          fmt::format("{}", a[n]),
                          fmt::format("{}", b[n]),
                          {}};
    if constexpr (std::is_same_v<Number, double>) difference.ulps = ulps_between(a[n], b[n]);
    return difference;
  }
  return std::nullopt;
}

RunComparison::Part compare_histories(const RunFolder& a, const RunFolder& b) {
  const HistoryTable first = read_history(a.own(a.history()));
  const HistoryTable second = read_history(b.own(b.history()));
  RunComparison::Part part{
      "history", fmt::format("{} and {} rows", first.rows.size(), second.rows.size()), {}};
  if (first.header != second.header) {
    part.difference = Difference{"columns",
                                 "header",
                                 fmt::format("{}", first.header.size()),
                                 fmt::format("{}", second.header.size()),
                                 {}};
    for (std::size_t c = 0; c < std::min(first.header.size(), second.header.size()); ++c) {
      if (first.header[c] == second.header[c]) continue;
      part.difference = Difference{"columns", "header", first.header[c], second.header[c], {}};
      break;
    }
    return part;
  }
  const std::size_t common = std::min(first.rows.size(), second.rows.size());
  for (std::size_t row = 0; row < common; ++row) {
    for (std::size_t c = 0; c < first.header.size(); ++c) {
      const std::string& x = first.rows[row][c];
      const std::string& y = second.rows[row][c];
      if (x == y) continue;
      part.difference = Difference{first.header[c], "step " + first.rows[row][0], x, y, {}};
      const auto p = to_number(x);
      const auto q = to_number(y);
      if (p && q) part.difference->ulps = ulps_between(*p, *q);
      return part;
    }
  }
  if (first.rows.size() != second.rows.size()) {
    part.difference = Difference{"number of rows",
                                 "end",
                                 std::to_string(first.rows.size()),
                                 std::to_string(second.rows.size()),
                                 {}};
  }
  return part;
}

RunComparison::Part compare_checkpoints(std::string name, const std::filesystem::path& a,
                                        const std::filesystem::path& b) {
  const Checkpoint first = read_checkpoint(a);
  const Checkpoint second = read_checkpoint(b);
  return {std::move(name), fmt::format("{} grains", first.state.grains.size()),
          first_difference(first.state, second.state)};
}

std::vector<std::uint64_t> checkpoints_of(const RunFolder& folder) {
  std::vector<std::uint64_t> steps = folder.checkpoint_steps();
  if (!steps.empty()) return steps;
  throw Error{{.place = folder.root().string(),
               .problem = "there is no checkpoint here",
               .reason = folder.holds_run() ? "the run has not written one yet"
                                            : "it is not the folder of a run",
               .fix = {}}};
}

}  // namespace

bool RunComparison::identical() const {
  return std::none_of(parts.begin(), parts.end(),
                      [](const Part& part) { return part.difference.has_value(); });
}

std::optional<std::uint64_t> ulps_between(double a, double b) {
  if (!std::isfinite(a) || !std::isfinite(b)) return std::nullopt;
  // Doubles in order are their bit patterns in order, negative ones backwards.
  const auto place = [](double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
  };
  const std::int64_t p = place(a);
  const std::int64_t q = place(b);
  return p > q ? static_cast<std::uint64_t>(p) - static_cast<std::uint64_t>(q)
               : static_cast<std::uint64_t>(q) - static_cast<std::uint64_t>(p);
}

std::optional<Difference> first_difference(const SimulationState& a, const SimulationState& b) {
  if (a.step != b.step) {
    return Difference{"step", "state", std::to_string(a.step), std::to_string(b.step), {}};
  }
  const std::vector<CheckpointColumn> first = to_columns(a);
  const std::vector<CheckpointColumn> second = to_columns(b);
  for (std::size_t c = 0; c < first.size(); ++c) {
    auto difference = std::visit(
        [&](const auto& values) {
          using Values = std::decay_t<decltype(values)>;
          return column_difference(first[c], values, std::get<Values>(second[c].values), a);
        },
        first[c].values);
    if (difference) return difference;
  }
  return std::nullopt;
}

RunComparison compare_runs(const RunFolder& a, const RunFolder& b) {
  const std::vector<std::uint64_t> first = checkpoints_of(a);
  const std::vector<std::uint64_t> second = checkpoints_of(b);
  RunComparison comparison;
  comparison.parts.push_back(compare_histories(a, b));
  std::vector<std::uint64_t> common;
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                        std::back_inserter(common));
  for (const std::uint64_t step : common) {
    if (step == first.back() && step == second.back()) continue;
    comparison.parts.push_back(compare_checkpoints(fmt::format("checkpoint of step {}", step),
                                                   a.own(a.checkpoint(step)),
                                                   b.own(b.checkpoint(step))));
  }
  comparison.parts.push_back(compare_checkpoints("final state", a.own(a.checkpoint(first.back())),
                                                 b.own(b.checkpoint(second.back()))));
  return comparison;
}

}  // namespace reckon
