// tests/serve/guard_test.cpp - who may talk to the server.
// SPDX-License-Identifier: Apache-2.0
#include "serve/guard.h"

#include <gtest/gtest.h>

#include <set>

namespace obscura::serve {
namespace {

Sender sender(const std::string& host, const std::string& origin = "") {
    return {host, origin, "", ""};
}

std::string id_of(const Result<void>& result) {
    return result ? "OK" : result.error().id;
}

TEST(Guard, OnlyThisMachinesNamesAreItsOwn) {
    const Guard guard("127.0.0.1", "");
    for (const char* own : {"127.0.0.1:8420", "localhost:8420", "localhost", "[::1]:8420"})
        EXPECT_EQ(id_of(guard.check_site(sender(own))), "OK") << own;
    for (const char* other : {"evil.com", "evil.com:8420", "localhost.evil.com", "", "127.0.0.1.x"})
        EXPECT_EQ(id_of(guard.check_site(sender(other))), "E-SERVE-HOST") << other;
    const Guard one_address("192.168.7.9", "");
    EXPECT_EQ(id_of(one_address.check_site(sender("192.168.7.9:80"))), "OK");
    EXPECT_EQ(id_of(one_address.check_site(sender("localhost"))), "E-SERVE-HOST");
    const Guard long_address("fd00::7", "");
    EXPECT_EQ(id_of(long_address.check_site(sender("[fd00::7]:80"))), "OK");
    EXPECT_EQ(host_in_url("::1"), "[::1]");
    const Guard all_addresses("0.0.0.0", "");
    EXPECT_EQ(id_of(all_addresses.check_site(sender("render.studio:8420"))), "OK");
}

TEST(Guard, NamesThatLookLikeThisMachineAreNot) {
    for (const char* own : {"127.0.0.1", "127.7.7.7", "::1", "localhost"})
        EXPECT_TRUE(is_loopback(own)) << own;
    for (const char* other : {"127.example.com", "0.0.0.0", "192.168.7.9", "::", ""})
        EXPECT_FALSE(is_loopback(other)) << other;
}

TEST(Guard, PagesOfOtherSitesAreRefused) {
    const Guard guard("127.0.0.1", "");
    const std::string host = "localhost:8420";
    EXPECT_EQ(id_of(guard.check_site(sender(host, "http://localhost:8420"))), "OK");
    for (const char* origin : {"http://evil.com",
                               "null",
                               "http://localhost:3000",
                               "https://localhost:8420",
                               "http://localhost:8420.evil.com"})
        EXPECT_EQ(id_of(guard.check_site(sender(host, origin))), "E-SERVE-ORIGIN") << origin;
}

TEST(Guard, TheTokenMustBeRightInEveryCharacter) {
    const Guard guard("127.0.0.1", "abcd1234");
    const auto with = [&](const std::string& header, const std::string& query) {
        return id_of(guard.check_token({"localhost", "", header, query}));
    };
    EXPECT_EQ(with("Bearer abcd1234", ""), "OK");
    EXPECT_EQ(with("", "abcd1234"), "OK");
    for (const char* wrong : {"",
                              "abcd1234",
                              "Bearer ",
                              "Bearer abcd123",
                              "Bearer abcd12345",
                              "Bearer abcd1234abcd1234",
                              "Bearer Abcd1234",
                              "Bearer abcd1235",
                              "Bearer axxxxxx4",
                              "Basic abcd1234"})
        EXPECT_EQ(with(wrong, ""), "E-SERVE-TOKEN") << wrong;
    EXPECT_EQ(with("Bearer wrong", "abcd1234"), "E-SERVE-TOKEN");
    const Guard open("127.0.0.1", "");
    EXPECT_EQ(id_of(open.check_token({"localhost", "", "", ""})), "OK");
}

TEST(Guard, TokensAreLongAndNeverTheSame) {
    std::set<std::string> seen;
    for (int i = 0; i < 100; ++i) {
        const std::string token = random_token();
        EXPECT_EQ(token.size(), 32U);
        EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
        EXPECT_TRUE(seen.insert(token).second);
    }
}

}  // namespace
}  // namespace obscura::serve
