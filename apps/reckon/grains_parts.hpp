// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grains_command.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon::app {

// The subcommands of `reckon grains`, one source file each.
/// generate, solid, spheres, from-mesh, from-harmonics, ...
void add_grains_sources(CLI::App& grains, const CommandWords& words);
/// from-legacy, to-legacy
void add_grains_legacy(CLI::App& grains, const CommandWords& words);
void add_grains_info(CLI::App& grains);
void add_grains_export(CLI::App& grains);
void add_grains_scan(CLI::App& grains, const CommandWords& words);
void add_grains_from_scan(CLI::App& grains, const CommandWords& words);
void add_grains_moved(CLI::App& grains);
void add_grains_statistics(CLI::App& grains);

/// A length such as "0.2mm" [m]. Throws Error naming `option` when it is no length above zero; a
/// number without unit is refused, since its meaning is not known.
[[nodiscard]] double parse_length(const std::string& option, std::string_view text);
/// `count` lengths separated by commas, and after them pure numbers up to `total`.
[[nodiscard]] std::vector<double> parse_lengths(const std::string& option, std::string_view text,
                                                std::size_t count, std::size_t total);
/// Numbers without a unit, separated by commas.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, std::string_view text);
/// How many metres a unit of length such as "mm" has.
[[nodiscard]] double parse_length_unit(const std::string& option, const std::string& text);

/// How a library was made: the words of the command line, without options that do not change the
/// shapes (where to write, threads, memory, JSON), and these files or folders with their checksums.
[[nodiscard]] Provenance provenance_of(const CommandWords& words,
                                       const std::vector<std::string>& sources);

/// --storage: whole grids or bands.
void add_storage_option(CLI::App& command, ShapeStorage& storage);

/// The numbers of the shapes of these names, all when there are none. Throws Error for a name that
/// is not there.
[[nodiscard]] std::vector<std::size_t> choose_shapes(const LibrarySource& library,
                                                     std::span<const std::string> names);

}  // namespace reckon::app
