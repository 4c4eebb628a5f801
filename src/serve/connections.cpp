// serve/connections.cpp - threads that answer connections.
// SPDX-License-Identifier: Apache-2.0
#include "serve/connections.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <netinet/in.h>
#include <optional>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>

namespace obscura::serve {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The connection of this thread; null: it has none.
thread_local OpenConnection* own = nullptr;

Clock::rep now() {
    return Clock::now().time_since_epoch().count();
}

/// The client at the other end of a descriptor, if it is a connection to a port of this process:
/// address and port. Descriptors are used again, sometimes before it is noted that one was closed;
/// together with its client a connection is never taken for another.
std::optional<std::string> client_of(int descriptor, int port) {
    sockaddr_storage own = {}, client = {};
    socklen_t own_size = sizeof own, client_size = sizeof client;
    // In this order: between the two, a descriptor may become the other end of such a connection.
    const bool has_both =
        ::getpeername(descriptor, reinterpret_cast<sockaddr*>(&client), &client_size) == 0 &&
        ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &own_size) == 0;
    if (!has_both) return std::nullopt;
    int own_port = -1;
    if (own.ss_family == AF_INET)
        own_port = ntohs(reinterpret_cast<const sockaddr_in&>(own).sin_port);
    if (own.ss_family == AF_INET6)
        own_port = ntohs(reinterpret_cast<const sockaddr_in6&>(own).sin6_port);
    if (own_port != port) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(&client), client_size);
}

/// A connection that is not among the known ones: the one that was accepted last. The library hands
/// over what is to be done with it, but not its descriptor. Nothing: it has ended already.
template <typename IsKnown>
Socket new_connection(int port, const IsKnown& is_known) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/fd", error)) {
        const std::string name = entry.path().filename().string();
        int descriptor = -1;
        std::from_chars(name.data(), name.data() + name.size(), descriptor);
        if (descriptor < 0) continue;
        const std::optional<std::string> client = client_of(descriptor, port);
        if (client && !is_known(Socket{descriptor, port, *client}))
            return {descriptor, port, *client};
    }
    return {};
}

/// Closes a connection for its thread, which then ends it.
void close(const Socket& socket) {
    if (client_of(socket.descriptor, socket.port) == socket.client)
        ::shutdown(socket.descriptor, SHUT_RDWR);
}

}  // namespace

void note_request() {
    if (own != nullptr) own->latest_request = now();
}

void end_connection() {
    if (own == nullptr) return;
    const Socket& socket = own->socket;
    if (client_of(socket.descriptor, socket.port) != socket.client) return;
    ::shutdown(socket.descriptor, SHUT_WR);
    // What the client is still sending is taken: closed at once, the connection would be reset, and
    // the answer lost.
    constexpr std::chrono::seconds longest(2);
    const Clock::time_point end = Clock::now() + longest;
    char bytes[1 << 16];
    pollfd waiting = {socket.descriptor, POLLIN, 0};
    while (Clock::now() < end) {
        constexpr int slice_ms = 100;
        if (::poll(&waiting, 1, slice_ms) > 0 &&
            ::recv(socket.descriptor, bytes, sizeof bytes, MSG_DONTWAIT) <= 0)
            break;
    }
    close(socket);
}

std::function<bool()> client_is_gone() {
    return [socket = own != nullptr ? own->socket.descriptor : -1] {
        char byte = 0;
        if (socket < 0) return false;
        const ssize_t count = ::recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
        return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
    };
}

/// With mutex_ locked.
void ConnectionThreads::close_idlest() {
    const auto idlest =
        std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
            return a.latest_request < b.latest_request;
        });
    if (idlest == open_.end()) return;
    const Clock::duration idle(now() - idlest->latest_request);
    if (idle < patience_) return;
    close(idlest->socket);
    idlest->latest_request = now();  // it ends by itself
}

ConnectionThreads::Enqueued ConnectionThreads::enqueue(std::function<void()> task) {
    constexpr std::chrono::milliseconds interval(100);
    std::unique_lock lock(mutex_);
    const auto is_known = [&](const Socket& socket) {
        const auto is_it = [&](const auto& one) { return one.socket == socket; };
        return std::any_of(open_.begin(), open_.end(), is_it) ||
               std::any_of(waiting_.begin(), waiting_.end(), is_it);
    };
    Waiting added{new_connection(port_, is_known), std::move(task)};
    while (!changed_.wait_for(lock, interval, [&] { return has_room(); })) {
        if (is_ending_) return Enqueued(false);  // the process ends, and its sockets with it
        close_idlest();
    }
    waiting_.push_back(std::move(added));
    if (idle_ < waiting_.size()) threads_.emplace_back([this] { work(); });
    changed_.notify_all();
    return Enqueued(true);
}

void ConnectionThreads::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        ++idle_;
        changed_.notify_all();
        changed_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
        --idle_;
        if (waiting_.empty()) return;
        const Waiting connection = std::move(waiting_.front());
        waiting_.pop_front();
        const auto place = open_.emplace(open_.end());
        place->socket = connection.socket;
        place->latest_request = now();
        if (ends_) close(place->socket);
        own = &*place;
        lock.unlock();
        connection.task();
        lock.lock();
        own = nullptr;
        open_.erase(place);
    }
}

void ConnectionThreads::shutdown() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        for (const OpenConnection& one : open_)
            close(one.socket);
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

}  // namespace obscura::serve
