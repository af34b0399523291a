// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "sealed_damage.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reckon/core/file.hpp"
#include "reckon/core/seal.hpp"

namespace reckon::fuzz {
namespace {

/// An HDF5 handle that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_{id}, close_{close} {
    if (id < 0) throw std::runtime_error("HDF5 refuses what it made itself");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): stands for the id

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

herr_t add_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  }
  return 0;
}

std::vector<std::string> dataset_names(hid_t file) {
  std::vector<std::string> names;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add_dataset, &names, H5O_INFO_BASIC);
  return names;
}

/// A whole dataset as bytes in its own type.
struct Content {
  std::vector<hsize_t> extents;
  std::size_t number_size{1};
  std::vector<char> bytes;
};

Content read_content(hid_t dataset) {
  const Handle space{H5Dget_space(dataset), H5Sclose};
  const Handle type{H5Dget_type(dataset), H5Tclose};
  Content content;
  content.extents.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, content.extents.data(), nullptr);
  content.number_size = H5Tget_size(type);
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  constexpr std::size_t most = 100'000'000;
  if (count > most) return content;  // claimed by an injury before
  content.bytes.resize(count * content.number_size);
  if (count > 0) H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.bytes.data());
  return content;
}

void replace_numbers(hid_t file, const std::string& name, RandomStream& random) {
  const Handle dataset{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
  const Handle type{H5Dget_type(dataset), H5Tclose};
  Content content = read_content(dataset);
  if (content.bytes.empty()) return;
  const std::size_t count = content.bytes.size() / content.number_size;
  for (std::size_t n = 1 + draw_below(random, 4); n > 0; --n) {
    char* const number = content.bytes.data() + draw_below(random, count) * content.number_size;
    if (H5Tget_class(type) == H5T_FLOAT) {
      const double nasty = draw_nasty_number(random);
      std::vector<char> buffer(sizeof(double));
      std::memcpy(buffer.data(), &nasty, sizeof(double));
      H5Tconvert(H5T_NATIVE_DOUBLE, type, 1, buffer.data(), nullptr, H5P_DEFAULT);
      std::memcpy(number, buffer.data(), content.number_size);
    } else {
      // Integers and texts: all bits set, none set, or one changed.
      const std::size_t how = draw_below(random, 3);
      const std::size_t at = draw_below(random, content.number_size);
      if (how < 2) std::fill_n(number, content.number_size, how == 0 ? '\xff' : '\0');
      if (how == 2) number[at] = static_cast<char>(number[at] ^ (1 << draw_below(random, 7)));
    }
  }
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.bytes.data());
}

/// Puts a dataset of other extents in its place, keeping the type and the unit.
void change_extents(hid_t file, const std::string& name, RandomStream& random) {
  Content content;
  hid_t type_id = -1;
  {
    const Handle dataset{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
    content = read_content(dataset);
    type_id = H5Dget_type(dataset);
  }
  const Handle type{type_id, H5Tclose};
  if (content.extents.empty()) return;
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  hsize_t& extent = content.extents[draw_below(random, content.extents.size())];
  switch (draw_below(random, 5)) {
    case 0:
      extent = 0;
      break;
    case 3:
      extent = hsize_t{1} << 34U;  // claimed, but with nothing behind
      break;
    case 4:
      extent = hsize_t{1} << 56U;
      break;
    case 1:
      extent += 1;
      break;
    default:
      extent = extent > 0 ? extent - 1 : 7;
      break;
  }
  const Handle space{
      H5Screate_simple(static_cast<int>(content.extents.size()), content.extents.data(), nullptr),
      H5Sclose};
  const Handle dataset{
      H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose};
}

void injure(const std::filesystem::path& path, RandomStream& random) {
  const Handle file{H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  for (std::size_t n = 1 + draw_below(random, 2); n > 0; --n) {
    const std::vector<std::string> names = dataset_names(file);
    if (names.empty()) return;
    const std::string& name = names[draw_below(random, names.size())];
    const std::size_t how = draw_below(random, 8);
    if (how == 0) {
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
    } else if (how == 1) {
      change_extents(file, name, random);
    } else {
      replace_numbers(file, name, random);
    }
  }
}

/// What the seal's first two lines say: "Sand Reckoner KIND", "version NUMBER".
std::pair<std::string, std::uint32_t> kind_and_version(std::string_view input) {
  constexpr std::string_view family = "Sand Reckoner ";
  const std::size_t end = input.find('\n');
  const std::string kind{input.substr(family.size(), end - family.size())};
  const std::string version{input.substr(end + 9, input.find('\n', end + 1) - end - 9)};
  return {kind, static_cast<std::uint32_t>(std::stoul(version))};
}

}  // namespace

std::string damaged_sealed_file(std::string_view input, RandomStream& random,
                                const std::filesystem::path& folder) {
  if (draw_below(random, 4) == 0) return damaged(input, random);
  const std::filesystem::path path = folder / "damaged.h5";
  std::ofstream{path, std::ios::binary} << input;
  injure(path, random);
  const auto [kind, version] = kind_and_version(input);
  write_seal(path, kind, version, path);
  return read_file(path);
}

}  // namespace reckon::fuzz
