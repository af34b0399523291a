// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/page.hpp"

#include <fmt/format.h>

#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/report/piece.hpp"

namespace reckon {
namespace {

constexpr std::string_view place_of_data = "<!--DATA-->";

struct Halves {
  std::string_view before;
  std::string_view after;
};

/// The page around the place where data go.
Halves halves() {
  const std::string_view page = viewer_page();
  const std::size_t at = page.find(place_of_data);
  if (at == std::string_view::npos) {
    throw Error{{.place = "report",
                 .problem = "this reckon was built without the report's page",
                 .reason = "Node.js and npm were not found when it was configured",
                 .fix = "Install nodejs and npm (tools/install_dependencies.sh viewer), then "
                        "configure and build again."}};
  }
  return {page.substr(0, at), page.substr(at + place_of_data.size())};
}

void add_piece(std::string& page, const std::string& name, const std::string& piece) {
  page += fmt::format(R"(<script type="text/plain" data-piece="{}">)", name);
  page += base64(piece);
  page += "</script>\n";
}

}  // namespace

std::string report_page(std::span<const RunFolder> runs, const PageLimits& limits,
                        const std::function<void(std::size_t done, std::size_t total)>& progressed,
                        const std::function<void(const std::string&)>& note) {
  const Halves around = halves();
  std::string page{around.before};
  std::size_t total = 0;
  for (const RunFolder& run : runs) total += RunPieces{run, limits}.frame_steps().size();
  std::size_t done = 0;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    RunPieces pieces{runs[run], limits};
    std::string frames;
    std::vector<std::uint64_t> left_out;
    static_cast<void>(scene_of_run(runs[run]));  // before the long work
    for (const std::uint64_t step : pieces.frame_steps()) {
      try {
        add_piece(frames, fmt::format("{}/frame/{}", run, step), pieces.frame(step));
      } catch (const Error& error) {
        left_out.push_back(step);
        if (note) note(fmt::format("left out: {}", error.what()));
      }
      if (progressed) progressed(++done, total);
    }
    add_piece(page, fmt::format("{}/head", run), pieces.head(left_out));
    page += frames;
  }
  page += around.after;
  return page;
}

std::string live_page() {
  const Halves around = halves();
  std::string page{around.before};
  page += R"(<meta name="reckon-live" content="true">)";
  page += around.after;
  return page;
}

}  // namespace reckon
