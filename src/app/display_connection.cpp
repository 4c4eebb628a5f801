// app/display_connection.cpp - a connection to a viewer elsewhere, through which bytes go out.
// SPDX-License-Identifier: Apache-2.0
#include "app/display_connection.h"

#include "app/numbers.h"
#include "session/tev_packets.h"

#include <cerrno>
#include <chrono>
#include <memory>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace obscura::app {

namespace {

constexpr const char* given_up = "no more time";
constexpr int poll_period_ms = 50;
constexpr double connect_limit_s = 10;

std::string message_of(int error) {
    return std::generic_category().message(error);
}

/// Reads away what has come. False: the other side has closed the connection.
bool drain(int socket) {
    char bytes[256];
    while (true) {
        const ssize_t count = ::recv(socket, bytes, sizeof(bytes), MSG_DONTWAIT);
        if (count == 0) return false;
        if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    }
}

tl::unexpected<Error> no_address(const std::string& text, const std::string& option) {
    return fail(ExitCode::usage,
                "E-USAGE-NUMBER",
                option,
                in_quotes(text) +
                    " is no address; expected HOST or HOST:PORT, such as "
                    "127.0.0.1:14158 or [::1]:14158");
}

}  // namespace

Result<DisplayAddress> parse_display_address(const std::string& text, const std::string& option) {
    DisplayAddress out{text, tev_port};
    std::string port;
    const size_t colon = text.rfind(':');
    const size_t bracket = text.rfind(']');
    const bool is_in_brackets = text.starts_with('[') && bracket != std::string::npos;
    const bool has_port = colon != std::string::npos && (!is_in_brackets || colon == bracket + 1);
    if (has_port) {
        const Result<int64_t> number = parse_integer(text.substr(colon + 1), option, 1, 65535);
        if (!number) return fail(number.error());
        out = {text.substr(0, colon), static_cast<uint16_t>(*number)};
    }
    if (is_in_brackets) {
        if (out.host.back() != ']') return no_address(text, option);
        out.host = out.host.substr(1, out.host.size() - 2);
    } else if (out.host.find_first_of(":[]") != std::string::npos) {
        return no_address(text, option);
    }
    if (out.host.empty()) return no_address(text, option);
    return out;
}

std::string text_of(const DisplayAddress& address) {
    const bool is_version_6 = address.host.find(':') != std::string::npos;
    const std::string host = is_version_6 ? "[" + address.host + "]" : address.host;
    return host + ":" + std::to_string(address.port);
}

DisplayConnection::~DisplayConnection() {
    close();
}

void DisplayConnection::close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
}

std::string DisplayConnection::open(const DisplayAddress& address) {
    addrinfo wanted = {};
    wanted.ai_family = AF_UNSPEC;
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int error =
        ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found);
    if (error != 0) return ::gai_strerror(error);
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, &::freeaddrinfo);
    std::string reason = "the host has no address";
    for (const addrinfo* one = all.get(); one != nullptr; one = one->ai_next) {
        reason = connect_to(one->ai_addr, one->ai_addrlen, one->ai_family);
        if (reason.empty() || gives_up_) break;
    }
    return reason;
}

std::string DisplayConnection::connect_to(const void* address, uint32_t size, int family) {
    close();
    socket_ = ::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0) return message_of(errno);
    if (::connect(socket_, static_cast<const sockaddr*>(address), size) == 0) return "";
    if (errno != EINPROGRESS && errno != EINTR) return message_of(errno);
    if (std::string reason = wait_until_writable(connect_limit_s); !reason.empty()) return reason;
    int error = 0;
    socklen_t error_size = sizeof(error);
    if (::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &error_size) != 0) error = errno;
    return error == 0 ? "" : message_of(error);
}

/// In   max_s: 0: for as long as it takes
/// Out  why not; "": it is
std::string DisplayConnection::wait_until_writable(double max_s) const {
    const auto begin = std::chrono::steady_clock::now();
    while (!gives_up_) {
        pollfd state{socket_, POLLOUT | POLLIN, 0};
        const int count = ::poll(&state, 1, poll_period_ms);
        if (count < 0 && errno != EINTR) return message_of(errno);
        // An error shows in what is called next, which can say which one it is.
        if (count > 0 && (state.revents & (POLLOUT | POLLERR | POLLHUP)) != 0) return "";
        if (count > 0 && !drain(socket_)) return "it was closed there";
        const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
        if (max_s > 0 && waited.count() > max_s) return message_of(ETIMEDOUT);
    }
    return given_up;
}

std::string DisplayConnection::send(std::span<const std::byte> bytes, std::atomic<uint64_t>& sent) {
    while (!bytes.empty()) {
        if (std::string reason = wait_until_writable(0); !reason.empty()) return reason;
        // Unread bytes would make closing a reset, which takes back what is on its way.
        if (!drain(socket_)) return "it was closed there";
        const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
            return message_of(errno);
        if (count <= 0) continue;
        bytes = bytes.subspan(static_cast<size_t>(count));
        sent += static_cast<uint64_t>(count);
    }
    return "";
}

}  // namespace obscura::app
