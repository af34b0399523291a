// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/watch_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/report/page.hpp"
#include "reckon/report/watch_version.hpp"

namespace reckon {
namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr int not_found = 404;
constexpr int misdirected = 421;

/// What the page may do in a browser: its own scripts, and requests to where it came from.
const httplib::Headers headers{
    {"Cache-Control", "no-store"},
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src "
     "'self'; img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"X-Content-Type-Options", "nosniff"}};

bool names_this_machine(std::string host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string::npos) host.resize(colon);
  return host == loopback || host == "localhost";
}

}  // namespace

struct WatchServer::Impl {
  Impl(RunFolder run, PageLimits limits) : folder{std::move(run)}, pieces{folder, limits} {}

  /// Answers with what `make` returns, or with why it could not.
  template <class Make>
  void answer(httplib::Response& response, const char* type, Make&& make) {
    try {
      const std::lock_guard lock{mutex};  // the readers of files are not made for many at once
      response.set_content(make(), type);
    } catch (const std::exception& error) {  // the run may be replaced at this very moment
      response.status = 503;
      response.set_content(error.what(), "text/plain; charset=utf-8");
    }
  }

  void answer_frame(const httplib::Request& request, httplib::Response& response) {
    const std::string text = request.matches[1].str();
    std::uint64_t step = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), step);
    const std::vector<std::uint64_t> saved = folder.field_steps("grains");
    if (code != std::errc{} || end != text.data() + text.size() ||
        !std::binary_search(saved.begin(), saved.end(), step)) {
      response.status = not_found;
      return;
    }
    answer(response, "application/octet-stream", [&] { return pieces.frame(step); });
  }

  RunFolder folder;
  RunPieces pieces;
  std::mutex mutex;
  httplib::Server server;
  int port{0};
};

WatchServer::WatchServer(RunFolder folder, PageLimits limits, int port)
    : impl_{std::make_unique<Impl>(std::move(folder), limits)} {
  httplib::Server& server = impl_->server;
  const std::string page = live_page();
  server.set_default_headers(headers);
  server.set_keep_alive_max_count(100);
  server.set_payload_max_length(0);
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    using Handled = httplib::Server::HandlerResponse;
    if (request.method != "GET" && request.method != "HEAD") {
      response.status = 405;
      return Handled::Handled;
    }
    if (names_this_machine(request.get_header_value("Host"))) return Handled::Unhandled;
    response.status = misdirected;
    return Handled::Handled;
  });
  server.Get("/", [page](const httplib::Request&, httplib::Response& response) {
    response.set_content(page, "text/html; charset=utf-8");
  });
  server.Get("/version", [this](const httplib::Request&, httplib::Response& response) {
    impl_->answer(response, "text/plain", [&] { return version_of(impl_->folder); });
  });
  server.Get("/piece/0/head", [this](const httplib::Request&, httplib::Response& response) {
    impl_->answer(response, "application/octet-stream", [&] { return impl_->pieces.head(); });
  });
  server.Get(R"(/piece/0/frame/(\d{1,20}))",
             [this](const httplib::Request& request, httplib::Response& response) {
               impl_->answer_frame(request, response);
             });
  const bool bound = port == 0 ? (impl_->port = server.bind_to_any_port(loopback)) > 0
                               : server.bind_to_port(loopback, impl_->port = port);
  if (bound) return;
  throw Error{{.place = fmt::format("port {}", port),
               .problem = "cannot be listened to",
               .reason = "another program has it, or it may not be used",
               .fix = "Give another one with --port, or none."}};
}

WatchServer::~WatchServer() { stop(); }

int WatchServer::port() const { return impl_->port; }

void WatchServer::serve() { impl_->server.listen_after_bind(); }

void WatchServer::stop() { impl_->server.stop(); }

}  // namespace reckon
