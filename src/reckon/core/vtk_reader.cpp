// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/vtk_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"

namespace reckon {
namespace {

constexpr std::array<std::pair<std::string_view, VtkSection>, 7> sections{{
    {"FieldData", VtkSection::field_data},
    {"PointData", VtkSection::point_data},
    {"CellData", VtkSection::cell_data},
    {"Points", VtkSection::points},
    {"Verts", VtkSection::verts},
    {"Lines", VtkSection::lines},
    {"Polys", VtkSection::polys},
}};

/// The value of name="value" in a tag, unchanged.
std::string_view attribute(std::string_view tag, const std::string& name) {
  const std::string start = " " + name + "=\"";
  const std::size_t at = tag.find(start);
  if (at == std::string_view::npos) return {};
  const std::size_t first = at + start.size();
  const std::size_t end = tag.find('"', first);
  return end == std::string_view::npos ? std::string_view{} : tag.substr(first, end - first);
}

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 4> names{
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}}};
  std::string out;
  while (!text.empty()) {
    const auto* found = std::find_if(
        names.begin(), names.end(), [&](const auto& name) { return text.starts_with(name.first); });
    out += found == names.end() ? text.front() : found->second;
    text.remove_prefix(found == names.end() ? 1 : found->first.size());
  }
  return out;
}

bool parse(std::string_view text, std::uint64_t& number) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  return code == std::errc{} && end == text.data() + text.size();
}

template <class Number>
std::vector<double> converted(std::string_view bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(Number));
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    Number number;
    std::memcpy(&number, bytes.data() + n * sizeof number, sizeof number);
    numbers[n] = static_cast<double>(number);
  }
  return numbers;
}

struct NumberType {
  std::string_view name;
  std::size_t size;
  std::vector<double> (*convert)(std::string_view bytes);
};

template <class Number>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(Number), converted<Number>};
}

constexpr std::array number_types{
    number_type<float>("Float32"),      number_type<double>("Float64"),
    number_type<std::int8_t>("Int8"),   number_type<std::uint8_t>("UInt8"),
    number_type<std::int16_t>("Int16"), number_type<std::uint16_t>("UInt16"),
    number_type<std::int32_t>("Int32"), number_type<std::uint32_t>("UInt32"),
    number_type<std::int64_t>("Int64"), number_type<std::uint64_t>("UInt64")};

const NumberType* type_named(std::string_view name) {
  const auto* found = std::find_if(number_types.begin(), number_types.end(),
                                   [&](const NumberType& type) { return type.name == name; });
  return found == number_types.end() ? nullptr : found;
}

}  // namespace

VtkReader::VtkReader(std::filesystem::path path)
    : path_{std::move(path)}, content_{read_file(path_)} {
  const std::string_view content = content_;
  constexpr std::string_view opening = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t end = content.find(opening);
  if (end == std::string_view::npos) refuse("it has no raw appended data");
  std::string_view text = content.substr(0, end);
  bool known_layout = false;
  while (true) {
    const std::size_t open = text.find('<');
    if (open == std::string_view::npos) break;
    const std::size_t close = text.find('>', open);
    if (close == std::string_view::npos) refuse("a tag is not closed");
    const std::string_view tag = text.substr(open + 1, close - open - 1);
    if (tag.starts_with("VTKFile ")) {
      known_layout =
          attribute(tag, "type") == "PolyData" && attribute(tag, "byte_order") == "LittleEndian" &&
          attribute(tag, "header_type") == "UInt64" && attribute(tag, "compressor").empty();
    }
    read_tag(tag, end + opening.size());
    text.remove_prefix(close + 1);
  }
  if (!known_layout) {
    refuse("only uncompressed little-endian PolyData with 64-bit headers is read");
  }
}

void VtkReader::read_tag(std::string_view tag, std::size_t data) {
  for (const auto& [name, section] : sections) {
    if (tag == name) section_ = section;
  }
  if (!tag.starts_with("DataArray ")) return;
  Array array{
      section_, unescaped(attribute(tag, "Name")), std::string{attribute(tag, "type")}, 1, {}};
  const NumberType* type = type_named(array.type);
  if (type == nullptr) refuse(fmt::format("array \"{}\" has no known type", array.name));
  std::uint64_t components = 1;
  std::uint64_t offset = 0;
  const std::string_view width = attribute(tag, "NumberOfComponents");
  if ((!width.empty() && !parse(width, components)) || components < 1 || components > 9) {
    refuse(fmt::format("array \"{}\" has an odd number of components", array.name));
  }
  if (!parse(attribute(tag, "offset"), offset)) {
    refuse(fmt::format("array \"{}\" has no offset", array.name));
  }
  array.components = static_cast<std::uint32_t>(components);
  array.bytes = appended(data, offset);
  if (array.bytes.size() % (type->size * components) != 0) {
    refuse(fmt::format("array \"{}\" ends within a tuple", array.name));
  }
  arrays_.push_back(std::move(array));
}

std::string_view VtkReader::appended(std::size_t data, std::uint64_t offset) const {
  const std::string_view rest = std::string_view{content_}.substr(data);
  std::uint64_t length = 0;
  if (offset > rest.size() || rest.size() - offset < sizeof length) refuse("it is cut short");
  std::memcpy(&length, rest.data() + offset, sizeof length);
  const std::string_view block = rest.substr(offset + sizeof length);
  if (length > block.size()) refuse("it is cut short");
  return block.substr(0, length);
}

const VtkReader::Array* VtkReader::find(VtkSection section, std::string_view name) const {
  for (const Array& array : arrays_) {
    if (array.section == section && array.name == name) return &array;
  }
  return nullptr;
}

bool VtkReader::has(VtkSection section, std::string_view name) const {
  return find(section, name) != nullptr;
}

std::size_t VtkReader::tuples(VtkSection section, std::string_view name) const {
  const Array* array = find(section, name);
  if (array == nullptr) return 0;
  return array->bytes.size() / (type_named(array->type)->size * array->components);
}

std::vector<double> VtkReader::numbers(VtkSection section, std::string_view name,
                                       std::uint32_t components, std::size_t expected) const {
  const Array* array = find(section, name);
  if (array == nullptr) refuse(fmt::format("it has no array \"{}\"", name));
  if (array->components != components || tuples(section, name) != expected) {
    refuse(fmt::format("array \"{}\" has {} tuples of {} where {} of {} are needed", name,
                       tuples(section, name), array->components, expected, components));
  }
  return type_named(array->type)->convert(array->bytes);
}

void VtkReader::refuse(const std::string& reason) const {
  throw Error{{.place = path_.string(),
               .problem = "this file of fields cannot be read",
               .reason = reason,
               .fix = {}}};
}

}  // namespace reckon
