// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/slice_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

constexpr std::size_t most_listed = 12;
constexpr std::size_t most_digits = 18;  // that an integer of 64 bits holds

/// A number in a name. With a decimal point, `value` counts units of its last digit.
struct Number {
  std::string digits;  ///< as written
  bool negative{false};
  std::int64_t value{0};
};

/// A name, divided into numbers and the texts between them: one text more than numbers.
struct Name {
  std::filesystem::path file;
  std::vector<std::string> texts;
  std::vector<Number> numbers;

  /// The texts with a mark for each number. Names of one series have the same.
  [[nodiscard]] std::string skeleton() const {
    std::string all;
    for (std::size_t n = 0; n < texts.size(); ++n) all += (n > 0 ? "#" : "") + texts[n];
    return all;
  }
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

Name cut(const std::filesystem::path& file) {
  Name name{file, {""}, {}};
  const std::string stem = file.stem().string();
  for (std::size_t at = 0; at < stem.size();) {
    if (!is_digit(stem[at])) {
      name.texts.back() += stem[at++];
      continue;
    }
    std::size_t end = at;
    while (end < stem.size() && is_digit(stem[end])) ++end;
    name.numbers.push_back({stem.substr(at, end - at)});
    name.texts.emplace_back();
    at = end;
  }
  return name;
}

std::set<std::string> skeletons_of(const std::vector<Name>& names) {
  std::set<std::string> skeletons;
  for (const Name& name : names) skeletons.insert(name.skeleton());
  return skeletons;
}

bool ends_in_sign(const std::string& text) { return text.ends_with('-') || text.ends_with('+'); }

/// Takes signs before numbers as such where they cannot be hyphens between words.
void take_signs(std::vector<Name>& names) {
  std::vector<Name> signless = names;
  for (Name& name : signless) {
    for (std::size_t n = 0; n < name.numbers.size(); ++n) {
      std::string& text = name.texts[n];
      if (!ends_in_sign(text)) continue;
      name.numbers[n].negative = text.back() == '-';
      text.pop_back();
    }
  }
  const bool some_have_none = skeletons_of(names).size() > 1 && skeletons_of(signless).size() == 1;
  const auto follows_gap = [](const Name& name) {
    for (std::size_t n = 0; n < name.numbers.size(); ++n) {
      const std::string& text = name.texts[n];
      if (!ends_in_sign(text)) continue;
      if (text.size() > 1 &&
          std::string_view{" _="}.find(text[text.size() - 2]) != std::string_view::npos) {
        return true;
      }
    }
    return false;
  };
  if (some_have_none || std::all_of(names.begin(), names.end(), follows_gap)) {
    names = std::move(signless);
  }
}

/// Whether a number is the same in all names.
bool is_constant(const std::vector<Name>& names, std::size_t number) {
  return std::all_of(names.begin(), names.end(), [&](const Name& name) {
    return name.numbers[number].digits == names.front().numbers[number].digits &&
           name.numbers[number].negative == names.front().numbers[number].negative;
  });
}

std::string name_of(const Name& name) { return name.file.filename().string(); }

[[noreturn]] void refuse(const std::string& folder, std::string problem, std::string reason,
                         std::string fix) {
  refuse_volume(folder, std::move(problem), std::move(reason), std::move(fix));
}

/// Two numbers with a point between become one where the whole part varies.
void take_decimals(std::vector<Name>& names, const std::string& folder) {
  for (std::size_t n = 0; n + 1 < names.front().numbers.size(); ++n) {
    if (names.front().texts[n + 1] != "." || is_constant(names, n + 1)) continue;
    const std::size_t places = names.front().numbers[n + 1].digits.size();
    for (const Name& name : names) {
      if (name.numbers[n + 1].digits.size() == places) continue;
      refuse(folder, "the order of the slices is not clear",
             fmt::format("{} and {} have decimals of different length", name_of(names.front()),
                         name_of(name)),
             "Give all numbers the same count of decimals, or number the files from 1.");
    }
    if (is_constant(names, n)) continue;
    for (Name& name : names) {
      name.numbers[n].digits += name.numbers[n + 1].digits;
      const auto at = static_cast<std::ptrdiff_t>(n + 1);
      name.numbers.erase(name.numbers.begin() + at);
      name.texts.erase(name.texts.begin() + at);
    }
  }
}

/// Names, the first few of them, with the count of the rest.
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), most_listed); ++n) {
    text += (n > 0 ? ", " : "") + names[n];
  }
  if (names.size() > most_listed) text += fmt::format(" and {} more", names.size() - most_listed);
  return text;
}

[[noreturn]] void refuse_series(const std::vector<Name>& names, const std::string& folder,
                                const std::map<std::string, std::vector<std::string>>& series) {
  std::vector<std::string> parts;
  parts.reserve(series.size());
  for (const auto& [key, members] : series) {
    parts.push_back(members.size() == 1 ? members.front()
                                        : fmt::format("{} to {} ({} files)", members.front(),
                                                      members.back(), members.size()));
  }
  refuse(folder, fmt::format("the folder holds {} series of slices", series.size()),
         fmt::format("{} files: {}", names.size(), listed(parts)),
         "Leave one series in the folder: move the other files away.");
}

void require_one_series(const std::vector<Name>& names, const std::string& folder) {
  std::map<std::string, std::vector<std::string>> series;
  for (const Name& name : names) series[name.skeleton()].push_back(name_of(name));
  if (series.size() > 1) refuse_series(names, folder, series);
}

void evaluate(std::vector<Name>& names, const std::string& folder) {
  for (Name& name : names) {
    for (Number& number : name.numbers) {
      if (number.digits.size() > most_digits) {
        refuse(folder, "a number in a slice's name is too long", name_of(name),
               "Number the files from 1.");
      }
      for (const char digit : number.digits) number.value = 10 * number.value + (digit - '0');
      if (number.negative) number.value = -number.value;
    }
  }
}

/// The number that counts the slices: the last that varies. Any other must give the same order.
std::size_t counter_of(std::vector<Name>& names, const std::string& folder) {
  std::vector<std::size_t> varying;
  for (std::size_t n = 0; n < names.front().numbers.size(); ++n) {
    if (!is_constant(names, n)) varying.push_back(n);
  }
  if (varying.empty()) return names.front().numbers.empty() ? 0 : names.front().numbers.size() - 1;
  const std::size_t counter = varying.back();
  std::stable_sort(names.begin(), names.end(), [&](const Name& a, const Name& b) {
    return a.numbers[counter].value < b.numbers[counter].value;
  });
  for (const std::size_t other : varying) {
    if (other == counter) continue;
    const bool same_order =
        std::is_sorted(names.begin(), names.end(), [&](const Name& a, const Name& b) {
          return a.numbers[other].value < b.numbers[other].value;
        });
    if (same_order) continue;
    std::map<std::string, std::vector<std::string>> series;
    for (const Name& name : names) series[name.numbers[other].digits].push_back(name_of(name));
    refuse_series(names, folder, series);
  }
  return counter;
}

/// A name as it would be with another number.
std::string renumbered(const Name& name, std::size_t counter, std::int64_t value) {
  std::string text;
  for (std::size_t n = 0; n < name.numbers.size(); ++n) {
    const Number& number = name.numbers[n];
    text += name.texts[n];
    text += n != counter      ? number.digits
            : number.negative ? std::to_string(value)
                              : fmt::format("{:0{}}", value, number.digits.size());
  }
  return text + name.texts.back();
}

void require_no_twins(const std::vector<Name>& names, std::size_t counter,
                      const std::string& folder) {
  const auto twin =
      std::adjacent_find(names.begin(), names.end(), [&](const Name& a, const Name& b) {
        return a.numbers.empty() || a.numbers[counter].value == b.numbers[counter].value;
      });
  if (twin == names.end()) return;
  refuse(folder, "two slices have the same number",
         fmt::format("{} and {}", name_of(*twin), name_of(*(twin + 1))),
         "Leave one of them in the folder.");
}

/// The step between the numbers. Throws Error with the names of those that are missing. Numbers
/// that were rounded, such as places in micrometres, may differ by one in their steps.
std::int64_t step_of(const std::vector<Name>& names, std::size_t counter,
                     const std::string& folder) {
  std::vector<std::int64_t> steps;
  for (std::size_t n = 1; n < names.size(); ++n) {
    steps.push_back(names[n].numbers[counter].value - names[n - 1].numbers[counter].value);
  }
  if (steps.empty()) return 1;
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  constexpr std::int64_t steps_are_rounded = 10;
  if (*most == *least || (*least >= steps_are_rounded && *most <= *least + 1)) return *least;
  std::vector<std::string> missing;
  std::int64_t count = 0;
  for (std::size_t n = 1; n < names.size(); ++n) {
    const std::int64_t before = names[n - 1].numbers[counter].value;
    const std::int64_t absent = (steps[n - 1] - 1) / *least;
    count += absent;
    for (std::int64_t m = 1; m <= absent && missing.size() < most_listed; ++m) {
      missing.push_back(renumbered(names[n - 1], counter, before + m * *least));
    }
  }
  std::string text = listed(missing);
  const auto shown = static_cast<std::int64_t>(missing.size());
  if (count > shown) text += fmt::format(" and {} more", count - shown);
  refuse(folder, fmt::format("{} of the slices' numbers are missing", count), text,
         "Add these slices. If they never existed, number the files without gaps.");
}

}  // namespace

SliceOrder order_slices(std::vector<std::filesystem::path> files, const std::string& folder) {
  std::sort(files.begin(), files.end());
  std::vector<Name> names;
  names.reserve(files.size());
  for (const auto& file : files) names.push_back(cut(file));
  take_signs(names);
  require_one_series(names, folder);
  take_decimals(names, folder);
  evaluate(names, folder);
  const std::size_t counter = counter_of(names, folder);
  require_no_twins(names, counter, folder);
  const std::int64_t step = step_of(names, counter, folder);
  SliceOrder order;
  for (const Name& name : names) order.files.push_back(name.file);
  order.remarks.push_back(fmt::format("{} slices in the order of their numbers, from {} to {}",
                                      names.size(), name_of(names.front()), name_of(names.back())));
  if (step > 1) {
    order.remarks.push_back(
        fmt::format("the slices' numbers go up in steps of {}: if slices were left out, the voxels "
                    "are no cubes",
                    step));
  }
  return order;
}

}  // namespace reckon
