// serve/guard.h - who may talk to the server: its own page, and who knows the token.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace obscura::serve {

/// What of a request tells who sent it.
struct Sender {
    std::string host;           ///< the header Host
    std::string origin;         ///< the header Origin; empty: none, so no page of another site
    std::string authorization;  ///< "Bearer TOKEN"
    std::string query_token;    ///< for clients that can send no header
};

/// Decides by what browsers cannot forge for the page of another site.
class Guard {
public:
    /// In      address: that the server listens at; token: empty: none is asked for
    Guard(const std::string& address, std::string token);

    /// Whether the request is meant for this server: not for a name of someone else that was
    /// pointed here (DNS rebinding), nor by a page of another site.
    ///
    /// Errors  77 E-SERVE-HOST, E-SERVE-ORIGIN
    Result<void> check_site(const Sender& sender) const;
    /// Compares in a time that does not depend on the text.
    ///
    /// Errors  77 E-SERVE-TOKEN
    Result<void> check_token(const Sender& sender) const;

private:
    bool is_own_name(std::string_view host_and_port) const;

    std::vector<std::string>
        names_;  ///< empty: any, as the address stands for all of the machine's
    std::string token_;
};

/// Whether only this machine reaches an address: "127.0.0.1", "::1", "localhost".
bool is_loopback(const std::string& address);

/// An address as URLs and the header Host have it: IPv6 in brackets.
std::string host_in_url(const std::string& address);

/// 128 bits from the system's source of randomness, as 32 hexadecimal digits.
std::string random_token();

}  // namespace obscura::serve
