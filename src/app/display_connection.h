// app/display_connection.h - a connection to a viewer elsewhere, through which bytes go out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "session/render_request.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace obscura::app {

/// "viewer.example:14158", "127.0.0.1", "[::1]:14158"; without a port, that of tev.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE
Result<DisplayAddress> parse_display_address(const std::string& text, const std::string& option);

/// The same as text, always with its port.
std::string text_of(const DisplayAddress& address);

/// A TCP connection, closed with the object. What comes from the other side is thrown away.
class DisplayConnection {
public:
    /// In      gives_up: when it becomes true, what is being waited for fails soon
    explicit DisplayConnection(const std::atomic<bool>& gives_up) : gives_up_(gives_up) {}
    ~DisplayConnection();
    DisplayConnection(const DisplayConnection&) = delete;
    DisplayConnection& operator=(const DisplayConnection&) = delete;

    /// Connects to the first of the host's addresses that answers. Looking up a name may take long,
    /// whatever gives_up says. Returns why it failed; "": it did not.
    std::string open(const DisplayAddress& address);

    /// Sends bytes, however long the other side takes. Returns why it failed; "": all of them are
    /// on their way.
    ///
    /// In/Out  sent: rises with every byte that is
    std::string send(std::span<const std::byte> bytes, std::atomic<uint64_t>& sent);

private:
    std::string connect_to(const void* address, uint32_t size, int family);
    std::string wait_until_writable(double max_s) const;
    void close();

    const std::atomic<bool>& gives_up_;
    int socket_ = -1;
};

}  // namespace obscura::app
