// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace reckon {

/// A named array of tuples as VTK files hold it. Does not own its values: they must outlive the
/// call that writes them.
struct VtkArray {
  std::string name;
  std::string_view type;        ///< VTK's name of the number type, e.g. "Float64"
  std::uint32_t components{1};  ///< numbers per tuple
  std::size_t tuples{0};        ///< tuples in all
  std::string_view bytes;       ///< tuples * components numbers in the machine's byte order
};

template <class Number>
concept VtkNumber = std::same_as<Number, float> || std::same_as<Number, double> ||
    (std::integral<Number> && !std::same_as<Number, bool>);

/// VTK's name of a number type.
template <VtkNumber Number>
[[nodiscard]] constexpr std::string_view vtk_type_name() {
  if constexpr (std::same_as<Number, float>) return "Float32";
  if constexpr (std::same_as<Number, double>) return "Float64";
  constexpr bool is_signed = std::is_signed_v<Number>;
  switch (sizeof(Number)) {
    case 1:
      return is_signed ? "Int8" : "UInt8";
    case 2:
      return is_signed ? "Int16" : "UInt16";
    case 4:
      return is_signed ? "Int32" : "UInt32";
    default:
      return is_signed ? "Int64" : "UInt64";
  }
}

/// `numbers` as tuples of `components` numbers. Throws Error when they do not divide evenly.
[[nodiscard]] VtkArray make_vtk_array(std::string name, std::string_view type,
                                      std::uint32_t components, std::size_t numbers,
                                      std::string_view bytes);

template <VtkNumber Number>
[[nodiscard]] VtkArray vtk_array(std::string name, std::span<const Number> numbers,
                                 std::uint32_t components = 1) {
  return make_vtk_array(
      std::move(name), vtk_type_name<Number>(), components, numbers.size(),
      {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)});
}
template <VtkNumber Number>
[[nodiscard]] VtkArray vtk_array(std::string name, const std::vector<Number>& numbers,
                                 std::uint32_t components = 1) {
  return vtk_array(std::move(name), std::span<const Number>{numbers}, components);
}

/// An array of small structs of doubles (Vec3, Quaternion): one tuple each, in member order.
template <class Struct>
requires(std::is_trivially_copyable_v<Struct> && sizeof(Struct) % sizeof(double) == 0 &&
         std::is_class_v<Struct>) [[nodiscard]] VtkArray
    vtk_array(std::string name, const std::vector<Struct>& tuples) {
  constexpr auto components = static_cast<std::uint32_t>(sizeof(Struct) / sizeof(double));
  return make_vtk_array(
      std::move(name), "Float64", components, tuples.size() * components,
      {reinterpret_cast<const char*>(tuples.data()), tuples.size() * sizeof(Struct)});
}

/// Cells of one kind. Cell c has the points connectivity[offsets[c-1]] ... connectivity[offsets[c]
/// - 1], with offsets[-1] taken as 0: `offsets` holds the END of each cell, as VTK wants it.
struct VtkCells {
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets;

  [[nodiscard]] std::size_t size() const { return offsets.size(); }
};

/// `count` cells that use the points 0, 1, 2, ... in turn, `points_per_cell` each: vertices with
/// 1, separate lines with 2.
[[nodiscard]] VtkCells consecutive_cells(std::size_t count, std::size_t points_per_cell);

/// The content of a .vtp file. Cell data covers vertices, then lines, then polygons.
struct VtkPolyData {
  VtkArray points;  ///< three components
  VtkCells vertices;
  VtkCells lines;
  VtkCells polygons;  ///< counter-clockwise seen from outside
  std::vector<VtkArray> point_data;
  std::vector<VtkArray> cell_data;
  std::vector<VtkArray> field_data;  ///< of the whole file, e.g. "TimeValue"
};

/// Point data called "Normals" are what surfaces are shaded by.
///
/// Writes a VTK XML PolyData file: raw appended binary, little-endian, 64-bit headers, readable by
/// ParaView 5 and later. Throws Error when array lengths disagree with the number of points or
/// cells, when a cell names a point that does not exist, or when the file cannot be written.
void write_vtp(const std::filesystem::path& path, const VtkPolyData& data);

/// One file of a series.
struct PvdEntry {
  double time{0};    ///< [s]
  std::string file;  ///< relative to the .pvd file
  std::string part;  ///< a name that tells files of equal time apart; may be empty
};

/// Writes a ParaView collection file that puts files in order of time.
void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries);

/// One block of a multi-block file.
struct VtmBlock {
  std::string name;
  std::string file;  ///< relative to the .vtm file
};

/// Writes a VTK multi-block file, whose blocks are other files.
void write_vtm(const std::filesystem::path& path, std::span<const VtmBlock> blocks);

}  // namespace reckon
