// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace reckon {

/// What programs write into the description of a TIFF file's first page: ImageJ in lines such as
/// "images=36", OME in XML.
struct TiffDescription {
  bool by_imagej{false};
  std::uint64_t images{0};                         ///< all of a stack; 0: not said
  std::array<std::uint64_t, 3> per_axis{1, 1, 1};  ///< ImageJ's channels, slices and frames
  std::optional<double> z_edge;                    ///< of a voxel, in `unit`
  std::optional<double> x_edge;                    ///< OME only; ImageJ has the page's resolution
  std::optional<double> y_edge;
  std::string unit;  ///< as the file has it; empty: not said
};
/// Never fails: unknown content is ignored.
[[nodiscard]] TiffDescription parse_tiff_description(std::string_view text);

}  // namespace reckon
