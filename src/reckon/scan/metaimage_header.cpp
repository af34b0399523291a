// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "reckon/scan/header_text.hpp"

namespace reckon {
namespace {

constexpr std::array meta_types{
    NamedType{"MET_UCHAR", VoxelType::uint8},   NamedType{"MET_CHAR", VoxelType::int8},
    NamedType{"MET_USHORT", VoxelType::uint16}, NamedType{"MET_SHORT", VoxelType::int16},
    NamedType{"MET_UINT", VoxelType::uint32},   NamedType{"MET_INT", VoxelType::int32},
    NamedType{"MET_FLOAT", VoxelType::float32}, NamedType{"MET_DOUBLE", VoxelType::float64}};
// Fields that give neither the place, nor the type, nor the axes of the numbers.
constexpr std::array meta_ignored{"ObjectType",
                                  "ObjectSubType",
                                  "BinaryData",
                                  "Offset",
                                  "Position",
                                  "Origin",
                                  "Comment",
                                  "CenterOfRotation",
                                  "Name",
                                  "ID",
                                  "ParentID",
                                  "AnatomicalOrientation",
                                  "Color",
                                  "Modality",
                                  "CompressionLevel",
                                  "CompressedDataSize",
                                  "ElementMin",
                                  "ElementMax",
                                  "ElementNBits",
                                  "AcquisitionDate",
                                  "SequenceID",
                                  "TransformType",
                                  "ImagePosition"};

/// The data file or files of `value`; a list begins behind the header, at `next`.
void set_data_files(VolumeHeader& header, std::string_view value, std::string_view bytes,
                    std::size_t next, const std::string& place) {
  const std::vector<std::string> words = words_in(value);
  if (words.empty() || (words.size() == 1 && lower_case(value) == "local")) return;
  if (words.front() == "LIST") {
    if (words.size() > 1 && words[1] != "2D" && words[1] != "2") {
      refuse_volume(place, "ElementDataFile lists files of another kind than slices",
                    in_quotes(value), "Give a list of slices, `LIST 2D`.");
    }
    header.data_files = listed_files(bytes, next, place);
    return;
  }
  if (words.front().find('%') != std::string::npos && words.size() == 4) {
    header.data_files = files_of_pattern(
        words.front(), numbers_in(value.substr(words.front().size()), place), place);
    return;
  }
  header.data_files = {std::string{value}};
}

}  // namespace

VolumeHeader parse_metaimage_header(std::string_view bytes, const std::string& place) {
  VolumeHeader header;
  HeaderAxes axes;
  bool has_type = false;
  std::string_view data_file;
  std::int64_t header_size = 0;
  std::vector<double> matrix;
  const std::size_t end = for_each_line(bytes, place, [&](std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      refuse_volume(place, "the header is damaged", "a line has no =", "Copy the file again.");
    }
    const std::string_view key = trimmed(line.substr(0, equals));
    const std::string_view value = trimmed(line.substr(equals + 1));
    const auto is_one_of = [&](auto... names) { return ((key == names) || ...); };
    if (key == "DimSize") {
      axes.lengths = numbers_in(value, place);
    } else if (key == "ElementType") {
      header.type = type_named(meta_types, value, place);
      has_type = true;
    } else if (key == "ElementSpacing" || (key == "ElementSize" && axes.edges.empty())) {
      axes.edges = numbers_in(value, place);
      axes.edges_field = key;
    } else if (key == "ElementSize") {
      return false;  // of less account than ElementSpacing
    } else if (key == "DistanceUnits") {
      header.spacing.unit = file_unit(value);
    } else if (is_one_of("TransformMatrix", "Rotation", "Orientation")) {
      matrix = numbers_in(value, place);
      axes.directions_field = key;
    } else if (is_one_of("ElementByteOrderMSB", "BinaryDataByteOrderMSB")) {
      header.big_endian = lower_case(value) == "true";
    } else if (key == "CompressedData") {
      header.compressed = lower_case(value) == "true";
    } else if (key == "ElementNumberOfChannels") {
      if (value != "1") {
        refuse_volume(place, "this is no volume of one number a voxel",
                      fmt::format("{} is {}", key, value), "Save it in shades of gray.");
      }
    } else if (key == "HeaderSize") {
      header_size = integer_in(value, key, place);
    } else if (key == "ElementDataFile") {
      data_file = value;
      return true;
    } else if (key != "NDims" && !is_among(meta_ignored, key)) {
      // The format lets programs add fields of their own.
      header.remarks.push_back(fmt::format("the header's field {} is not used", in_quotes(key)));
    }
    return false;
  });
  for (std::size_t axis = 0; axis * axis < matrix.size(); ++axis) {
    const std::size_t rank = axes.lengths.size();
    if (matrix.size() != rank * rank) {
      refuse_volume(place, fmt::format("{} does not fit the volume", axes.directions_field),
                    fmt::format("{} numbers for {} axes", matrix.size(), rank), "Save it anew.");
    }
    const auto row = matrix.begin() + static_cast<std::ptrdiff_t>(axis * rank);
    axes.directions.emplace_back(row, row + static_cast<std::ptrdiff_t>(rank));
  }
  if (!axes.directions.empty() && axes.edges.empty()) {
    axes.edges.assign(axes.lengths.size(), std::nan(""));
    axes.edges_field = axes.directions_field;
  }
  set_data_files(header, data_file, bytes, end, place);
  header.at_end = header_size == -1;
  header.data_start = header.data_files.empty() ? end : 0;
  if (header_size > 0) header.data_start += static_cast<std::uint64_t>(header_size);
  require_complete(header, has_type, axes, place);
  set_axes(header, axes, place);
  return header;
}

std::string metaimage_header(const VolumeOutline& what) {
  const auto& [nx, ny, nz] = what.dims;
  return fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = False\nElementSpacing = {0} {0} {0}\nDimSize = {1} {2} {3}\n"
      "ElementType = {4}\nElementDataFile = LOCAL\n",
      1e3 * what.spacing.edge.value(), nx, ny, nz, name_among(meta_types, what.type));
}

}  // namespace reckon
