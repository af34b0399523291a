// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "command_pages.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "reckon/core/build_info.hpp"

namespace reckon::app {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// An option as its user writes it, e.g. "-o, --output TEXT", and what it does.
struct OptionText {
  std::string names;
  std::string value;  ///< what follows; empty for flags and for the arguments themselves
  std::string meaning;
  bool argument{false};  ///< stands without a name
};

/// "TEXT:{a,b}" and "ENUM:value in {a->0,b->1} OR {0,1}" offer a and b; other types nothing.
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t open = type.find('{');
  if (open == std::string::npos) return choices;
  const std::size_t close = type.find('}', open);
  for (std::size_t begin = open + 1; begin < close;) {
    const std::size_t end = std::min(type.find(',', begin), close);
    const std::string choice = type.substr(begin, end - begin);
    choices.push_back(choice.substr(0, choice.find("->")));
    begin = end + 1;
  }
  return choices;
}

/// The user's word for the types INT and so on of CLI11; a special form, like LX,LY,LZ, stays.
std::string value_name(const std::string& type, bool is_choice) {
  if (is_choice) return "NAME";
  const std::string name = type.substr(0, type.find(':'));
  if (name == "INT" || name == "UINT") return "N";
  return name == "FLOAT" ? "NUMBER" : name;
}

/// CLI11 names a type with what it must fulfil, "INT:INT in [1 - 9]" or "TEXT:{a,b}": the first
/// part goes behind the option's name, choices and range into its meaning.
void add_type(const std::string& type, OptionText& text) {
  const std::vector<std::string> choices = choices_of(type);
  if (!text.argument) text.value = value_name(type, !choices.empty());
  if (!choices.empty() && !text.argument)
    text.meaning += fmt::format(" (one of {})", fmt::join(choices, ", "));
  const std::size_t open = type.find('[');
  const std::size_t close = type.find(']');
  const std::size_t dash = type.find(" - ", open);
  if (open == std::string::npos || close == std::string::npos || dash == std::string::npos) return;
  text.meaning += fmt::format(" ({} to {})", type.substr(open + 1, dash - open - 1),
                              type.substr(dash + 3, close - dash - 3));
}

OptionText text_of(const CLI::Option& option) {
  const bool argument = option.get_positional();
  OptionText text{.names = option.get_name(argument, true),
                  .value = {},
                  .meaning = option.get_description(),
                  .argument = argument};
  for (std::size_t at = 0; (at = text.names.find(',', at)) != std::string::npos; at += 2) {
    text.names.replace(at, 1, ", ");
  }
  if (option.get_type_size() > 0) add_type(option.get_type_name(), text);
  if (!option.get_default_str().empty()) {
    text.meaning += fmt::format(" (default: {})", option.get_default_str());
  }
  if (!argument && option.get_required()) text.meaning += " (required)";
  return text;
}

std::vector<OptionText> options_of(const CLI::App& app) {
  std::vector<OptionText> options;
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    options.push_back(text_of(*option));
  }
  return options;
}

std::string upper_case(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

/// "reckon grains info LIBRARY [OPTIONS]", or "... COMMAND" where there are commands below.
std::string usage(const CLI::App& app, const std::string& path) {
  std::string text = path;
  if (!commands_of(app).empty()) text += " COMMAND";
  bool named = false;
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    if (!option->get_positional()) {
      named = named || option->get_name() != "--help";
      continue;
    }
    text += ' ' + upper_case(option->get_name(true));
    if (option->get_items_expected_max() > 1) text += "...";
  }
  return text + (named ? " [OPTIONS]" : "");
}

/// `--help` in the words of the other pages.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(32);
    label("Positionals", "Arguments");
    label("Subcommands", "Commands");
  }
  std::string make_usage(const CLI::App* app, std::string path) const override {
    return fmt::format("\nUsage: {}\n", usage(*app, path));
  }
  std::string make_option_name(const CLI::Option* option, bool /*argument*/) const override {
    const OptionText text = text_of(*option);
    return text.argument ? upper_case(text.names) : text.names;
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string value = text_of(*option).value;
    return value.empty() ? value : ' ' + value;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return text_of(*option).meaning;
  }
};

template <class Visit>
void walk(const CLI::App& app, const std::string& path, Visit&& visit) {
  visit(app, path);
  for (const CLI::App* command : commands_of(app)) {
    walk(*command, path + ' ' + command->get_name(), visit);
  }
}

std::string in_table(std::string_view text) {
  std::string cell;
  for (const char c : text) {
    if (c == '|') cell += '\\';
    cell += c == '\n' ? ' ' : c;
  }
  return cell;
}

/// Text for groff: its control characters are escaped.
std::string roff(std::string_view text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    line_start = c == '\n';
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string roff_block(std::string_view text) { return ".PP\n.nf\n" + roff(text) + "\n.fi\n"; }

}  // namespace

void use_help_format(CLI::App& root) { root.formatter(std::make_shared<HelpFormatter>()); }

std::vector<std::string> option_choices(const CLI::Option& option) {
  return choices_of(option.get_type_name());
}

std::string option_summary(const CLI::Option& option) {
  const OptionText text = text_of(option);
  return text.value.empty() ? text.meaning : fmt::format("{}: {}", text.value, text.meaning);
}

std::string commands_markdown(const CLI::App& root) {
  std::string page =
      "# Commands and options\n\nThis page is made by `reckon reference commands`; `reckon COMMAND "
      "--help` says the same. Exit codes and stopping: [command line](command-line.md).\n";
  walk(root, "reckon", [&](const CLI::App& app, const std::string& path) {
    if (&app == &root) return;
    page += fmt::format("\n## {}\n\n{}\n\n```\n{}\n```\n", path, app.get_description(),
                        usage(app, path));
    std::string rows;
    for (const OptionText& option : options_of(app)) {
      if (option.names == "-h, --help" || option.meaning.empty()) continue;
      const std::string value = option.value.empty() ? "" : ' ' + option.value;
      rows +=
          fmt::format("| `{}{}` | {} |\n", option.names, in_table(value), in_table(option.meaning));
    }
    if (!rows.empty()) page += "\n| option | meaning |\n|---|---|\n" + rows;
    if (!app.get_footer().empty()) page += fmt::format("\n```\n{}\n```\n", app.get_footer());
  });
  return page;
}

std::string manual_page(const CLI::App& root) {
  std::string page =
      fmt::format(".TH RECKON 1 \"\" \"reckon {}\" \"User Commands\"\n", build_info().version);
  page += ".SH NAME\nreckon \\- level\\-set discrete element method for grains of any shape\n";
  page += ".SH SYNOPSIS\n.B reckon\n.I COMMAND\n[\\fIOPTIONS\\fR]\n";
  page += ".SH DESCRIPTION\n" + roff(root.get_description()) + '\n';
  page += ".SH COMMANDS\n";
  walk(root, "reckon", [&](const CLI::App& app, const std::string& path) {
    if (&app == &root) return;
    page += fmt::format(".SS {}\n{}.\n", roff(usage(app, path)), roff(app.get_description()));
    for (const OptionText& option : options_of(app)) {
      if (option.names == "-h, --help") continue;
      page += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(option.names),
                          option.value.empty() ? "" : " \\fI" + roff(option.value) + "\\fR",
                          roff(option.meaning));
    }
    if (!app.get_footer().empty()) page += roff_block(app.get_footer());
  });
  return page + ".SH EXIT STATUS\n" + roff_block(root.get_footer());
}

std::string bash_completion(const CLI::App& root) {
  std::string known;
  std::string words;
  walk(root, "", [&](const CLI::App& app, const std::string& path) {
    if (!path.empty()) known += fmt::format("{}\"{}\"", known.empty() ? "" : " | ", path);
    std::string commands;
    for (const CLI::App* command : commands_of(app)) commands += ' ' + command->get_name();
    std::string options;
    for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
      for (const std::string& name : option->get_lnames()) options += " --" + name;
      for (const std::string& name : option->get_snames()) options += " -" + name;
    }
    words += fmt::format("    \"{}\") commands=\"{}\" options=\"{}\" ;;\n", path,
                         commands.empty() ? "" : commands.substr(1),
                         options.empty() ? "" : options.substr(1));
  });
  return fmt::format(R"(# bash completion of reckon, made by `reckon reference bash`.
_reckon() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} path="" word commands="" options=""
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$path $word" in
      {}) path="$path $word" ;;
    esac
  done
  case "$path" in
{}  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
  fi
}}
complete -o default -F _reckon reckon
)",
                     known, words);
}

}  // namespace reckon::app
