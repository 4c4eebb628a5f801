// tests/base/sha256_test.cpp - SHA-256 against the examples of its standard.
// SPDX-License-Identifier: Apache-2.0
#include "base/sha256.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace obscura {
namespace {

/// Source  FIPS 180-2, appendix B: "abc", and a million of "a"
TEST(Sha256, OfTheStandardsExamples) {
    const TempFolder folder;
    const auto digest = digest_file(folder.write("abc", "abc"));
    ASSERT_TRUE(digest);
    EXPECT_EQ(digest->bytes, 3U);
    EXPECT_EQ(digest->sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    const auto longer = digest_file(folder.write("a", std::string(1000000, 'a')));
    ASSERT_TRUE(longer);
    EXPECT_EQ(longer->sha256, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    EXPECT_FALSE(digest_file(folder / "none"));
}

TEST(Sha256, OfBytesInMemory) {
    const std::string text = "abc";
    EXPECT_EQ(sha256_of(std::as_bytes(std::span(text))),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_of({}),  // known everywhere as that of nothing
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace obscura
