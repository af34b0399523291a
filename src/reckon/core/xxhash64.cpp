// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/xxhash64.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "reckon/core/file.hpp"

namespace reckon {
namespace {

static_assert(std::endian::native == std::endian::little, "words are read as they lie in memory");

// The five primes of the specification.
constexpr std::uint64_t prime_1 = 0x9E3779B185EBCA87;
constexpr std::uint64_t prime_2 = 0xC2B2AE3D27D4EB4F;
constexpr std::uint64_t prime_3 = 0x165667B19E3779F9;
constexpr std::uint64_t prime_4 = 0x85EBCA77C2B2AE63;
constexpr std::uint64_t prime_5 = 0x27D4EB2F165667C5;
constexpr std::size_t stripe_size = 32;

template <class Word>
Word load(const std::byte* from) {
  Word word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

std::uint64_t mix(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * prime_2, 31) * prime_1;
}

void absorb(std::array<std::uint64_t, 4>& lanes, const std::byte* stripe) {
  for (std::size_t l = 0; l < 4; ++l) lanes[l] = mix(lanes[l], load<std::uint64_t>(stripe + 8 * l));
}

}  // namespace

XxHash64::XxHash64(std::uint64_t seed)
    : seed_{seed}, lanes_{seed + prime_1 + prime_2, seed + prime_2, seed, seed - prime_1} {}

void XxHash64::update(std::span<const std::byte> bytes) {
  const std::size_t held = size_ % stripe_size;
  size_ += bytes.size();
  if (held > 0) {
    const std::size_t taken = std::min(bytes.size(), stripe_size - held);
    std::copy_n(bytes.begin(), taken, pending_.begin() + static_cast<std::ptrdiff_t>(held));
    bytes = bytes.subspan(taken);
    if (held + taken < stripe_size) return;
    absorb(lanes_, pending_.data());
  }
  for (; bytes.size() >= stripe_size; bytes = bytes.subspan(stripe_size)) {
    absorb(lanes_, bytes.data());
  }
  std::copy(bytes.begin(), bytes.end(), pending_.begin());
}

std::uint64_t XxHash64::digest() const {
  std::uint64_t hash = seed_ + prime_5;
  if (size_ >= stripe_size) {
    hash = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) +
           std::rotl(lanes_[3], 18);
    for (const std::uint64_t lane : lanes_) hash = (hash ^ mix(0, lane)) * prime_1 + prime_4;
  }
  hash += size_;
  const std::byte* next = pending_.data();
  const std::byte* const end = next + size_ % stripe_size;
  for (; end - next >= 8; next += 8) {
    hash = std::rotl(hash ^ mix(0, load<std::uint64_t>(next)), 27) * prime_1 + prime_4;
  }
  if (end - next >= 4) {
    hash = std::rotl(hash ^ (load<std::uint32_t>(next) * prime_1), 23) * prime_2 + prime_3;
    next += 4;
  }
  for (; next < end; ++next) {
    hash = std::rotl(hash ^ (std::to_integer<std::uint64_t>(*next) * prime_5), 11) * prime_1;
  }
  hash = (hash ^ (hash >> 33)) * prime_2;
  hash = (hash ^ (hash >> 29)) * prime_3;
  return hash ^ (hash >> 32);
}

std::uint64_t hash_file(const OpenFile& file, std::uint64_t offset, XxHash64& hash) {
  std::vector<char> buffer(1 << 20);
  while (const std::size_t count = file.read(offset, buffer)) {
    hash.update(std::string_view{buffer.data(), count});
    offset += count;
  }
  return offset;
}

}  // namespace reckon
