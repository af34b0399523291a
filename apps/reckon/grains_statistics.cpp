// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "grains_parts.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/shape_statistics.hpp"
#include "reckon/core/file.hpp"
#include "reckon/text/csv_text.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::app {
namespace {

void print_spreads(const ShapeLibrary& library) {
  fmt::print("{:<14} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "", "mean", "std. dev.",
             "min", "10 %", "median", "90 %", "max");
  for (const ShapeMeasure& measure : shape_measures()) {
    const MeasureSpread s = spread_of(library, measure);
    fmt::print("{:<14} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g}\n",
               measure.name, s.mean, s.deviation, s.low, s.tenth, s.median, s.ninetieth, s.high);
  }
}

std::string as_json(const std::string& file, const ShapeLibrary& library) {
  JsonWriter json;
  json.begin_object();
  json.value("file", file);
  json.value("grains", library.size());
  for (const ShapeMeasure& measure : shape_measures()) {
    const MeasureSpread s = spread_of(library, measure);
    json.begin_object(measure.name);
    json.value("mean", s.mean);
    json.value("deviation", s.deviation);
    json.value("least", s.low);
    json.value("percentile_10", s.tenth);
    json.value("median", s.median);
    json.value("percentile_90", s.ninetieth);
    json.value("most", s.high);
    json.end();
  }
  json.end();
  return json.text();
}

std::string as_csv(const ShapeLibrary& library) {
  std::string text = "grain";
  for (const ShapeMeasure& measure : shape_measures()) text += fmt::format(",{}", measure.name);
  text += '\n';
  for (const Shape& shape : library) {
    text += csv_text(shape.name);
    for (const ShapeMeasure& measure : shape_measures()) {
      text += fmt::format(",{:.8g}", measure.of(shape));
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void add_grains_statistics(CLI::App& grains) {
  CLI::App* command = grains.add_subcommand(
      "statistics",
      "Print the distributions of size and form in a library; write one CSV line per grain");
  command->footer("Example:\n  reckon grains statistics sand.h5 -o sand.csv");
  struct Options {
    std::string library;
    std::string output;
    bool json{false};
  };
  auto options = std::make_shared<Options>();
  command->add_option("library", options->library, "Shape library (.h5) or legacy folder")
      ->required();
  command->add_option("-o,--output", options->output, "Write one line per grain to this .csv file");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->callback([=] {
    const ShapeLibrary library = entries_of(LibrarySource{options->library});
    if (!options->output.empty()) {
      const std::string table = as_csv(library);
      require_own_file(options->output, table.substr(0, table.find('\n')), "table of shapes");
      write_file(options->output, table);
    }
    if (options->json) {
      fmt::print("{}", as_json(options->library, library));
    } else {
      print_spreads(library);
    }
  });
}

}  // namespace reckon::app
