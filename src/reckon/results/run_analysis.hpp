// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reckon/output/run_folder.hpp"

namespace reckon {

struct AnalysisOptions {
  std::optional<std::uint64_t> from;   ///< step; none: the first saved in the last stage
  std::optional<double> longest_edge;  ///< see local_strain; none: five mean diameters [m]
  double bin_width{0.1};               ///< of the histogram of forces, over their mean; > 0
};

/// The motion of the grains around each grain since `from`, at one saved step. Its numbers are NaN
/// where no grain has a strain.
struct StrainSummary {
  std::uint64_t step{0};
  double shear{0};       ///< mean of all grains with a strain
  double largest{0};     ///< nine tenths of them have less
  double volumetric{0};  ///< mean, compression positive
};

struct RunAnalysis {
  std::uint64_t from{0};
  std::vector<StrainSummary> strains;
  std::filesystem::path strain_index;        ///< strain.pvd
  std::filesystem::path force_distribution;  ///< force_distribution.csv; empty without contacts
  std::vector<std::string> left_out;         ///< saved steps that cannot be read, with the reason
};

/// Analyses the saved fields of a run. Writes, per saved step after `from`, the local strain around
/// each grain and its rotation, for ParaView, and for every saved step from there on the
/// distribution of the forces between grains. Steps whose files cannot be read are left out, the
/// first of the last stage too. Throws Error where the run has not saved two steps, not that of
/// `from`, or other grains at one than at the other. `progressed` is called with the steps done.
RunAnalysis analyse_run(
    const RunFolder& folder, const AnalysisOptions& options,
    const std::function<void(std::size_t done, std::size_t total)>& progressed = {});

}  // namespace reckon
