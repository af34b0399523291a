// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/hdf5_handle.hpp"
#include "reckon/core/hdf5_parts.hpp"
#include "reckon/core/seal.hpp"
#include "reckon/core/write_failure.hpp"

namespace reckon {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, std::string problem) {
  throw Error{{.place = path.string(), .problem = std::move(problem), .reason = {}, .fix = {}}};
}

Hdf5Handle create_dataset(hid_t file, const std::string& name, hid_t type,
                          const Hdf5Extents& extents) {
  const std::vector<hsize_t> dims(extents.begin(), extents.end());
  const Hdf5Handle space{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                         H5Sclose};
  const Hdf5Handle links{H5Pcreate(H5P_LINK_CREATE), H5Pclose};
  H5Pset_create_intermediate_group(links.get(), 1);
  // Times of creation would make equal libraries differ in their bytes.
  const Hdf5Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_obj_track_times(creation.get(), false);
  return {
      H5Dcreate2(file, name.c_str(), type, space.get(), links.get(), creation.get(), H5P_DEFAULT),
      H5Dclose};
}

/// How files are opened for writing: no dataset waits in the library's buffer for small ones, where
/// a failure would only show when the dataset is closed, and closing the file closes all in it.
Hdf5Handle careful_access() {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_sieve_buf_size(access, 0);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  return {access, H5Pclose};
}

std::string_view bytes_of(const void* values, std::uint64_t size) {
  return {static_cast<const char*>(values), size};
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& target, Hdf5Kind kind)
    : pending_{target}, kind_{std::move(kind)} {
  const QuietHdf5 quiet;
  const Hdf5Handle creation{H5Pcreate(H5P_FILE_CREATE), H5Pclose};
  H5Pset_userblock(creation.get(), seal_size);
  H5Pset_obj_track_times(creation.get(), false);
  const Hdf5Handle access = careful_access();
  file_ = H5Fcreate(pending_.temporary().c_str(), H5F_ACC_TRUNC, creation.get(), access.get());
  require(file_ >= 0, "cannot be written");
}

Hdf5Writer::~Hdf5Writer() {
  const QuietHdf5 quiet;
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::require(bool written, const std::string& what) const {
  if (!written) throw_write_failure(pending_.target(), hdf5_error_number(), what);
}

void Hdf5Writer::write_text_attribute(std::int64_t object, const std::string& object_name,
                                      const std::string& name, std::string_view text) {
  const Hdf5Handle type = hdf5_text_type(text.size());
  const Hdf5Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  Hdf5Handle attribute{
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose};
  std::string padded{text};
  if (padded.empty()) padded.push_back('\0');
  const bool written =
      attribute.valid() && H5Awrite(attribute.get(), type.get(), padded.data()) >= 0;
  require(written && attribute.close(), "note " + name + " could not be written");
  record_.add_text(object_name, name, padded);
}

void Hdf5Writer::create(const std::string& name, Hdf5Number type, const Hdf5Extents& extents,
                        std::string_view unit) {
  const QuietHdf5 quiet;
  Hdf5Handle dataset = create_dataset(file_, name, hdf5_native_type(type), extents);
  const std::string problem = "dataset " + name + " could not be created";
  require(dataset.valid(), problem);
  write_text_attribute(dataset.get(), name, "unit", unit);
  require(dataset.close(), problem);
  record_.add_dataset(name, type, extents);
}

void Hdf5Writer::write_raw(const std::string& name, std::uint64_t first, Hdf5Number type,
                           const void* values, std::uint64_t count) {
  const QuietHdf5 quiet;
  Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) refuse(pending_.target(), "dataset " + name + " does not exist");
  const Hdf5Rows rows = hdf5_rows(dataset.get(), first, count);
  if (!rows.good) {
    refuse(pending_.target(),
           fmt::format("dataset {} has no room for {} numbers from row {} on", name, count, first));
  }
  const bool written =
      count == 0 || H5Dwrite(dataset.get(), hdf5_native_type(type), rows.memory_space.get(),
                             rows.file_space.get(), H5P_DEFAULT, values) >= 0;
  require(written && dataset.close(), "dataset " + name + " could not be written");
  record_.add_rows(name, first, bytes_of(values, count * H5Tget_size(hdf5_native_type(type))));
}

void Hdf5Writer::write_texts(const std::string& name, const std::vector<std::string>& texts) {
  const QuietHdf5 quiet;
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  if (width > longest_hdf5_text) refuse(pending_.target(), "a text of " + name + " is too long");
  std::string packed(width * texts.size(), '\0');
  for (std::size_t t = 0; t < texts.size(); ++t) {
    std::copy(texts[t].begin(), texts[t].end(),
              packed.begin() + static_cast<std::ptrdiff_t>(t * width));
  }
  const std::string problem = "dataset " + name + " could not be written";
  const Hdf5Handle type = hdf5_text_type(width);
  Hdf5Handle dataset = create_dataset(file_, name, type.get(), {texts.size()});
  require(dataset.valid(), problem);
  write_text_attribute(dataset.get(), name, "unit", "text");
  const bool written = texts.empty() || H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL,
                                                 H5P_DEFAULT, packed.data()) >= 0;
  require(written && dataset.close(), problem);
  record_.add_dataset(name, std::nullopt, {texts.size()});
  record_.add_rows(name, 0, packed);
}

void Hdf5Writer::write_note(const std::string& name, const std::string& text) {
  const QuietHdf5 quiet;
  const Hdf5Handle root{H5Gopen2(file_, "/", H5P_DEFAULT), H5Gclose};
  write_text_attribute(root.get(), "/", name, text);
}

void Hdf5Writer::finish() {
  const QuietHdf5 quiet;
  require(H5Fclose(std::exchange(file_, -1)) >= 0, "could not be written");
  record_.compare(pending_.temporary(), pending_.target());
  write_seal(pending_.temporary(), kind_.name, kind_.version, pending_.target());
  pending_.commit();
}

}  // namespace reckon
