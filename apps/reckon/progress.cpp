// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "reckon/text/human.hpp"
#include "standard_streams.hpp"

namespace reckon::app {
namespace {

constexpr double redraw_interval = 0.2;       // [s]
constexpr double longest_line_interval = 60;  // [s]

std::size_t terminal_width(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

/// Draws a line over the last one.
void draw(std::FILE* to, int descriptor, double share, std::string_view text) {
  // fmt::print would throw where the terminal is gone
  const std::string line = "\r\033[K" + bar_line(share, text, terminal_width(descriptor));
  std::fputs(line.c_str(), to);
  std::fflush(to);
}

double share_done(const RunProgress& progress) {
  return progress.steps == 0
             ? 1
             : static_cast<double>(progress.step) / static_cast<double>(progress.steps);
}

std::string time_left(const RunProgress& progress, double steps_per_second) {
  if (!(steps_per_second > 0)) return "?";
  return human_duration(static_cast<double>(progress.steps - progress.step) / steps_per_second);
}

}  // namespace

std::string bar_line(double share, std::string_view text, std::size_t width) {
  constexpr std::size_t longest_bar = 30;
  const std::string told = fmt::format("{:3.0f} %  {}", 100 * share, text);
  const std::size_t taken = told.size() + 4;  // brackets, a blank, and the cursor's place
  const std::size_t bar = std::min(width > taken ? width - taken : 0, longest_bar);
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(bar));
  const std::string line = bar == 0 ? told
                                    : fmt::format("[{}{}] {}", std::string(filled, '#'),
                                                  std::string(bar - filled, '.'), told);
  return line.substr(0, width > 0 ? width - 1 : 0);  // a line that wraps cannot be drawn over
}

ProgressDisplay::ProgressDisplay(bool quiet, bool may_redraw)
    : quiet_{quiet},
      terminal_{may_redraw && ::isatty(STDOUT_FILENO) == 1},
      last_shown_{Clock::now()},
      rate_since_{last_shown_} {}

void ProgressDisplay::show(const RunProgress& progress) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  const double since = std::chrono::duration<double>(now - last_shown_).count();
  if (since < (terminal_ ? redraw_interval : line_interval_)) return;
  last_shown_ = now;
  const double steps_per_second = rate(progress, now);
  if (terminal_) {
    draw_bar(progress, steps_per_second);
  } else {
    print_line(progress, steps_per_second);
    line_interval_ = std::min(2 * line_interval_, longest_line_interval);
  }
}

void ProgressDisplay::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
  drawn_ = false;
}

/// Steps per second of late: the time left should follow a run that slows down as contacts form.
double ProgressDisplay::rate(const RunProgress& progress, Clock::time_point now) {
  const std::uint64_t from = std::max(rate_from_step_, progress.first_step);
  const double seconds = std::chrono::duration<double>(now - rate_since_).count();
  const double recent = static_cast<double>(progress.step - from) / seconds;
  smooth_rate_ = smooth_rate_ > 0 ? 0.8 * smooth_rate_ + 0.2 * recent : recent;
  rate_since_ = now;
  rate_from_step_ = progress.step;
  return smooth_rate_;
}

void ProgressDisplay::draw_bar(const RunProgress& progress, double steps_per_second) {
  draw(
      stdout, STDOUT_FILENO, share_done(progress),
      fmt::format("step {} of {}  {:.3g} s  {:.3g} steps/s  {} left", progress.step, progress.steps,
                  progress.time, steps_per_second, time_left(progress, steps_per_second)));
  drawn_ = true;
}

void ProgressDisplay::print_line(const RunProgress& progress, double steps_per_second) const {
  say(fmt::format("step {} of {} ({:.1f} %), {:.4g} s simulated, {:.3g} steps/s, {} left\n",
                  progress.step, progress.steps, 100 * share_done(progress), progress.time,
                  steps_per_second, time_left(progress, steps_per_second)));
}

CountDisplay::CountDisplay(std::string what)
    : what_{std::move(what)}, terminal_{::isatty(STDERR_FILENO) == 1} {}

CountDisplay::~CountDisplay() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void CountDisplay::show(std::size_t done, std::size_t total) {
  if (!terminal_ || since_shown_.seconds() < redraw_interval) return;
  since_shown_ = {};
  const double rate = static_cast<double>(done) / seconds();
  const double share = total == 0 ? 1 : static_cast<double>(done) / static_cast<double>(total);
  draw(stderr, STDERR_FILENO, share,
       fmt::format("{} of {} {}  {:.3g} a second  {} left", done, total, what_, rate,
                   rate > 0 ? human_duration(static_cast<double>(total - done) / rate) : "?"));
}

}  // namespace reckon::app
