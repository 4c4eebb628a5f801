// serve/connections.cpp - threads that answer connections.
// SPDX-License-Identifier: Apache-2.0
#include "serve/connections.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <system_error>

namespace obscura::serve {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// When the connection of this thread last had a request; null: the thread has none.
thread_local std::atomic<Clock::rep>* own_time = nullptr;

/// The connection of this thread; -1: it is not known.
thread_local int own_socket = -1;

Clock::rep now() {
    return Clock::now().time_since_epoch().count();
}

/// Whether a descriptor is a connection to a port of this process.
bool is_connection(int descriptor, int port) {
    sockaddr_storage own = {}, other = {};
    socklen_t own_size = sizeof own, other_size = sizeof other;
    const bool has_both =
        ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &own_size) == 0 &&
        ::getpeername(descriptor, reinterpret_cast<sockaddr*>(&other), &other_size) == 0;
    if (!has_both) return false;
    if (own.ss_family == AF_INET)
        return ntohs(reinterpret_cast<const sockaddr_in&>(own).sin_port) == port;
    return own.ss_family == AF_INET6 &&
           ntohs(reinterpret_cast<const sockaddr_in6&>(own).sin6_port) == port;
}

/// A connection that is not among the known ones: the one that was accepted last. The library hands
/// over what is to be done with it, but not its descriptor. -1: there is none.
template <typename IsKnown>
int new_connection(int port, const IsKnown& is_known) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/fd", error)) {
        const std::string name = entry.path().filename().string();
        int descriptor = -1;
        std::from_chars(name.data(), name.data() + name.size(), descriptor);
        if (descriptor >= 0 && !is_known(descriptor) && is_connection(descriptor, port))
            return descriptor;
    }
    return -1;
}

}  // namespace

void note_request() {
    if (own_time != nullptr) *own_time = now();
}

std::function<bool()> client_is_gone() {
    return [socket = own_socket] {
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
            return a.second < b.second;
        });
    if (idlest == open_.end()) return;
    const Clock::duration idle(now() - idlest->second);
    if (idle < patience_) return;
    ::shutdown(idlest->first, SHUT_RDWR);
    idlest->second = now();  // it ends by itself
}

ConnectionThreads::Enqueued ConnectionThreads::enqueue(std::function<void()> task) {
    constexpr std::chrono::milliseconds interval(100);
    std::unique_lock lock(mutex_);
    const auto is_known = [&](int socket) {
        return open_.contains(socket) ||
               std::any_of(waiting_.begin(), waiting_.end(), [&](const Connection& one) {
                   return one.socket == socket;
               });
    };
    Connection added{new_connection(port_, is_known), std::move(task)};
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
        const Connection connection = std::move(waiting_.front());
        waiting_.pop_front();
        if (connection.socket >= 0) {
            open_[connection.socket] = now();
            own_time = &open_[connection.socket];
            own_socket = connection.socket;
            if (ends_) ::shutdown(connection.socket, SHUT_RDWR);
        }
        lock.unlock();
        connection.task();
        lock.lock();
        own_time = nullptr;
        own_socket = -1;
        open_.erase(connection.socket);
    }
}

void ConnectionThreads::shutdown() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        for (const auto& [socket, time] : open_)
            ::shutdown(socket, SHUT_RDWR);
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

}  // namespace obscura::serve
