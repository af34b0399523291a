// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "grains_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "grains_parts.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/csv_text.hpp"
#include "reckon/text/units.hpp"

namespace reckon::app {
namespace {

constexpr Dimension length_dimension{.mass = 0, .length = 1, .time = 0, .angle = 0};

[[noreturn]] void refuse(const std::string& option, std::string problem, std::string reason,
                         std::string fix) {
  throw Error{{.place = option,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

/// A quantity; its fault is reported for the option.
Quantity parse_of_option(const std::string& option, std::string_view text) {
  try {
    return parse_quantity(text);
  } catch (const Error& error) {
    refuse(option, error.text().problem, error.text().reason, error.text().fix);
  }
}

double parse_positive_number(const std::string& option, std::string_view text) {
  const Quantity quantity = parse_of_option(option, text);
  if (quantity.dimension != Dimension{} || !(quantity.value > 0)) {
    refuse(option, fmt::format("'{}' is not a positive number", text), {}, "Give it without unit.");
  }
  return quantity.value;
}

}  // namespace

double parse_length(const std::string& option, std::string_view text) {
  const Quantity quantity = parse_of_option(option, text);
  if (quantity.dimension == Dimension{}) {
    refuse(option, fmt::format("'{}' has no unit", text), "it is a length",
           fmt::format("Write {}mm or {}m, say.", text, text));
  }
  if (quantity.dimension != length_dimension || !(quantity.value > 0)) {
    refuse(option, fmt::format("'{}' is not a length above zero", text), {},
           "Give a length such as 0.2mm.");
  }
  // Far beyond these, volumes and moments of inertia are no numbers any more.
  constexpr double shortest = 1e-12;
  constexpr double longest = 1e6;
  if (quantity.value < shortest || quantity.value > longest) {
    refuse(option, fmt::format("'{}' is no length of a grain", text),
           fmt::format("lengths go from {:g} to {:g} m", shortest, longest), "Check its unit.");
  }
  return quantity.value;
}

std::vector<double> parse_lengths(const std::string& option, std::string_view text,
                                  std::size_t count, std::size_t total) {
  const std::vector<std::string_view> parts = comma_separated(text);
  if (parts.size() != total) {
    refuse(option, fmt::format("'{}' has {} numbers", text, parts.size()),
           fmt::format("{} {} needed", total, total == 1 ? "is" : "are"),
           "Commas separate numbers: decimals have a point, as in 0.5mm.");
  }
  std::vector<double> values;
  values.reserve(total);
  for (const std::string_view part : parts) {
    values.push_back(values.size() < count ? parse_length(option, part)
                                           : parse_positive_number(option, part));
  }
  return values;
}

std::vector<double> parse_numbers(const std::string& option, std::string_view text) {
  std::vector<double> values;
  for (const std::string_view part : comma_separated(text)) {
    const Quantity quantity = parse_of_option(option, part);
    if (quantity.dimension != Dimension{}) {
      refuse(option, fmt::format("'{}' is not a number", part), {}, "Give it without unit.");
    }
    values.push_back(quantity.value);
  }
  return values;
}

double parse_length_unit(const std::string& option, const std::string& text) {
  const Quantity one = parse_of_option(option, "1 " + text);
  if (one.dimension != length_dimension) {
    refuse(option, fmt::format("'{}' is not a unit of length", text), {},
           "Give um, mm, m or the like.");
  }
  return one.value;
}

Provenance provenance_of(const CommandWords& words, const std::vector<std::string>& sources) {
  constexpr std::array<std::string_view, 5> with_value{"--output", "--out", "-o", "--threads",
                                                       "--memory"};
  Provenance made{{}, {}, source_files(sources)};
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::string_view word = words[w];
    if (word == "--json") continue;
    const bool skipped = std::any_of(with_value.begin(), with_value.end(), [&](auto option) {
      return word == option || word.starts_with(std::string{option} + "=");
    });
    if (skipped) {
      if (word.find('=') == std::string_view::npos) ++w;
    } else if (!word.starts_with("-o")) {  // also -ofile.h5
      made.command.push_back(words[w]);
    }
  }
  return made;
}

void add_storage_option(CLI::App& command, ShapeStorage& storage) {
  static const std::map<std::string, ShapeStorage> kinds{{"full", ShapeStorage::full},
                                                         {"band", ShapeStorage::band}};
  command
      .add_option("--storage", storage,
                  "full: whole grids; band: 16-bit distances within two voxels of the surface and "
                  "nodes in single precision, a quarter of the memory or less")
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case))
      ->default_str("full");
}

std::vector<std::size_t> choose_shapes(const LibrarySource& library,
                                       std::span<const std::string> names) {
  std::vector<std::size_t> chosen;
  if (names.empty()) {
    chosen.resize(library.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  const ShapeLibrary entries = entries_of(library);
  for (const std::string& name : names) {
    chosen.push_back(static_cast<std::size_t>(&find_shape(entries, name) - entries.data()));
  }
  return chosen;
}

void add_grains_command(CLI::App& app, const CommandWords& words) {
  CLI::App* grains = app.add_subcommand(
      "grains",
      "Make shape libraries from scans, meshes, coefficients, solids or statistics; inspect them");
  grains->require_subcommand(1);
  add_grains_sources(*grains, words);
  add_grains_legacy(*grains, words);
  add_grains_info(*grains);
  add_grains_export(*grains);
  add_grains_scan(*grains, words);
  add_grains_from_scan(*grains, words);
  add_grains_moved(*grains);
  add_grains_statistics(*grains);
}

}  // namespace reckon::app
