// tests/serve/connections_test.cpp - clients that keep connections keep nobody out.
// SPDX-License-Identifier: Apache-2.0
#include "serve/connections.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

namespace obscura::serve {
namespace {

/// A connection that sends the beginning of a request.
class SlowClient {
public:
    explicit SlowClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        is_connected_ =
            ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
            ::send(socket_, "GET", 3, MSG_NOSIGNAL) == 3;
    }
    ~SlowClient() { ::close(socket_); }
    SlowClient(const SlowClient&) = delete;
    SlowClient& operator=(const SlowClient&) = delete;

    bool is_connected() const { return is_connected_; }

private:
    int socket_;
    bool is_connected_ = false;
};

/// A server with so many threads, which is patient for so long.
class SmallServer {
public:
    explicit SmallServer(std::chrono::milliseconds patience, size_t threads = 2) {
        server_.new_task_queue = [=, this] {
            return new ConnectionThreads(port_, threads, is_ending_, patience);
        };
        server_.set_read_timeout(60);
        server_.Get("/", [](const httplib::Request& request, httplib::Response& response) {
            note_request();
            response.set_content("here", "text/plain");
            response.set_header("Port", std::to_string(request.remote_port));
        });
        server_.Get("/gone", [](const httplib::Request&, httplib::Response& response) {
            const auto is_gone = client_is_gone();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            response.set_content(is_gone() ? "gone" : "here", "text/plain");
        });
        port_ = server_.bind_to_any_port("127.0.0.1");
        thread_ = std::thread([this] { server_.listen_after_bind(); });
        while (!server_.is_running())
            std::this_thread::yield();
    }
    ~SmallServer() { end(); }
    SmallServer(const SmallServer&) = delete;
    SmallServer& operator=(const SmallServer&) = delete;

    void end() {
        if (!thread_.joinable()) return;
        is_ending_ = true;
        server_.stop();
        thread_.join();
    }
    int port() const { return port_; }

private:
    httplib::Server server_;
    std::atomic<bool> is_ending_ = false;
    int port_ = 0;
    std::thread thread_;
};

TEST(Connections, SlowOnesMakeRoom) {
    SmallServer server(std::chrono::milliseconds(200));
    const SlowClient a(server.port()), b(server.port()), c(server.port()), d(server.port());
    ASSERT_TRUE(a.is_connected() && b.is_connected() && c.is_connected() && d.is_connected());
    httplib::Client client("127.0.0.1", server.port());
    client.set_read_timeout(30);
    const auto answer = client.Get("/");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, "here");
}

/// The client's port, by which its connections differ.
std::string port_of(httplib::Client& client) {
    const auto answer = client.Get("/");
    return answer ? answer->get_header_value("Port") : "";
}

TEST(Connections, TheOneThatAskedLastStays) {
    SmallServer server(std::chrono::milliseconds(200));
    httplib::Client busy("127.0.0.1", server.port()), late("127.0.0.1", server.port());
    busy.set_keep_alive(true);
    const std::string port = port_of(busy);
    ASSERT_NE(port, "");
    const SlowClient idle(server.port());
    ASSERT_TRUE(idle.is_connected());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // until it has its thread
    EXPECT_EQ(port_of(busy), port);
    late.set_keep_alive(true);
    late.set_read_timeout(30);
    EXPECT_NE(port_of(late), "");
    EXPECT_EQ(port_of(busy), port);
}

TEST(Connections, NoneIsClosedBeforeItsTime) {
    SmallServer server(std::chrono::hours(1));
    httplib::Client first("127.0.0.1", server.port());
    first.set_keep_alive(true);
    const std::string port = port_of(first);
    const SlowClient a(server.port()), b(server.port());
    ASSERT_TRUE(a.is_connected() && b.is_connected());
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(port_of(first), port);
}

TEST(Connections, AreNotTakenForOthersThatCloseMeanwhile) {
    SmallServer server(std::chrono::hours(1), 8);
    std::atomic<bool> is_over = false;
    std::vector<std::thread> passers_by;
    for (int i = 0; i < 4; ++i) {
        passers_by.emplace_back([&] {
            while (!is_over)
                httplib::Client("127.0.0.1", server.port()).Get("/");
        });
    }
    int here = 0;
    constexpr int requests = 200;
    for (int i = 0; i < requests; ++i) {
        const auto answer = httplib::Client("127.0.0.1", server.port()).Get("/gone");
        here += answer && answer->body == "here" ? 1 : 0;
    }
    is_over = true;
    for (std::thread& thread : passers_by)
        thread.join();
    EXPECT_EQ(here, requests);
}

TEST(Connections, TheEndDoesNotWaitForThem) {
    SmallServer server(std::chrono::hours(1));
    const SlowClient a(server.port()), b(server.port()), c(server.port());
    ASSERT_TRUE(a.is_connected() && b.is_connected() && c.is_connected());
    const auto begin = std::chrono::steady_clock::now();
    server.end();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

}  // namespace
}  // namespace obscura::serve
