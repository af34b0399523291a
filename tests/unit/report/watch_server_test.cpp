// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/watch_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <vector>

#include "reckon/report/http_server.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

/// A connection to a port of this machine.
class Client {
 public:
  explicit Client(int port) : socket_{::socket(AF_INET, SOCK_STREAM, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(const std::string& text) const {
    EXPECT_EQ(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  /// All that comes until the server closes.
  [[nodiscard]] std::string receive() const {
    std::string text;
    std::string part(4096, '\0');
    for (ssize_t count = 0; (count = ::recv(socket_, part.data(), part.size(), 0)) > 0;) {
      text.append(part, 0, static_cast<std::size_t>(count));
    }
    return text;
  }
  [[nodiscard]] std::string answer_to(const std::string& request) const {
    send(request);
    return receive();
  }

 private:
  int socket_;
};

std::string get(const std::string& path, const std::string& more = {}) {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:1\r\n" + more + "Connection: close\r\n\r\n";
}

/// A server that answers with the path, on its own thread.
class HttpServerTest : public ::testing::Test {
 protected:
  ~HttpServerTest() override {
    server_.stop();
    thread_.join();
  }
  [[nodiscard]] std::string answer_to(const std::string& request) const {
    return Client{server_.port()}.answer_to(request);
  }

  HttpServer server_{0, "Own: header\r\n", [](const HttpRequest& request) {
                       return HttpAnswer{.body = request.host + " asks " + request.path};
                     }};
  std::thread thread_{[this] { server_.serve(); }};
};

TEST_F(HttpServerTest, AnswersInOrderOnOneConnection) {
  const Client client{server_.port()};
  const std::string two = client.answer_to("GET /a HTTP/1.1\r\nHost: here\r\n\r\n" + get("/b"));
  EXPECT_EQ(two.find("HTTP/1.1 200 OK\r\n"), 0U) << two;
  EXPECT_NE(two.find("Content-Length: 12\r\n"), std::string::npos) << two;
  EXPECT_LT(two.find("here asks /a"), two.find("127.0.0.1 asks /b")) << two;
  EXPECT_NE(two.find("Own: header\r\n"), std::string::npos) << two;
  const std::string head = answer_to("HEAD /a HTTP/1.0\r\nhOST: x\r\n\r\n");
  EXPECT_NE(head.find("Content-Length: 9\r\n"), std::string::npos) << head;
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
}

TEST_F(HttpServerTest, RefusesWhatIsNotARequestToRead) {
  EXPECT_EQ(answer_to("POST / HTTP/1.1\r\n\r\n").find("HTTP/1.1 405"), 0U);
  EXPECT_EQ(answer_to("nonsense\r\n\r\n").find("HTTP/1.1 400"), 0U);
  EXPECT_EQ(answer_to("GET / HTTP/1.1\r\nno colon\r\n\r\n").find("HTTP/1.1 400"), 0U);
  EXPECT_EQ(answer_to("GET / HTTP/9\r\n\r\n").find("HTTP/1.1 400"), 0U);
}

TEST_F(HttpServerTest, KeepsNoMoreOfARequestThanItNeeds) {
  const std::string long_header = "Long: " + std::string(2 * HttpServer::longest_request, 'x');
  const Client client{server_.port()};
  client.send("GET / HTTP/1.1\r\n" + long_header);  // and no end
  EXPECT_EQ(client.receive().find("HTTP/1.1 431"), 0U);
}

TEST_F(HttpServerTest, SlowClientsHoldUpNobody) {
  std::vector<std::unique_ptr<Client>> slow;
  for (int n = 0; n < 400; ++n) {
    slow.push_back(std::make_unique<Client>(server_.port()));
    slow.back()->send("GET / HT");
  }
  EXPECT_NE(answer_to(get("/c")).find("asks /c"), std::string::npos);
}

using WatchServerTest = testing::RunSceneTest;

TEST_F(WatchServerTest, OnlyWhoHasTheAddressReadsTheRun) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 100});
  const RunFolder folder{root_ / "a"};
  WatchServer first{folder, {}, 0};
  WatchServer server{folder, {}, 0};
  const std::string address = server.address();
  const std::size_t slash = address.find('/', std::string{"http://"}.size());
  const std::string home = address.substr(slash);
  const int port = std::stoi(address.substr(address.rfind(':', slash) + 1));
  EXPECT_EQ(home.size(), 34U) << address;
  EXPECT_NE(first.address().substr(slash), home);
  std::thread thread{[&] { server.serve(); }};
  const auto status = [&](const std::string& path) {
    return Client{port}.answer_to(get(path)).substr(9, 3);
  };
  EXPECT_EQ(status(home + "version"), "200");
  EXPECT_EQ(status(home + "piece/0/head"), "200");
  EXPECT_EQ(status(home + "piece/0/frame/100"), "200");
  EXPECT_EQ(status(home + "piece/0/frame/101"), "404");
  EXPECT_EQ(status(home + "scene.toml"), "404");
  EXPECT_EQ(status("/version"), "403");
  EXPECT_EQ(status("/piece/0/head"), "403");
  EXPECT_EQ(status("/" + std::string(32, '0') + "/version"), "403");
  // A history that cannot be shown ends an answer, not the server.
  const std::string history = read_file(folder.history());
  write_file(folder.history(), "no\nrows,fit\n");
  EXPECT_EQ(status(home + "piece/0/head"), "503");
  write_file(folder.history(), history);
  EXPECT_EQ(status(home + "piece/0/head"), "200");
  server.stop();
  thread.join();
}

}  // namespace
}  // namespace reckon
