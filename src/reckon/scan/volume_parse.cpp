// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

#include "reckon/scan/volume_formats.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

/// The value of a key of a NumPy header, up to the next comma outside brackets.
std::string_view value_after(std::string_view header, std::string_view key,
                             const std::string& place) {
  const std::size_t found = header.find(key);
  const std::size_t colon = found == std::string_view::npos ? found : header.find(':', found);
  if (colon == std::string_view::npos) {
    refuse_volume(place, fmt::format("the NumPy header has no {}", key), {},
                  "Save the array anew.");
  }
  std::string_view rest = header.substr(colon + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  const char close = rest.starts_with('(') ? ')' : ',';
  return rest.substr(0, rest.find(close));
}

/// The lengths in "(nz, ny, nx", x first.
std::array<std::int64_t, 3> numpy_shape(std::string_view text, const std::string& place) {
  std::vector<std::int64_t> shape;
  for (const char* at = text.data(); at < text.data() + text.size();) {
    if (std::string_view{"(), L"}.find(*at) != std::string_view::npos) {
      ++at;
      continue;
    }
    if (*at < '0' || *at > '9') {
      refuse_volume(place, "the array's shape cannot be read", std::string{text}, "Save it anew.");
    }
    std::int64_t length = 0;
    const auto [end, code] = std::from_chars(at, text.data() + text.size(), length);
    if (code != std::errc{})
      refuse_volume(place, "the array's shape is too large", {}, "Save it anew.");
    shape.push_back(length);
    at = end;
  }
  std::reverse(shape.begin(), shape.end());
  const auto counted = axes_that_count(shape, place);
  return {shape[counted[0]], shape[counted[1]], shape[counted[2]]};
}

}  // namespace

void check_length(const VolumeHeader& header, std::uint64_t bytes, const std::string& place) {
  const auto& dims = header.dims;
  const std::size_t size = size_of(header.type);
  check_dims(dims, bytes / size, place);
  const auto count = static_cast<std::uint64_t>(dims[0]) * static_cast<std::uint64_t>(dims[1]) *
                     static_cast<std::uint64_t>(dims[2]);
  if (count * size == bytes) return;
  refuse_volume(place, "the volume and its header disagree",
                fmt::format("{} x {} x {} {} take {} bytes, {} are there", dims[0], dims[1],
                            dims[2], name_of(header.type), count * size, bytes),
                "Check dimensions and type.");
}

std::array<std::size_t, 3> axes_that_count(const std::vector<std::int64_t>& lengths,
                                           const std::string& place) {
  std::vector<std::size_t> axes(lengths.size());
  std::iota(axes.begin(), axes.end(), std::size_t{0});
  for (std::size_t axis = lengths.size(); axis-- > 0 && axes.size() > 3;) {
    if (lengths[axis] == 1) axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(axis));
  }
  if (axes.size() != 3) {
    refuse_volume(place, "this is no volume",
                  fmt::format("it has {} dimensions that are longer than 1", axes.size()),
                  "Give a volume of three dimensions with one number a voxel.");
  }
  return {axes[0], axes[1], axes[2]};
}

std::optional<double> file_unit(std::string_view name) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr std::array units{Unit{"m", 1},
                             Unit{"meter", 1},
                             Unit{"metre", 1},
                             Unit{"cm", 1e-2},
                             Unit{"mm", 1e-3},
                             Unit{"millimeter", 1e-3},
                             Unit{"um", 1e-6},
                             Unit{"micron", 1e-6},
                             Unit{"microns", 1e-6},
                             Unit{"micrometer", 1e-6},
                             Unit{"\\u00b5m", 1e-6},
                             Unit{"\xc2\xb5m", 1e-6},
                             Unit{"\xce\xbcm", 1e-6},
                             Unit{"\xb5m", 1e-6},
                             Unit{"nm", 1e-9},
                             Unit{"nanometer", 1e-9},
                             Unit{"inch", 25.4e-3}};
  const std::string small = lower_case(name);
  const auto* const found = std::find_if(units.begin(), units.end(),
                                         [&](const Unit& unit) { return unit.name == small; });
  if (found == units.end()) return std::nullopt;
  return found->metres;
}

VolumeOutline outline_of(const VolumeHeader& header) {
  VolumeOutline outline{{}, header.type, header.spacing, header.remarks};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    outline.dims[axis] = static_cast<std::int32_t>(header.dims[axis]);
  }
  return outline;
}

VolumeHeader parse_npy_header(std::string_view bytes, const std::string& name) {
  constexpr std::string_view magic{"\x93NUMPY", 6};
  if (bytes.size() < 12 || !bytes.starts_with(magic)) {
    refuse_volume(name, "this is no NumPy file", "it does not begin with \\x93NUMPY",
                  "Save the array with numpy.save.");
  }
  const auto byte = [&](std::size_t n) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[n]));
  };
  const bool long_header = byte(6) >= 2;
  const std::size_t start = long_header ? 12 : 10;
  std::size_t length = byte(8) + 256 * byte(9);
  if (long_header) length += 65536 * byte(10) + 16777216 * byte(11);
  if (length > bytes.size() - start) {
    refuse_volume(name, "the NumPy file is cut short", "its header is not whole", "Copy it again.");
  }
  const std::string_view header = bytes.substr(start, length);
  std::string_view descr = value_after(header, "'descr'", name);
  if (descr.starts_with('\'')) descr.remove_prefix(1);
  if (descr.ends_with('\'')) descr.remove_suffix(1);
  const bool big = descr.starts_with('>');
  if (!descr.empty() && std::string_view{"<>|="}.find(descr.front()) != std::string_view::npos) {
    descr.remove_prefix(1);
  }
  const auto type = voxel_type_named(descr);
  if (!type) {
    refuse_volume(name, "the array's type is not known", fmt::format("\"{}\"", descr),
                  "Save it as integers of at most 32 bits or as floats.");
  }
  if (value_after(header, "'fortran_order'", name).starts_with("True")) {
    refuse_volume(name, "the array is in Fortran order", {}, "Save numpy.ascontiguousarray(a).");
  }
  VolumeHeader result;
  result.dims = numpy_shape(value_after(header, "'shape'", name), name);
  result.type = *type;
  result.big_endian = big;
  result.data_start = start + length;
  return result;
}

VolumeHeader parse_raw_sidecar(std::string_view text, const std::string& name) {
  TextReader reader{text, name};
  VolumeHeader header;
  std::optional<VoxelType> type;
  while (reader.next_line()) {
    const std::string_view key = reader.next_token();
    if (key.empty() || key.starts_with('#')) continue;
    if (key == "dims") {
      for (std::int64_t& dim : header.dims) dim = reader.next_integer("number of voxels");
    } else if (key == "type") {
      const std::string_view word = reader.next_token();
      type = voxel_type_named(word);
      if (!type) {
        reader.fail("the type is not known", in_quotes(word),
                    "There are uint8, int8, uint16, int16, uint32, int32, float32 and float64.");
      }
    } else if (key == "order") {
      const std::string_view word = reader.next_token();
      if (word != "little" && word != "big") {
        reader.fail("the byte order is not known", in_quotes(word), "Write little or big.");
      }
      header.big_endian = word == "big";
    } else {
      reader.fail("the line is not understood", in_quotes(key),
                  "Lines are `dims NX NY NZ`, `type uint16`, `order little`.");
    }
  }
  if (!type || header.dims[0] == 0) {
    refuse_volume(name, "dims or type are missing", {},
                  "Write lines `dims NX NY NZ`, `type uint16`, `order little`.");
  }
  header.type = *type;
  return header;
}

}  // namespace reckon
