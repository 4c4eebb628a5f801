// tests/film/murmur_hash_test.cpp - MurmurHash3 against published values.
// SPDX-License-Identifier: Apache-2.0
#include "film/murmur_hash.h"

#include <gtest/gtest.h>

#include <string>

namespace obscura {
namespace {

std::string bytes(std::initializer_list<int> values) {
    std::string out;
    for (const int value : values)
        out += static_cast<char>(value);
    return out;
}

struct KnownHash {
    std::string text;
    uint32_t seed;
    uint32_t hash;
};

/// From the tests of other implementations: texts of Apple's SwiftBloomFilter sample and of Split's
/// JavaScript SDK, bytes of MurmurHash.Net and of Bitcoin's hash_tests.cpp.
const KnownHash known_hashes[] = {
    {"", 0, 0},
    {"", 1, 0x514e28b7},
    {"", 0xffffffff, 0x81f16f39},
    {"test", 0, 0xba6bd213},
    {"test", 0x9747b28c, 0x704b81dc},
    {"Hello, world!", 0, 0xc0363e43},
    {"Hello, world!", 0x9747b28c, 0x24884cba},
    {"The quick brown fox jumps over the lazy dog", 0, 0x2e4ff723},
    {"The quick brown fox jumps over the lazy dog", 0x9747b28c, 0x2fa826cd},
    {"special characters a\xC3\xA7"
     "b\xE2\x86\x93"
     "c",
     0,
     0xbe83b140},
    {bytes({0xff, 0xff, 0xff, 0xff}), 0, 0x76293b50},
    {bytes({0x21, 0x43, 0x65, 0x87}), 0, 0xf55b516b},
    {bytes({0x21, 0x43, 0x65, 0x87}), 0x5082edee, 0x2362f9de},
    {bytes({0x21, 0x43, 0x65}), 0, 0x7e4a8634},
    {bytes({0x21, 0x43}), 0, 0xa0f7b07a},
    {bytes({0x21}), 0, 0x72661cf4},
    {bytes({0, 0, 0, 0}), 0, 0x2362f9de},
    {bytes({0, 0, 0}), 0, 0x85f0b427},
    {bytes({0, 0}), 0, 0x30f4c306},
    {bytes({0}), 0, 0x514e28b7},
    {bytes({0xff}), 0, 0xfd6cf10d},
    {bytes({0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}), 0, 0xb4698def},
};

TEST(MurmurHash, GivesThePublishedValues) {
    for (const KnownHash& known : known_hashes)
        EXPECT_EQ(murmur_hash(known.text, known.seed), known.hash) << known.text;
}

/// SMHasher's own check: keys 0, 1, ..., i - 1 with seed 256 - i for all i, and the hash of their
/// hashes. It covers every length of tail and both signs of char.
TEST(MurmurHash, PassesTheVerificationOfSmHasher) {
    std::string key;
    std::string hashes;
    for (uint32_t i = 0; i < 256; ++i) {
        const uint32_t hash = murmur_hash(key, 256 - i);
        for (int shift = 0; shift < 32; shift += 8)
            hashes += static_cast<char>(hash >> shift & 0xffu);
        key += static_cast<char>(i);
    }
    EXPECT_EQ(murmur_hash(hashes), 0xb0f57ee3);
}

}  // namespace
}  // namespace obscura
