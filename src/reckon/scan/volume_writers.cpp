// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

std::string npy_header(const VolumeOutline& what) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                  numpy_name_of(what.type), what.dims[2], what.dims[1], what.dims[0]);
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  const std::string size{static_cast<char>(header.size() & 255U),
                         static_cast<char>(header.size() >> 8U)};
  return std::string{"\x93NUMPY\x01\x00", 8} + size + header;
}

/// A header, then the numbers. What belongs beside the file comes before it.
class PlainWriter : public VolumeWriter {
 public:
  PlainWriter(const std::filesystem::path& file, VoxelType type, const std::string& header,
              std::string sidecar = {})
      : pending_{file},
        file_{pending_.temporary(), O_WRONLY | O_CREAT | O_TRUNC, file},
        type_{type},
        sidecar_{std::move(sidecar)} {
    put(header);
  }

  void write_layers(const GrayVolume& layers) override {
    put(encode_numbers(layers.values, type_));
  }
  void finish() override {
    file_.close();
    if (!sidecar_.empty()) write_file(sidecar_of(pending_.target()), sidecar_);
    pending_.commit();
  }

 private:
  void put(const std::string& bytes) {
    file_.write(written_, bytes);
    written_ += bytes.size();
  }

  PendingFile pending_;
  OpenFile file_;
  std::uint64_t written_{0};  // [bytes]
  VoxelType type_;
  std::string sidecar_;
};

}  // namespace

void refuse_unwritten(const std::filesystem::path& file) {
  throw_write_failure(file, errno, "the volume could not be written");
}

void LayerRecord::add(std::string_view bytes) { hash_.update(bytes); }

void LayerRecord::compare(const VolumeOutline& what, const std::filesystem::path& named,
                          const std::function<std::unique_ptr<VolumeReader>()>& open) const {
  XxHash64 found;
  std::string fault;
  try {
    const auto reader = open();
    const VolumeOutline& found_outline = reader->outline;
    const std::optional<double> edge = found_outline.spacing.edge;
    const bool same_voxel = !edge || edge == what.spacing.edge;
    if (found_outline.dims != what.dims || found_outline.type != what.type || !same_voxel) {
      fault = "its header";
    }
    for (std::int32_t layer = 0; fault.empty() && layer < what.dims[2]; ++layer) {
      found.update(encode_numbers(reader->read_layers(layer, 1).values, what.type));
    }
    if (fault.empty() && found.digest() != hash_.digest()) fault = "its numbers";
  } catch (const Error& error) {
    fault = error.text().problem;
  }
  if (fault.empty()) return;
  throw_write_failure(named, 0,
                      "the volume could not be written, as reading it back shows: " + fault);
}

std::filesystem::path sidecar_of(const std::filesystem::path& file) {
  return file.string() + ".txt";
}

std::unique_ptr<VolumeWriter> create_volume(const std::filesystem::path& file,
                                            const VoxelDims& dims, double voxel, VoxelType type) {
  const std::string ending = ending_of(file);
  const VolumeOutline what{dims, type, {voxel, 1.0, {}}, {}};
  const auto plain = [&](const std::string& header) {
    return std::make_unique<PlainWriter>(file, type, header);
  };
  if (ending == ".npy") return plain(npy_header(what));
  if (ending == ".mha") return plain(metaimage_header(what));
  if (ending == ".nrrd") return plain(nrrd_header(what));
  if (ending == ".h5" || ending == ".hdf5") return create_hdf5_volume(file, what);
  if (ending == ".tif" || ending == ".tiff") return create_tiff_volume(file, what);
  if (ending == ".raw") {
    return std::make_unique<PlainWriter>(file, type, "",
                                         fmt::format("dims {} {} {}\ntype {}\norder little\n",
                                                     dims[0], dims[1], dims[2], name_of(type)));
  }
  refuse_volume(file, "this kind of file is not written as a volume",
                fmt::format("its name ends in \"{}\"", file.extension().string()),
                "Give .h5, .npy, .raw, .mha, .nrrd or .tif.");
}

void write_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type) {
  const auto writer = create_volume(file, volume.dims, volume.voxel, type);
  writer->write_layers(volume);
  writer->finish();
}

}  // namespace reckon
