// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <fstream>
#include <string>
#include <utility>

#include "reckon/core/file.hpp"
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
        stream_{pending_.temporary(), std::ios::binary},
        type_{type},
        sidecar_{std::move(sidecar)} {
    put(header);
  }

  void write_layers(const GrayVolume& layers) override {
    put(encode_numbers(layers.values, type_));
  }
  void finish() override {
    stream_.close();
    check();
    if (!sidecar_.empty()) write_file(sidecar_of(pending_.target()), sidecar_);
    pending_.commit();
  }

 private:
  void put(const std::string& bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    check();
  }
  void check() const {
    if (!stream_) refuse_unwritten(pending_.target());
  }

  PendingFile pending_;
  std::ofstream stream_;
  VoxelType type_;
  std::string sidecar_;
};

}  // namespace

void refuse_unwritten(const std::filesystem::path& file) {
  refuse_volume(file, "the volume could not be written", {},
                "Check the folder's permissions and the free space.");
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
