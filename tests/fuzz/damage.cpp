// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "damage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace reckon::fuzz {
namespace {

using namespace std::string_view_literals;  // their lengths count NULs

using Injury = void (*)(std::string&, RandomStream&);

/// A piece [first, first + count) of a text.
struct Piece {
  std::size_t first;
  std::size_t count;
};

/// Mostly short, at times anything up to the whole.
Piece draw_piece(const std::string& text, RandomStream& random) {
  if (text.empty()) return {0, 0};
  const std::size_t first = draw_below(random, text.size());
  const std::size_t rest = text.size() - first;
  const std::size_t longest = draw_below(random, 4) == 0 ? rest : std::min<std::size_t>(rest, 32);
  return {first, 1 + draw_below(random, longest)};
}

void flip_bit(std::string& text, RandomStream& random) {
  if (text.empty()) return;
  const std::size_t at = draw_below(random, text.size());
  const auto mask = static_cast<unsigned char>(1U << draw_below(random, 8));
  text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ mask);
}

void replace_byte(std::string& text, RandomStream& random) {
  if (text.empty()) return;
  constexpr std::string_view telling = "\0\n\r\t \"'#,.:;=-+/[]{}019eE\x7f\x80\xff"sv;
  text[draw_below(random, text.size())] = telling[draw_below(random, telling.size())];
}

void cut_end(std::string& text, RandomStream& random) {
  text.resize(draw_below(random, text.size() + 1));
}

void lose_piece(std::string& text, RandomStream& random) {
  const Piece piece = draw_piece(text, random);
  text.erase(piece.first, piece.count);
}

void double_piece(std::string& text, RandomStream& random) {
  const Piece piece = draw_piece(text, random);
  const std::string copy = text.substr(piece.first, piece.count);
  text.insert(draw_below(random, text.size() + 1), copy);
}

void insert_run(std::string& text, RandomStream& random) {
  constexpr std::string_view fillers = "\0 \n9[{(\"-.a"sv;
  constexpr std::array<std::size_t, 5> lengths{1, 2, 17, 300, 5000};
  const std::size_t at = draw_below(random, text.size() + 1);
  const std::size_t length = lengths[draw_below(random, lengths.size())];
  text.insert(at, length, fillers[draw_below(random, fillers.size())]);
}

/// Pieces of `text` between characters that `separates` accepts; none is empty.
template <class Separates>
std::vector<Piece> split(const std::string& text, Separates separates) {
  std::vector<Piece> pieces;
  std::size_t first = 0;
  for (std::size_t at = 0; at <= text.size(); ++at) {
    if (at < text.size() && !separates(text[at])) continue;
    if (at > first) pieces.push_back({first, at - first});
    first = at + 1;
  }
  return pieces;
}

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_newline(char c) { return c == '\n'; }
bool ends_number(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) == 0 &&
         std::string_view{"+-.eE"}.find(c) == std::string_view::npos;
}

template <class Separates>
void swap_pieces(std::string& text, RandomStream& random, Separates separates) {
  const std::vector<Piece> pieces = split(text, separates);
  if (pieces.size() < 2) return;
  Piece a = pieces[draw_below(random, pieces.size())];
  Piece b = pieces[draw_below(random, pieces.size())];
  if (a.first == b.first) return;
  if (a.first > b.first) std::swap(a, b);
  const std::string left = text.substr(a.first, a.count);
  const std::string right = text.substr(b.first, b.count);
  text.replace(b.first, b.count, left);  // the later one first: the earlier keeps its place
  text.replace(a.first, a.count, right);
}

void swap_words(std::string& text, RandomStream& random) { swap_pieces(text, random, is_space); }
void swap_lines(std::string& text, RandomStream& random) { swap_pieces(text, random, is_newline); }

void replace_number(std::string& text, RandomStream& random) {
  constexpr std::array<std::string_view, 30> nasty{"0",
                                                   "-0.0",
                                                   "1",
                                                   "-1",
                                                   "2",
                                                   "255",
                                                   "256",
                                                   "65535",
                                                   "65536",
                                                   "2147483647",
                                                   "2147483648",
                                                   "-2147483648",
                                                   "4294967295",
                                                   "4294967296",
                                                   "9223372036854775807",
                                                   "9223372036854775808",
                                                   "18446744073709551615",
                                                   "18446744073709551616",
                                                   "1e-320",
                                                   "1e-30",
                                                   "1e30",
                                                   "1e308",
                                                   "1e400",
                                                   "-1e400",
                                                   "nan",
                                                   "-nan",
                                                   "inf",
                                                   "-inf",
                                                   "0x7fffffff",
                                                   "1_000"};
  const std::vector<Piece> numbers = split(text, ends_number);
  if (numbers.empty()) return;
  const Piece number = numbers[draw_below(random, numbers.size())];
  text.replace(number.first, number.count, nasty[draw_below(random, nasty.size())]);
}

/// Writes over 1, 2, 4 or 8 bytes, in either byte order: lengths, counts, indices, coordinates.
void replace_binary_number(std::string& text, RandomStream& random) {
  const std::size_t width = std::size_t{1} << draw_below(random, 4);
  if (text.size() < width) return;
  constexpr std::array<std::uint64_t, 16> nasty{
      0,          1,          2,           0x7f,
      0x80,       0xff,       0x7fff,      0x8000,
      0xffff,     0x7fffffff, 0x80000000,  0xffffffff,
      0x10000000, 0x40000000, 0x100000000, ~std::uint64_t{0}};
  std::uint64_t bits = nasty[draw_below(random, nasty.size())];
  if (draw_below(random, 2) == 0) {
    const double number = draw_nasty_number(random);
    bits = width == 4 ? std::bit_cast<std::uint32_t>(static_cast<float>(number))
                      : std::bit_cast<std::uint64_t>(number);
  }
  std::array<char, 8> bytes{};
  for (std::size_t n = 0; n < width; ++n) {
    bytes[n] = static_cast<char>(static_cast<unsigned char>(bits >> (8 * n)));
  }
  if (draw_below(random, 4) == 0)
    std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(width));
  std::memcpy(text.data() + draw_below(random, text.size() - width + 1), bytes.data(), width);
}

}  // namespace

std::size_t draw_below(RandomStream& random, std::size_t size) {
  return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(size)), size - 1);
}

double draw_nasty_number(RandomStream& random) {
  using Limits = std::numeric_limits<double>;
  constexpr std::array<double, 18> nasty{0.0,
                                         -0.0,
                                         1.0,
                                         -1.0,
                                         0.5,
                                         1e-12,
                                         -1e-12,
                                         1e12,
                                         -1e12,
                                         2147483647.0,
                                         4294967296.0,
                                         0x1p63,
                                         Limits::max(),
                                         Limits::lowest(),
                                         Limits::denorm_min(),
                                         Limits::infinity(),
                                         -Limits::infinity(),
                                         Limits::quiet_NaN()};
  return nasty[draw_below(random, nasty.size())];
}

std::string damaged(std::string_view input, RandomStream& random) {
  constexpr std::array<Injury, 11> injuries{
      flip_bit,   replace_byte, cut_end,  lose_piece,     double_piece,         insert_run,
      swap_words, swap_lines,   flip_bit, replace_number, replace_binary_number};
  std::string text{input};
  const std::size_t count = std::size_t{1} << draw_below(random, 4);
  for (std::size_t n = 0; n < count; ++n) {
    injuries[draw_below(random, injuries.size())](text, random);
  }
  return text;
}

}  // namespace reckon::fuzz
