// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "option_faults.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <vector>

#include "command_pages.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/near_misses.hpp"
#include "reckon/text/nearest_name.hpp"
#include "reckon/text/units.hpp"

namespace reckon::app {
namespace {

std::vector<const CLI::App*> commands_below(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// The command that was being parsed, below all others that were named.
const CLI::App& command_used(const CLI::App& app) {
  const auto used = app.get_subcommands();
  return used.empty() ? app : command_used(*used.front());
}

/// "reckon grains info"
std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : full_name(*app.get_parent()) + ' ' + app.get_name();
}

std::vector<std::string> options_of_command(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  }
  return names;
}

/// "--Safety_minutes=3" is meant to be the option safety-minutes.
std::string plain_option(std::string_view written) {
  const auto first = written.find_first_not_of('-');
  std::string name{written.substr(std::min(first, written.size()))};
  name.erase(std::min(name.find('='), name.size()));
  for (char& c : name) {
    if (c == '_') c = '-';
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return name;
}

/// The first command of the program other than `but` that has this option; empty without one.
std::string command_with(const CLI::App& app, const CLI::App& but, const std::string& option) {
  for (const CLI::App* command : commands_below(app)) {
    const auto names = options_of_command(*command);
    if (command != &but && std::find(names.begin(), names.end(), option) != names.end()) {
      return full_name(*command);
    }
    std::string below = command_with(*command, but, option);
    if (!below.empty()) return below;
  }
  return {};
}

std::string advice_on_option(const std::string& name, const CLI::App& command,
                             const CLI::App& root) {
  const std::vector<std::string> known = options_of_command(command);
  if (const auto near = nearest_name(name, known)) return fmt::format("Did you mean --{}?", *near);
  const std::string other = command_with(root, command, name);
  if (!other.empty()) return fmt::format("`{}` has it.", other);
  return fmt::format("There are --{}.", fmt::join(known, ", --"));
}

bool is_unit(const std::string& text) {
  try {
    (void)parse_unit(text);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// An argument that no option or position of the command takes.
std::string explain_extra(const std::vector<std::string>& extras, const CLI::App& root) {
  const CLI::App& command = command_used(root);
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& extra) { return extra.starts_with('-'); });
  if (option != extras.end()) {
    return fmt::format("`{}` has no option {}. {}", full_name(command),
                       option->substr(0, option->find('=')),
                       advice_on_option(plain_option(*option), command, root));
  }
  const std::vector<std::string> known = options_of_command(command);
  const std::string name = plain_option(extras.front());
  std::string advice;
  if (std::find(known.begin(), known.end(), name) != known.end()) {
    advice = fmt::format(" Did you mean --{}?", name);
  } else if (is_unit(extras.front())) {
    advice = " Write a number and its unit without a space, for example 1mm.";
  }
  return fmt::format("`{}` takes no argument \"{}\".{}", full_name(command), extras.front(),
                     advice);
}

/// The message of CLI11 for one option: "--threads: 1 required INT:INT in [1 - 4096] missing",
/// "page: a not in {b,c}", "--threads: At Most 1 required but received 2", "scene is required".
std::string explain_option(const std::string& text, const CLI::App& root) {
  const std::string name = text.substr(0, text.find_first_of(": "));
  const CLI::Option* option = command_used(root).get_option_no_throw(name);
  if (option == nullptr) return text;
  const auto says = [&](std::string_view part) { return text.find(part) != std::string::npos; };
  if (says(" is required")) return fmt::format("{} is missing: {}", name, option_summary(*option));
  if (says(" missing")) return fmt::format("{} needs a value: {}", name, option_summary(*option));
  if (says("but received")) return fmt::format("{} is given more than once", name);
  const std::vector<std::string> choices = option_choices(*option);
  if (choices.empty() || !(says(" not in {") || says(" value in {"))) return text;
  const std::string_view opening = says(": Check ") ? ": Check " : ": ";
  const std::size_t begin = text.find(opening) + opening.size();
  const std::string written =
      text.substr(begin, std::min(text.find(" not in {"), text.find(" value in {")) - begin);
  const auto near = nearest_name(written, choices);
  return fmt::format("{}: \"{}\" is not one of {}{}", name, written, fmt::join(choices, ", "),
                     near ? fmt::format(". Did you mean {}?", *near) : "");
}

bool is_number(const std::string& text) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, code] = std::from_chars(begin, text.data() + text.size(), value);
  return code != std::errc::invalid_argument && end == text.data() + text.size();
}

bool is_whole_number(const std::string& text) {
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  return text.size() > sign && text.find_first_not_of("0123456789", sign) == std::string::npos;
}

std::string with_advice(std::string problem, const std::string& advice) {
  return advice.empty() ? problem : std::move(problem) + ". " + advice;
}

std::string fault_of_number(const std::string& given) {
  if (is_number(given)) {
    const bool finite = std::isfinite(std::strtod(given.c_str(), nullptr));
    return finite ? std::string{} : fmt::format("{} is not a number", given);
  }
  std::string advice = advice_on_number(given);
  if (given.ends_with('%') && is_number(given.substr(0, given.size() - 1))) {
    advice = fmt::format("Write {}.", std::strtod(given.c_str(), nullptr) / 100);
  } else if (advice.empty() && !given.empty() && given[0] >= '0' && given[0] <= '9') {
    advice = "Write it without a unit.";
  }
  return with_advice(fmt::format("{} is not a number", given), advice);
}

/// "--out --quiet" names no folder.
std::string fault_of_value(const std::string& given) {
  if (!given.starts_with("--")) return {};
  return fmt::format("needs a value, and {} is an option. Write a name that begins with -- as ./{}",
                     given, given);
}

std::string fault_of_count(const std::string& given, bool may_be_negative) {
  if (is_whole_number(given) && given[0] == '-' && !may_be_negative) {
    return fmt::format("{} is not a whole number of 0 or more", given);
  }
  if (is_whole_number(given)) return {};
  return with_advice(fmt::format("{} is not a whole number", given), advice_on_whole_number(given));
}

}  // namespace

void refuse_odd_values(CLI::App& root) {
  for (CLI::Option* option : root.get_options([](const CLI::Option*) { return true; })) {
    // `transform` puts a check before those that the option has; nothing is changed.
    const auto refuse = [&](auto fault) {
      option->transform(CLI::Validator{[=](std::string& given) { return fault(given); }, ""});
    };
    if (!option->get_lnames().empty() && option->get_items_expected_max() > 0) {
      refuse(fault_of_value);
    }
    const std::string type = option->get_type_name();
    const std::string name = type.substr(0, type.find(':'));
    if (name == "FLOAT") refuse(fault_of_number);
    if (name == "INT") refuse([](const std::string& given) { return fault_of_count(given, true); });
    if (name == "UINT") {
      refuse([](const std::string& given) { return fault_of_count(given, false); });
    }
  }
  for (CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; })) {
    refuse_odd_values(*command);
  }
}

void require_known_command(const CLI::App& root, int argc, char** argv) {
  const CLI::App* group = &root;
  for (int n = 1; n < argc && argv[n][0] != '-'; ++n) {
    std::vector<std::string> names;
    const CLI::App* next = nullptr;
    for (const CLI::App* command : commands_below(*group)) {
      names.push_back(command->get_name());
      if (command->get_name() == argv[n]) next = command;
    }
    if (names.empty()) return;  // arguments of a command
    if (next != nullptr) {
      group = next;
      continue;
    }
    const std::string written = argv[n];
    const auto near = nearest_name(written, names);
    std::string fix = fmt::format("There are {}.", fmt::join(names, ", "));
    if (near) fix = fmt::format("Did you mean `{} {}`?", full_name(*group), *near);
    if (written.ends_with(".toml")) fix = fmt::format("Did you mean `reckon run {}`?", written);
    if (written == "help") fix = fmt::format("Did you mean `{} --help`?", full_name(*group));
    throw Error{{.place = {},
                 .problem = fmt::format("there is no command \"{}\"", written),
                 .reason = {},
                 .fix = std::move(fix)}};
  }
}

std::string explain(const CLI::ParseError& error, const CLI::App& root) {
  std::string text = error.what();
  const std::vector<std::string> extras = root.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !extras.empty()) {
    text = explain_extra(extras, root);
  } else {
    text = explain_option(text, root);
  }
  return fmt::format("{}\nSee: {} --help", text, full_name(command_used(root)));
}

}  // namespace reckon::app
