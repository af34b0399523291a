// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/watch_server.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/report/http_server.hpp"
#include "reckon/report/page.hpp"
#include "reckon/report/watch_version.hpp"

namespace reckon {
namespace {

constexpr const char* packed = "application/octet-stream";

/// The rights of the page in a browser: its own scripts, and requests to its server.
constexpr const char* headers =
    "Cache-Control: no-store\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src "
    "'unsafe-inline'; connect-src 'self'; img-src data: blob:; base-uri 'none'; form-action "
    "'none'; frame-ancestors 'none'\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "X-Content-Type-Options: nosniff\r\n";

bool names_this_machine(const std::string& host) {
  return host == "127.0.0.1" || host == "localhost";
}

/// 128 random bits from the system.
std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getentropy(bytes.data(), bytes.size()) != 0) {
    throw Error{{.place = "watch",
                 .problem = "the system gives no random numbers for a token",
                 .reason = std::generic_category().message(errno),
                 .fix = {}}};
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

/// Takes as long for every word of the same length.
bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const auto byte = [&](std::string_view text) -> unsigned {
      return static_cast<unsigned char>(text[n]);
    };
    difference |= byte(a) ^ byte(b);
  }
  return difference == 0;
}

}  // namespace

struct WatchServer::Impl {
  Impl(RunFolder run, PageLimits limits, int port)
      : folder{std::move(run)},
        pieces{folder, limits},
        page{live_page()},
        token{make_token()},
        server{port, headers, [this](const HttpRequest& request) { return answer(request); }} {}

  [[nodiscard]] HttpAnswer answer(const HttpRequest& request) {
    if (!names_this_machine(request.host)) return {421, {}, {}};
    std::string_view path = request.path;
    if (!path.starts_with('/') || !same_secret(path.substr(1, token.size()), token)) {
      return {.status = 403,
              .body = "The address must hold the token that `reckon watch` has printed.\n"};
    }
    path.remove_prefix(1 + token.size());
    try {
      return answer_to(path);
    } catch (const std::exception& error) {  // the run may be replaced at this very moment
      return {.status = 503, .body = error.what()};
    }
  }

  [[nodiscard]] HttpAnswer answer_to(std::string_view path) {
    constexpr std::string_view frames = "/piece/0/frame/";
    if (path == "/") return {200, "text/html; charset=utf-8", page};
    if (path == "/version") return {.body = version_of(folder)};
    if (path == "/piece/0/head") return {200, packed, pieces.head()};
    if (!path.starts_with(frames)) return {404, {}, {}};
    path.remove_prefix(frames.size());
    std::uint64_t step = 0;
    const auto [end, code] = std::from_chars(path.data(), path.data() + path.size(), step);
    const std::vector<std::uint64_t> saved = folder.field_steps("grains");
    if (code != std::errc{} || end != path.data() + path.size() ||
        !std::binary_search(saved.begin(), saved.end(), step)) {
      return {404, {}, {}};
    }
    return {200, packed, pieces.frame(step)};
  }

  RunFolder folder;
  RunPieces pieces;
  std::string page;
  std::string token;
  HttpServer server;
};

WatchServer::WatchServer(RunFolder folder, PageLimits limits, int port)
    : impl_{std::make_unique<Impl>(std::move(folder), limits, port)} {}

WatchServer::~WatchServer() = default;

std::string WatchServer::address() const {
  return fmt::format("http://127.0.0.1:{}/{}/", impl_->server.port(), impl_->token);
}

void WatchServer::serve() { impl_->server.serve(); }

void WatchServer::stop() { impl_->server.stop(); }

}  // namespace reckon
