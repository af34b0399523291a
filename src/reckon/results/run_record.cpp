// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/run_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "reckon/core/build_info.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/peak_memory.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

RunLog::RunLog(std::filesystem::path path)
    : path_{std::move(path)},
      descriptor_{::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666)} {
  if (descriptor_ >= 0) return;
  throw Error{{.place = path_.string(),
               .problem = "cannot be written",
               .reason = std::generic_category().message(errno),
               .fix = {}}};
}

RunLog::~RunLog() { ::close(descriptor_); }

void RunLog::write(std::string_view line) const {
  std::string text = utc_now() + "  ";
  text += printable(line);
  text += '\n';
  // A log that cannot grow must not end a run of days: the tables report a full disk.
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, text.data(), text.size());
}

namespace {

std::string record_text(const RunRecord& record) {
  const BuildInfo build = build_info();
  char host[256] = "";
  if (::gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
  const auto steps_done = static_cast<double>(record.step - record.first_step);
  JsonWriter json;
  json.begin_object();
  json.value("status", record.status);
  if (!record.message.empty()) json.value("message", record.message);
  if (record.verdict) write_verdict(json, *record.verdict);
  if (!record.coarse_nodes.text.empty()) {
    json.value("coarse_nodes", record.coarse_nodes.text);
    json.value("unseen_overlap_ratio", record.coarse_nodes.unseen);
  }
  json.value("scene", record.scene);
  json.value("grains", record.grains);
  json.value("shapes", record.shapes);
  json.value("time_step_s", record.time_step);
  json.value("step", record.step);
  json.value("steps", record.steps);
  json.value("time_s", static_cast<double>(record.step) * record.time_step);
  json.begin_object("session");
  json.value("first_step", record.first_step);
  json.value("started", record.started);
  json.value("written", utc_now());
  json.value("wall_s", record.wall_seconds);
  json.value("output_s", record.output_seconds);
  json.value("steps_per_s", record.wall_seconds > 0 ? steps_done / record.wall_seconds : 0);
  json.value("list_rebuilds", record.list_rebuilds);
  json.value("peak_memory_bytes", peak_memory());
  json.value("ranks", record.ranks);
  json.value("threads", thread_count());
  json.value("host", host);
  json.end();
  json.begin_object("program");
  json.value("version", build.version);
  json.value("revision", build.revision);
  json.value("compiler", build.compiler);
  json.value("flags", build.flags);
  json.end();
  json.end();
  return json.text();
}

}  // namespace

void write_run_record(const std::filesystem::path& path, const RunRecord& record) {
  write_file(path, record_text(record));
}

void overwrite_run_record(const std::filesystem::path& path, const RunRecord& record) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(path, code))) return;
  const std::string text = record_text(record);
  try {
    OpenFile file{path, O_WRONLY};
    file.write(0, text);
    file.close();
    std::filesystem::resize_file(path, text.size());
  } catch (const std::exception&) {
    std::filesystem::remove(path, code);
  }
}

namespace {

/// What follows `"key": ` in the record's outer object; empty where there is no such key.
std::string_view recorded_value(std::string_view record, std::string_view key) {
  const std::string before = fmt::format("\n  \"{}\": ", key);
  const std::size_t at = record.find(before);
  return at == std::string_view::npos ? std::string_view{} : record.substr(at + before.size());
}

std::string recorded_text(std::string_view record, std::string_view key) {
  const std::string_view value = recorded_value(record, key);
  std::string text;
  if (!value.starts_with('"')) return text;
  for (std::size_t at = 1; at < value.size() && value[at] != '"'; ++at) {
    if (value[at] == '\\' && at + 1 < value.size()) {
      ++at;
      text += value[at] == 'n' ? '\n' : value[at];
    } else {
      text += value[at];
    }
  }
  return text;
}

double recorded_number(std::string_view record, std::string_view key) {
  const std::string_view value = recorded_value(record, key);
  double number = 0;
  std::from_chars(value.data(), value.data() + value.size(), number);
  return number;
}

}  // namespace

RecordedOutcome recorded_outcome(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return {};
  const std::string record = read_file(path);
  return {recorded_text(record, "status"),
          recorded_text(record, "message"),
          {recorded_text(record, "coarse_nodes"), recorded_number(record, "unseen_overlap_ratio")}};
}

std::string recorded_status(const std::filesystem::path& path) {
  return recorded_outcome(path).status;
}

}  // namespace reckon
