// serve/server.h - the server: HTTP in front of the service, for the page and for programs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/jobs.h"
#include "serve/service.h"
#include <atomic>
#include <memory>
#include <string>

namespace obscura::serve {

struct ServerOptions {
    std::string address = "127.0.0.1";
    int port = 8420;    ///< 0: one that is free
    std::string token;  ///< that clients must know; empty: none is asked for
    ServiceOptions service;
    JobsOptions jobs;
};

/// Listens at one address. Every answer but a file, a picture and the page is JSON, errors too.
class Server {
public:
    /// Binds the address; clients wait until run().
    ///
    /// Errors  69 E-SERVE-LISTEN the address is not this machine's, or the port is taken
    static Result<std::unique_ptr<Server>> listen(ServerOptions options);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    int port() const;
    /// What a browser is to open, with the token, which is not sent; file: opened at once, unless
    /// it is empty.
    std::string url(const std::string& file = "") const;
    /// Answers until `stop` becomes true.
    void run(const std::atomic<bool>& stop);

private:
    struct Impl;
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace obscura::serve
