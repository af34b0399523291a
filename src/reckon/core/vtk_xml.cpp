// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/vtk_xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/utf8.hpp"

namespace reckon {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are written as they lie in memory, and the header says LittleEndian");

[[noreturn]] void refuse_file(const std::filesystem::path& path, std::string problem) {
  throw Error{{.place = path.string(), .problem = std::move(problem), .reason = {}, .fix = {}}};
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : valid_utf8(text)) {
    if (static_cast<unsigned char>(c) < 0x20) {  // XML has no way to write most of them
      out += ' ';
      continue;
    }
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// The XML text with, beside it, the arrays that follow it as raw bytes:
///   _ [length of array 0, 8 bytes][array 0][length of array 1][array 1] ...
/// Offsets in the text count from the byte after the underscore.
struct Document {
  std::string text;
  std::vector<std::string> lengths;
  std::vector<std::string_view> blocks;
  std::uint64_t offset{0};

  void add(const VtkArray& array, bool in_field = false) {
    text += fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}")", array.type,
                        escaped(array.name), array.components);
    if (in_field) text += fmt::format(R"( NumberOfTuples="{}")", array.tuples);
    text += fmt::format(R"( format="appended" offset="{}"/>)", offset) + "\n";
    const std::uint64_t length = array.bytes.size();
    std::string head(sizeof length, '\0');
    std::memcpy(head.data(), &length, sizeof length);
    lengths.push_back(std::move(head));
    blocks.push_back(array.bytes);
    offset += sizeof length + length;
  }

  void add_section(std::string_view name, const std::vector<VtkArray>& arrays) {
    const bool shaded = std::any_of(arrays.begin(), arrays.end(),
                                    [](const VtkArray& array) { return array.name == "Normals"; });
    text += fmt::format("<{}{}>\n", name, shaded ? R"( Normals="Normals")" : "");
    for (const VtkArray& array : arrays) add(array);
    text += fmt::format("</{}>\n", name);
  }

  void add_cells(std::string_view name, const VtkCells& cells) {
    text += fmt::format("<{}>\n", name);
    add(vtk_array("connectivity", cells.connectivity));
    add(vtk_array("offsets", cells.offsets));
    text += fmt::format("</{}>\n", name);
  }
};

void check(const std::filesystem::path& path, const VtkPolyData& data) {
  if (data.points.components != 3) refuse_file(path, "points need three coordinates each");
  for (const VtkCells* cells : {&data.vertices, &data.lines, &data.polygons}) {
    std::int64_t begin = 0;
    for (const std::int64_t end : cells->offsets) {
      if (end < begin) refuse_file(path, "cell offsets must not decrease");
      begin = end;
    }
    if (begin != static_cast<std::int64_t>(cells->connectivity.size())) {
      refuse_file(path, "the last cell offset must be the length of the connectivity");
    }
    for (const std::int64_t point : cells->connectivity) {
      if (point < 0 || static_cast<std::size_t>(point) >= data.points.tuples) {
        refuse_file(path, fmt::format("a cell names point {} of {}", point, data.points.tuples));
      }
    }
  }
  const std::size_t cell_count = data.vertices.size() + data.lines.size() + data.polygons.size();
  const auto check_lengths = [&](const std::vector<VtkArray>& arrays, std::size_t expected) {
    for (const VtkArray& array : arrays) {
      if (array.tuples != expected) {
        refuse_file(path, fmt::format("array {} has {} tuples where {} are needed", array.name,
                                      array.tuples, expected));
      }
    }
  };
  check_lengths(data.point_data, data.points.tuples);
  check_lengths(data.cell_data, cell_count);
}

}  // namespace

VtkArray make_vtk_array(std::string name, std::string_view type, std::uint32_t components,
                        std::size_t numbers, std::string_view bytes) {
  if (components == 0 || numbers % components != 0) {
    throw Error{{.place = "VTK array " + name,
                 .problem = fmt::format("{} numbers do not make tuples of {}", numbers, components),
                 .reason = {},
                 .fix = {}}};
  }
  return {std::move(name), type, components, numbers / components, bytes};
}

VtkCells consecutive_cells(std::size_t count, std::size_t points_per_cell) {
  VtkCells cells;
  cells.connectivity.reserve(count * points_per_cell);
  cells.offsets.reserve(count);
  for (std::size_t p = 0; p < count * points_per_cell; ++p) {
    cells.connectivity.push_back(static_cast<std::int64_t>(p));
  }
  for (std::size_t c = 1; c <= count; ++c) {
    cells.offsets.push_back(static_cast<std::int64_t>(c * points_per_cell));
  }
  return cells;
}

void write_vtp(const std::filesystem::path& path, const VtkPolyData& data) {
  check(path, data);
  Document document;
  document.text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n";
  if (!data.field_data.empty()) {
    document.text += "<FieldData>\n";
    for (const VtkArray& array : data.field_data) document.add(array, true);
    document.text += "</FieldData>\n";
  }
  document.text += fmt::format(
      R"(<Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="{}" NumberOfStrips="0" )"
      "NumberOfPolys=\"{}\">\n",
      data.points.tuples, data.vertices.size(), data.lines.size(), data.polygons.size());
  document.add_section("PointData", data.point_data);
  document.add_section("CellData", data.cell_data);
  document.add_section("Points", {data.points});
  document.add_cells("Verts", data.vertices);
  document.add_cells("Lines", data.lines);
  document.add_cells("Polys", data.polygons);
  document.text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  std::vector<std::string_view> parts{document.text};
  for (std::size_t b = 0; b < document.blocks.size(); ++b) {
    parts.emplace_back(document.lengths[b]);
    parts.push_back(document.blocks[b]);
  }
  parts.emplace_back("\n</AppendedData>\n</VTKFile>\n");
  write_file(path, parts);
}

void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const PvdEntry& entry : entries) {
    text += fmt::format(R"(<DataSet timestep="{}" group="" part="{}" file="{}"/>)", entry.time,
                        escaped(entry.part), escaped(entry.file)) +
            "\n";
  }
  text += "</Collection>\n</VTKFile>\n";
  write_file(path, text);
}

void write_vtm(const std::filesystem::path& path, std::span<const VtmBlock> blocks) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<vtkMultiBlockDataSet>\n";
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    text += fmt::format(R"(<DataSet index="{}" name="{}" file="{}"/>)", n, escaped(blocks[n].name),
                        escaped(blocks[n].file)) +
            "\n";
  }
  text += "</vtkMultiBlockDataSet>\n</VTKFile>\n";
  write_file(path, text);
}

}  // namespace reckon
