// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/volume_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/scan/volume_formats.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

constexpr double most_labels = 16777216;  // a float counts so far

bool is_tiff(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".tif" || ending == ".tiff";
}

[[noreturn]] void refuse_ending(const std::filesystem::path& file) {
  refuse_volume(file, "this kind of file is not known as a volume",
                fmt::format("its name ends in \"{}\"", file.extension().string()),
                "Give .tif, .nrrd, .mha, .raw, .npy or .h5, or a folder of TIFF slices.");
}

std::unique_ptr<VolumeReader> open_slices(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    const bool hidden = entry.path().filename().string().starts_with('.');
    if (entry.is_regular_file() && is_tiff(entry.path()) && !hidden) {
      files.push_back(entry.path());
    }
  }
  if (files.empty()) {
    refuse_volume(folder, "the folder holds no TIFF slices", {},
                  "Name a folder of .tif files, one slice each, or a volume file.");
  }
  return open_tiff_slices(std::move(files), folder.string());
}

std::unique_ptr<VolumeReader> open_raw(const std::filesystem::path& file) {
  const std::filesystem::path sidecar = sidecar_of(file);
  if (!std::filesystem::exists(sidecar)) {
    refuse_volume(file, "a raw volume does not say what its numbers are",
                  "there is no " + sidecar.filename().string() + " beside it",
                  "Write that file: lines `dims NX NY NZ`, `type uint16`, `order little`.");
  }
  return open_plain_volume(std::make_shared<ByteFile>(file),
                           parse_raw_sidecar(read_file(sidecar), sidecar.string()));
}

std::string beginning_of(const ByteFile& file) {
  std::string bytes(std::min<std::uint64_t>(file.size(), longest_header), '\0');
  file.read(0, std::as_writable_bytes(std::span{bytes}));
  return bytes;
}

/// The offset in a file after so many lines of text.
std::uint64_t after_lines(const ByteFile& file, std::uint64_t start, std::uint64_t lines) {
  std::vector<char> buffer(65536);
  for (std::uint64_t at = start; lines > 0;) {
    const std::uint64_t left = file.size() - std::min(file.size(), at);
    if (left == 0) {
      refuse_volume(file.path(), "the file is cut short",
                    fmt::format("the header skips {} lines more than it has", lines),
                    "Copy it again, or correct its header.");
    }
    const std::size_t count = std::min<std::uint64_t>(left, buffer.size());
    file.read(at, std::as_writable_bytes(std::span{buffer}.first(count)));
    for (std::size_t n = 0; n < count && lines > 0; ++n) {
      if (buffer[n] == '\n' && --lines == 0) return at + n + 1;
    }
    at += count;
  }
  return start;
}

using ParseHeader = VolumeHeader (*)(std::string_view bytes, const std::string& place);

/// NumPy, MetaImage or NRRD: a header, and behind it or in other files the numbers.
std::unique_ptr<VolumeReader> open_with_header(const std::filesystem::path& path,
                                               ParseHeader parse) {
  auto file = std::make_shared<const ByteFile>(path);
  VolumeHeader header = parse(beginning_of(*file), path.string());
  if (header.data_files.size() > 1) {
    header.data_start += header.skip_bytes;
    std::vector<std::filesystem::path> files;
    for (const std::string& name : header.data_files) files.push_back(path.parent_path() / name);
    return mirrored(open_plain_files(std::move(files), header), header.mirrored);
  }
  if (!header.data_files.empty()) {
    file = std::make_shared<const ByteFile>(path.parent_path() / header.data_files.front());
  }
  header.data_start = after_lines(*file, header.data_start, header.skip_lines) + header.skip_bytes;
  auto reader = header.compressed ? open_packed_volume(std::move(file), header)
                                  : open_plain_volume(std::move(file), header);
  return mirrored(std::move(reader), header.mirrored);
}

/// For files whose header may name others; null for all else.
ParseHeader header_parser_of(const std::string& ending) {
  if (ending == ".npy") return parse_npy_header;
  if (ending == ".mha" || ending == ".mhd") return parse_metaimage_header;
  if (ending == ".nrrd" || ending == ".nhdr") return parse_nrrd_header;
  return nullptr;
}

std::unique_ptr<VolumeReader> open_by_ending(const VolumeRequest& request) {
  const std::filesystem::path& file = request.file;
  if (std::filesystem::is_directory(file)) return open_slices(file);
  if (!std::filesystem::exists(file)) {
    refuse_volume(file, "there is no such file", {}, "Check its name.");
  }
  const std::string ending = ending_of(file);
  if (ending == ".raw") return open_raw(file);
  if (const ParseHeader parse = header_parser_of(ending)) return open_with_header(file, parse);
  if (ending == ".h5" || ending == ".hdf5") return open_hdf5_volume(file, request.dataset);
  if (is_tiff(file)) return open_tiff_volume(file);
  refuse_ending(file);
}

void check_finite(const GrayVolume& layers, const std::string& place) {
  const auto bad = std::find_if(layers.values.begin(), layers.values.end(),
                                [](float value) { return !std::isfinite(value); });
  if (bad == layers.values.end()) return;
  const auto before =
      static_cast<std::size_t>(layers.low[2]) * layers.index(0, 0, layers.low[2] + 1);
  refuse_volume(place, "the volume holds a value that is not finite",
                fmt::format("voxel {} in the file's order",
                            before + static_cast<std::size_t>(bad - layers.values.begin())),
                "Replace such values first.");
}

/// A spacing without a unit must fit one of m, mm, um and nm. Many programs write 1 without a unit
/// for "not known".
void check_spacing(VolumeOutline& outline, double voxel, const std::string& place) {
  const FileSpacing& spacing = outline.spacing;
  if (!spacing.edge) return;
  const auto fits = [&](double unit) { return std::abs(*spacing.edge * unit / voxel - 1) < 0.01; };
  if (spacing.unit) {
    if (fits(*spacing.unit)) return;
    refuse_volume(
        place, fmt::format("{} gives another voxel than --voxel", spacing.field),
        fmt::format("{:.6g} m in the file, {:.6g} m given", *spacing.edge * *spacing.unit, voxel),
        "Check --voxel, or correct the file.");
  }
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (fits(unit)) return;
  }
  if (*spacing.edge == 1) {
    outline.remarks.push_back(fmt::format(
        "{} is 1 without a unit, which is taken as not known: --voxel counts", spacing.field));
    return;
  }
  refuse_volume(place, fmt::format("{} gives another voxel than --voxel", spacing.field),
                fmt::format("{:.6g} in the file without a unit, {:.6g} m given; they agree in "
                            "none of m, mm, um and nm",
                            *spacing.edge, voxel),
                "Check --voxel, or correct the file.");
}

}  // namespace

std::string ending_of(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

void refuse_volume(const std::string& place, std::string problem, std::string reason,
                   std::string fix) {
  throw Error{{.place = place,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

std::unique_ptr<VolumeReader> open_volume(const VolumeRequest& request) {
  auto reader = open_by_ending(request);
  check_spacing(reader->outline, request.voxel, request.file.string());
  return reader;
}

namespace {

/// Bright and dark change places.
void invert(GrayVolume& layers) {
  for (float& value : layers.values) value = -value;
}

}  // namespace

StoredVolume read_volume(const VolumeRequest& request) {
  const auto reader = open_volume(request);
  StoredVolume stored{reader->outline, reader->read_layers(0, reader->outline.dims[2])};
  check_finite(stored.gray, request.file.string());
  if (request.invert) invert(stored.gray);
  stored.gray.voxel = request.voxel;
  return stored;
}

LoadedVolume<GrayOnDisk> load_volume(const VolumeRequest& request, const Workspace& work,
                                     const std::function<void(const GrayVolume&)>& on_layers) {
  const auto reader = open_volume(request);
  GrayOnDisk volume{reader->outline.dims, request.voxel, work.folder};
  for (const Box& slab : work.slabs(volume.dims())) {
    GrayVolume layers = reader->read_layers(slab.low[2], slab.dims[2]);
    check_finite(layers, request.file.string());
    if (request.invert) invert(layers);
    if (on_layers) on_layers(layers);
    volume.write(layers, slab);
  }
  return {std::move(volume), reader->outline.remarks};
}

LoadedVolume<LabelsOnDisk> load_labels(const VolumeRequest& request, const Workspace& work) {
  const auto reader = open_volume(request);
  LabelsOnDisk labels{reader->outline.dims, request.voxel, work.folder};
  for (const Box& slab : work.slabs(labels.dims())) {
    labels.write(to_labels(reader->read_layers(slab.low[2], slab.dims[2]), request.file.string()),
                 slab);
  }
  return {std::move(labels), reader->outline.remarks};
}

GrayVolume to_gray(const LabelVolume& labels) {
  GrayVolume gray{labels};
  for (std::size_t v = 0; v < labels.values.size(); ++v) {
    if (labels.values[v] >= most_labels) {
      refuse_volume("labels", "there are too many grains for this program", "more than 2^24",
                    "Cut the volume into parts.");
    }
    gray.values[v] = static_cast<float>(labels.values[v]);
  }
  return gray;
}

LabelVolume to_labels(const GrayVolume& volume, const std::string& place) {
  LabelVolume labels{volume};
  for (std::size_t v = 0; v < volume.values.size(); ++v) {
    const float value = volume.values[v];
    if (!(value >= 0 && value < most_labels && value == std::floor(value))) {
      refuse_volume(place, "the volume holds no labels",
                    fmt::format("{} is no whole number from 0 to 16777215", value),
                    "Leave out --labelled if it is a gray volume.");
    }
    labels.values[v] = static_cast<std::uint32_t>(value);
  }
  return labels;
}

std::vector<std::string> files_of_volume(const std::filesystem::path& file) {
  std::vector<std::string> files{file.string()};
  if (std::filesystem::is_directory(file)) return files;
  const std::string ending = ending_of(file);
  if (ending == ".raw") files.push_back(sidecar_of(file).string());
  if (const ParseHeader parse = header_parser_of(ending)) {
    for (const std::string& name : parse(beginning_of(ByteFile{file}), file.string()).data_files) {
      files.push_back((file.parent_path() / name).string());
    }
  }
  return files;
}

}  // namespace reckon
