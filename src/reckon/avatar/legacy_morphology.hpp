// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/math/rotation.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// A grain as the text files of the original LS-DEM family of codes hold it. Lengths in voxels of
/// the scan, density 1, body frame principal with the origin at the centre of mass. The file has
/// these items, one a line: mass; moments; centre of mass; number of nodes; nodes; bounding radius;
/// dims; values.
struct LegacyMorphology {
  double mass{0};                      ///< the volume [voxel^3]
  Vec3 moments;                        ///< principal moments of inertia [voxel^5]
  Vec3 center_of_mass;                 ///< in the grid's coordinates [voxel]
  std::vector<Vec3> nodes;             ///< body frame [voxel]
  double bounding_radius{0};           ///< [voxel]
  std::array<std::int32_t, 3> dims{};  ///< grid vertices along x, y, z
  std::vector<float> values;           ///< x fastest, negative inside [voxel]
};

/// Parses the text of one file; `name` goes into messages. Numbers may be separated by any blanks
/// and line ends. Throws Error naming line and item when one is missing, malformed, out of range,
/// or left over.
[[nodiscard]] LegacyMorphology parse_legacy_morphology(std::string_view text,
                                                       const std::string& name);
/// The text of one file, with as many digits as bring every number back exactly.
[[nodiscard]] std::string format_legacy_morphology(const LegacyMorphology& morphology);

/// Whose bounding radius an imported shape gets. The original codes take the largest |node|; a few
/// hundredths of a voxel of phi < 0 can lie beyond it, and those codes do not look there.
enum class LegacyRadius : std::uint8_t {
  as_in_file,  ///< to repeat what those codes compute; breaks the promise of Shape::bounding_radius
  enclosing,   ///< raised where needed to keep that promise
};

/// A shape with `voxel` metres to the voxel. With voxel = 1 all numbers are those of the file; only
/// the nodes' order is the compact one of node_order.hpp. Node areas are shares of the extracted
/// surface (the file has none); descriptors come from that surface too.
[[nodiscard]] Shape to_shape(const LegacyMorphology& morphology, double voxel,
                             const std::string& name, LegacyRadius radius);

/// The inverse, with the shape's grid spacing as the voxel. Node areas, name and descriptors are
/// lost.
[[nodiscard]] LegacyMorphology to_legacy(const Shape& shape);

/// All files morph_NUMBER.dat of a folder in order of their numbers, named morph_NUMBER. Throws
/// Error when there are none.
[[nodiscard]] ShapeLibrary load_legacy_folder(const std::filesystem::path& folder, double voxel,
                                              LegacyRadius radius = LegacyRadius::as_in_file);
/// Writes shape s as folder/morph_(s+1).dat; the folder is made when missing.
void save_legacy_folder(const std::filesystem::path& folder, const ShapeLibrary& library);

/// Lines `x y z`: one position per grain [voxel]. Throws Error naming the line.
[[nodiscard]] std::vector<Vec3> parse_legacy_positions(std::string_view text,
                                                       const std::string& name);
/// Lines `a b c d`: one rotation per grain, as quaternions (w, x, y, z) = (d, -b, a, -c), which
/// turn the body frame into the world frame. As written, not normalised. Throws Error naming the
/// line, also where the length is not one within 1e-3.
[[nodiscard]] std::vector<Quaternion> parse_legacy_rotations(std::string_view text,
                                                             const std::string& name);

}  // namespace reckon
