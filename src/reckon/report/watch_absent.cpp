// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/error.hpp"
#include "reckon/report/watch_server.hpp"

namespace reckon {

struct WatchServer::Impl {};

WatchServer::WatchServer(RunFolder /*folder*/, PageLimits /*limits*/, int /*port*/) {
  throw Error{{.place = "watch",
               .problem = "this reckon was built without the server",
               .reason = "cpp-httplib was not found when it was configured",
               .fix = "Install libcpp-httplib-dev (tools/install_dependencies.sh build), then "
                      "configure and build again; or use `reckon report`."}};
}
WatchServer::~WatchServer() = default;
int WatchServer::port() const { return 0; }
void WatchServer::serve() {}
void WatchServer::stop() {}

}  // namespace reckon
