// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/http_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

using Clock = std::chrono::steady_clock;

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_{number} {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_;
};

struct Connection {
  Descriptor socket;
  Clock::time_point moved{Clock::now()};  ///< since when it keeps us waiting
  std::string request{};                  ///< as far as it has come
  std::string answer{};                   ///< what is still to be sent, from `sent` on
  std::size_t sent{0};
  bool last{false};     ///< close after this answer
  bool closing{false};  ///< has its last answer; further requests are discarded
  bool gone{false};

  [[nodiscard]] bool is_sending() const { return sent < answer.size(); }
};

std::string_view reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 421:
      return "Misdirected Request";
    case 431:
      return "Request Header Fields Too Large";
    default:
      return "Service Unavailable";
  }
}

bool same_word(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return small(x) == small(y); });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// The head of a request, without the empty line at its end.
struct Head {
  std::string_view method;
  std::string_view path;
  std::string_view host;
  bool close{false};
  bool has_body{false};
};

std::optional<Head> parse(std::string_view text) {
  Head head;
  const std::size_t end = std::min(text.find("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  const std::size_t first = line.find(' ');
  const std::size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
  if (second == std::string_view::npos) return std::nullopt;
  head.method = line.substr(0, first);
  head.path = line.substr(first + 1, second - first - 1);
  const std::string_view version = line.substr(second + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0") return std::nullopt;
  head.close = version == "HTTP/1.0";
  for (std::size_t at = end; at < text.size();) {
    at += 2;  // CR LF
    const std::size_t stop = std::min(text.find("\r\n", at), text.size());
    const std::string_view field = text.substr(at, stop - at);
    at = stop;
    const std::size_t colon = field.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const std::string_view name = field.substr(0, colon);
    const std::string_view value = trimmed(field.substr(colon + 1));
    if (same_word(name, "Host")) head.host = value.substr(0, value.rfind(':'));
    if (same_word(name, "Connection") && same_word(value, "close")) head.close = true;
    const bool body =
        (same_word(name, "Content-Length") && value != "0") || same_word(name, "Transfer-Encoding");
    if (body) head.has_body = true;
  }
  return head;
}

}  // namespace

struct HttpServer::Impl {
  Impl(std::string own_headers, Answerer own_answerer)
      : headers{std::move(own_headers)}, answerer{std::move(own_answerer)} {}

  void accept_all() {
    while (true) {
      Descriptor socket{::accept4(listener.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
      if (socket.get() < 0) return;
      if (connections.size() >= most_connections) drop_oldest();
      connections.push_back({std::move(socket)});
      receive(connections.back());
    }
  }

  /// The connection that has been idle longest; connections without a complete request go first.
  void drop_oldest() {
    const auto oldest = std::min_element(
        connections.begin(), connections.end(), [](const Connection& a, const Connection& b) {
          return std::pair{a.is_sending(), a.moved} < std::pair{b.is_sending(), b.moved};
        });
    connections.erase(oldest);
  }

  void receive(Connection& client) const {
    constexpr int most_parts = 16;  // then it is the others' turn
    std::array<char, 4096> bytes{};
    for (int part = 0; part < most_parts && !client.is_sending() && !client.gone; ++part) {
      const ssize_t count = ::recv(client.socket.get(), bytes.data(), bytes.size(), 0);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
      if (count <= 0) {
        client.gone = true;
        return;
      }
      if (client.closing) continue;
      client.request.append(bytes.data(), static_cast<std::size_t>(count));
      answer_what_has_come(client);
    }
  }

  /// Answers complete requests, one after the other, until an answer has to wait for its reader.
  void answer_what_has_come(Connection& client) const {
    constexpr std::string_view ending = "\r\n\r\n";
    while (!client.is_sending() && !client.closing && !client.gone) {
      const std::size_t end = client.request.find(ending);
      if (end == std::string::npos) {
        if (client.request.size() > longest_request) reply(client, {431, {}, {}}, true, true);
        return;
      }
      answer_next(client, end, ending.size());
    }
  }

  void answer_next(Connection& client, std::size_t end, std::size_t ending) const {
    const std::string text = client.request.substr(0, end);
    client.request.erase(0, end + ending);
    if (text.size() > longest_request) return reply(client, {431, {}, {}}, true, true);
    const std::optional<Head> head = parse(text);
    if (!head) return reply(client, {400, {}, {}}, true, true);
    const bool only_head = head->method == "HEAD";
    if (!only_head && head->method != "GET") return reply(client, {405, {}, {}}, true, true);
    // A body would be taken for the next request.
    const bool last = head->close || head->has_body;
    reply(client, answerer({std::string{head->path}, std::string{head->host}}), !only_head, last);
  }

  void reply(Connection& client, const HttpAnswer& answer, bool with_body, bool last) const {
    client.answer = fmt::format("HTTP/1.1 {} {}\r\nContent-Length: {}\r\n", answer.status,
                                reason_of(answer.status), answer.body.size());
    if (!answer.type.empty()) client.answer += fmt::format("Content-Type: {}\r\n", answer.type);
    if (last) client.answer += "Connection: close\r\n";
    client.answer += headers;
    client.answer += "\r\n";
    if (with_body) client.answer += answer.body;
    client.sent = 0;
    client.last = last;
    client.moved = Clock::now();
    send(client);
  }

  void send(Connection& client) const {
    while (client.is_sending()) {
      const ssize_t count = ::send(client.socket.get(), client.answer.data() + client.sent,
                                   client.answer.size() - client.sent, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
      if (count <= 0) {
        client.gone = true;
        return;
      }
      client.sent += static_cast<std::size_t>(count);
      client.moved = Clock::now();
    }
    client.answer.clear();
    client.sent = 0;
    if (!client.last) return;
    // Closing at once, with bytes unread, would take the answer away from the client.
    client.closing = ::shutdown(client.socket.get(), SHUT_WR) == 0;
    client.gone = !client.closing;
  }

  void serve() {
    std::vector<pollfd> waited;
    while (true) {
      waited.assign({{stopper.get(), POLLIN, 0}, {listener.get(), POLLIN, 0}});
      for (const Connection& client : connections) {
        const short events = client.is_sending() ? POLLOUT : POLLIN;
        waited.push_back({client.socket.get(), events, 0});
      }
      constexpr int once_a_second = 1000;  // [ms]
      ::poll(waited.data(), waited.size(), once_a_second);
      if (waited[0].revents != 0) return;
      const Clock::time_point limit = Clock::now() - std::chrono::seconds{patience};
      for (std::size_t n = 0; n < connections.size(); ++n) {
        Connection& client = connections[n];
        if (waited[n + 2].revents != 0) {
          if (client.is_sending()) send(client);
          answer_what_has_come(client);
          receive(client);
        }
        if (client.moved < limit) client.gone = true;
      }
      std::erase_if(connections, [](const Connection& client) { return client.gone; });
      if (waited[1].revents != 0) accept_all();
    }
  }

  std::string headers;
  Answerer answerer;
  Descriptor listener{-1};
  Descriptor stopper{-1};
  std::vector<Connection> connections;
  int port{0};
};

HttpServer::HttpServer(int port, std::string headers, Answerer answerer)
    : impl_{std::make_unique<Impl>(std::move(headers), std::move(answerer))} {
  impl_->stopper = Descriptor{::eventfd(0, EFD_CLOEXEC)};
  impl_->listener = Descriptor{::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const int listener = impl_->listener.get();
  const int yes = 1;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (listener < 0 || impl_->stopper.get() < 0 || ::bind(listener, generic, size) != 0 ||
      ::listen(listener, SOMAXCONN) != 0 || ::getsockname(listener, generic, &size) != 0) {
    throw Error{{.place = fmt::format("port {}", port),
                 .problem = "cannot be listened to",
                 .reason = std::generic_category().message(errno),
                 .fix = "Give another one with --port, or none."}};
  }
  impl_->port = ntohs(address.sin_port);
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port; }

void HttpServer::serve() { impl_->serve(); }

void HttpServer::stop() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(impl_->stopper.get(), &one, sizeof one);
}

}  // namespace reckon
