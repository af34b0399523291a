// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/piece.hpp"

#include <zlib.h>

#include <bit>
#include <cstring>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays go out as they lie in memory");

constexpr std::size_t alignment = 8;  // of the widest numbers
constexpr int compression = 6;

std::string deflated(const std::string& plain) {
  uLongf size = ::compressBound(plain.size());
  std::string packed(size, '\0');
  const int code =
      ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(plain.data()), plain.size(), compression);
  if (code != Z_OK) {
    throw Error{{.place = "the report's data",
                 .problem = "cannot be compressed",
                 .reason = ::zError(code),
                 .fix = {}}};
  }
  packed.resize(size);
  return packed;
}

}  // namespace

void Piece::add_bytes(const std::string& name, std::string_view type, std::uint32_t components,
                      std::size_t count, std::string_view bytes) {
  bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment, '\0');
  arrays_.push_back({name, type, components, bytes_.size(), count});
  bytes_ += bytes;
}

std::string Piece::finish() {
  json_.begin_array("arrays");
  for (const Array& array : arrays_) {
    json_.begin_object();
    json_.value("name", array.name);
    json_.value("type", array.type);
    json_.value("components", array.components);
    json_.value("offset", array.offset);
    json_.value("count", array.count);
    json_.end();
  }
  json_.end();
  json_.end();
  std::string text = json_.text();
  while ((sizeof(std::uint32_t) + text.size()) % alignment != 0) text += ' ';
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string plain(sizeof length, '\0');
  std::memcpy(plain.data(), &length, sizeof length);
  return deflated(plain + text + bytes_);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t left = std::min<std::size_t>(bytes.size() - at, 3);
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      group = group << 8U | (n < left ? static_cast<unsigned char>(bytes[at + n]) : 0U);
    }
    for (std::size_t n = 0; n < 4; ++n) {
      text += n <= left ? digits[group >> (18 - 6 * n) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace reckon
