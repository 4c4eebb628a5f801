// serve/connections.h - threads that answer connections: how many there are, and how they end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <httplib.h>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace obscura::serve {

/// To be called when a whole request has come, by the thread that answers it.
void note_request();

/// Closes the connection of this thread: the client gets what was sent, and nothing that comes
/// after is answered. Waits up to two seconds for what the client is still sending.
void end_connection();

/// Whether the client whose request this thread answers has gone; any thread may ask until the
/// answer is sent.
std::function<bool()> client_is_gone();

/// A connection, as long as its descriptor is that client's; none: it is not known.
struct Socket {
    int descriptor = -1;
    int port = -1;            ///< of this process
    std::string client = {};  ///< address and port

    bool operator==(const Socket&) const = default;
};

/// One that a thread answers.
struct OpenConnection {
    Socket socket = {};
    std::atomic<std::chrono::steady_clock::rep> latest_request = 0;
};

/// Answers each connection in a thread of its own, up to a number. Where all are taken, the one
/// that has asked for nothing longest is closed, once that is long enough: clients that send a byte
/// now and then, or nothing, keep nobody out. Where none has waited so long, new ones wait to be
/// accepted.
class ConnectionThreads final : public httplib::TaskQueue {
public:
    /// In      port: that the connections come to; max: threads; is_ending: when it becomes true,
    ///         nothing is accepted any more;
    ///         patience: with which connections are waited for, while others wait for a thread
    ConnectionThreads(int port,
                      size_t max,
                      const std::atomic<bool>& is_ending,
                      std::chrono::milliseconds patience = std::chrono::seconds(10))
        : port_(port), max_(max), is_ending_(is_ending), patience_(patience) {}

    using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));
    Enqueued enqueue(std::function<void()> task) override;
    /// Closes all connections, and waits for their threads.
    void shutdown() override;

private:
    /// A connection that is to be answered.
    struct Waiting {
        Socket socket;
        std::function<void()> task;
    };

    void work();
    bool has_room() const { return idle_ > waiting_.size() || threads_.size() < max_; }
    void close_idlest();

    const int port_;
    const size_t max_;
    const std::atomic<bool>& is_ending_;
    const std::chrono::milliseconds patience_;
    std::mutex mutex_;  ///< of what follows
    std::condition_variable changed_;
    std::deque<Waiting> waiting_;
    std::list<OpenConnection> open_;
    std::vector<std::thread> threads_;
    size_t idle_ = 0;
    bool ends_ = false;
};

}  // namespace obscura::serve
