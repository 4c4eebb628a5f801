// serve/guard.cpp - who may talk to the server.
// SPDX-License-Identifier: Apache-2.0
#include "serve/guard.h"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <random>
#include <strings.h>

namespace obscura::serve {

namespace {

/// Every character is looked at, whether or not one before it differs.
bool are_equal(std::string_view given, std::string_view wanted) {
    size_t differences = given.size() ^ wanted.size();
    for (size_t i = 0; i < given.size(); ++i) {
        const char other = wanted.empty() ? '\0' : wanted[i % wanted.size()];
        differences |= static_cast<size_t>(static_cast<unsigned char>(given[i] ^ other));
    }
    return differences == 0;
}

/// "localhost:8420" without its port; "[::1]:8420" too.
std::string_view without_port(std::string_view host) {
    const size_t end = host.starts_with('[') ? host.find(']') : std::string_view::npos;
    if (end != std::string_view::npos) return host.substr(0, end + 1);
    return host.substr(0, host.find(':'));
}

}  // namespace

bool is_loopback(const std::string& address) {
    constexpr unsigned first_byte = 24;
    in_addr number = {};  // a name may begin with 127., too
    if (::inet_pton(AF_INET, address.c_str(), &number) == 1)
        return ntohl(number.s_addr) >> first_byte == IN_LOOPBACKNET;
    return address == "::1" || address == "localhost";
}

std::string host_in_url(const std::string& address) {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

Guard::Guard(const std::string& address, std::string token) : token_(std::move(token)) {
    if (address == "0.0.0.0" || address == "::") return;
    names_ = {host_in_url(address)};
    if (is_loopback(address)) names_.insert(names_.end(), {"localhost", "127.0.0.1", "[::1]"});
}

bool Guard::is_own_name(std::string_view host_and_port) const {
    if (names_.empty()) return true;
    const std::string_view name = without_port(host_and_port);
    return std::find(names_.begin(), names_.end(), name) != names_.end();
}

Result<void> Guard::check_site(const Sender& sender) const {
    if (!is_own_name(sender.host)) {
        return fail(ExitCode::refused,
                    "E-SERVE-HOST",
                    sender.host,
                    "the request's Host is not this server's; expected localhost, or the address "
                    "that it listens at");
    }
    const std::string own = "http://" + sender.host;
    if (sender.origin.empty() || sender.origin == own) return {};
    return fail(ExitCode::refused,
                "E-SERVE-ORIGIN",
                sender.origin,
                "a page of another site sent this; only the server's own page may");
}

Result<void> Guard::check_token(const Sender& sender) const {
    if (token_.empty()) return {};
    constexpr std::string_view scheme = "Bearer ";
    std::string_view given = sender.query_token;
    if (::strncasecmp(sender.authorization.c_str(), scheme.data(), scheme.size()) == 0)
        given = std::string_view(sender.authorization).substr(scheme.size());
    if (are_equal(given, token_)) return {};
    return fail(ExitCode::refused,
                "E-SERVE-TOKEN",
                "Authorization",
                "the token is missing or wrong; expected the header `Authorization: Bearer TOKEN` "
                "with the token that the server printed");
}

std::string random_token() {
    std::random_device source;
    constexpr std::string_view digits = "0123456789abcdef";
    std::string token;
    constexpr int words = 4, digits_of_word = 8;
    for (int word = 0; word < words; ++word) {
        uint32_t bits = source();
        for (int i = 0; i < digits_of_word; ++i, bits >>= 4U)
            token += digits[bits & 15U];
    }
    return token;
}

}  // namespace obscura::serve
