// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace reckon {

/// The request of a browser. Methods other than GET and HEAD are refused earlier.
struct HttpRequest {
  std::string path;  ///< as in the request, query included
  std::string host;  ///< the header of that name, without a port
};

struct HttpAnswer {
  int status{200};
  std::string type{"text/plain; charset=utf-8"};
  std::string body;
};

/// A small HTTP/1.1 server (RFC 9112) on 127.0.0.1, for browsers on this machine. One thread
/// answers all connections in turn without blocking, so a slow client does not delay others. The
/// number of connections, the bytes of a request and the time of each are limited.
class HttpServer {
 public:
  static constexpr std::size_t most_connections = 256;
  static constexpr std::size_t longest_request = 8192;  ///< [bytes]
  static constexpr int patience = 10;  ///< for a request, for an answer to move [s]

  using Answerer = std::function<HttpAnswer(const HttpRequest&)>;

  /// Takes the port, any free one for 0. Throws Error when it is taken. `headers` go with every
  /// answer; each ends with CR LF.
  HttpServer(int port, std::string headers, Answerer answerer);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] int port() const;
  /// Answers until stop() is called, from another thread.
  void serve();
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reckon
