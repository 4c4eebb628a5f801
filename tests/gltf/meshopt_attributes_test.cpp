// tests/gltf/meshopt_attributes_test.cpp - version 1 of the attribute codec, in all its modes.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/meshopt_attributes.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <bit>
#include <cstring>

namespace obscura::gltf {
namespace {

using namespace test;

/// An encoder that chooses modes at random: it compresses badly, but covers the whole format.
class Encoder {
public:
    Encoder(std::string data, size_t stride, uint64_t seed)
        : data_(std::move(data)), stride_(stride), random_(seed) {
        for (size_t channel = 0; channel < stride / 4; ++channel) {
            const uint32_t mode = random_.next_uint() % 3;
            modes_ += static_cast<char>(mode == 2 ? 2 + (random_.next_uint() % 16) * 16 : mode);
        }
    }

    std::string encode() {
        const size_t count = data_.size() / stride_;
        const size_t most = std::min<size_t>(8192 / stride_ / 16 * 16, 256);
        std::string out = "\xa1";
        for (size_t first = 0; first < count; first += most)
            out += block(first, std::min(most, count - first));
        const size_t tail = stride_ + stride_ / 4;
        if (tail < 24) out += std::string(24 - tail, '\0');
        return out + data_.substr(0, stride_) + modes_;
    }

private:
    uint32_t word(size_t element, size_t channel) const {
        uint32_t out = 0;
        std::memcpy(&out, data_.data() + element * stride_ + 4 * channel, 4);
        return out;
    }

    template <typename T>
    static uint32_t zigzags(uint32_t value, uint32_t before) {
        uint32_t out = 0;
        for (unsigned shift = 0; shift < 32; shift += 8 * sizeof(T)) {
            const T delta = static_cast<T>((value >> shift) - (before >> shift));
            const bool negative = delta >> (8 * sizeof(T) - 1) != 0;
            const T coded = static_cast<T>(negative ? ~(delta << 1) : delta << 1);
            out |= static_cast<uint32_t>(coded) << shift;
        }
        return out;
    }

    uint32_t delta(size_t element, size_t channel) const {
        const uint32_t value = word(element, channel);
        const uint32_t before = word(element == 0 ? 0 : element - 1, channel);
        const auto mode = static_cast<uint8_t>(modes_[channel]);
        if (mode == 0) return zigzags<uint8_t>(value, before);
        if (mode == 1) return zigzags<uint16_t>(value, before);
        return std::rotl(value ^ before, mode >> 4);
    }

    std::string block(size_t first, size_t elements) {
        std::string controls(stride_ / 4, '\0');
        std::string body;
        for (size_t k = 0; k < stride_; ++k) {
            std::string deltas;
            for (size_t i = 0; i < elements; ++i)
                deltas += static_cast<char>(delta(first + i, k / 4) >> (k % 4 * 8));
            const bool zero = deltas.find_first_not_of('\0') == std::string::npos;
            const uint32_t chance = random_.next_uint() % 3;
            const uint32_t control = zero && chance == 0 ? 2 : chance == 2 ? 3 : chance;
            controls[k / 4] =
                static_cast<char>(controls[k / 4] | static_cast<int>(control << (k % 4 * 2)));
            if (control == 3) body += deltas;
            if (control < 2) body += groups(deltas, control);
        }
        return controls + body;
    }

    std::string groups(std::string deltas, uint32_t control) {
        deltas.resize((deltas.size() + 15) / 16 * 16);
        const size_t count = deltas.size() / 16;
        std::string header((count + 3) / 4, '\0');
        std::string body;
        constexpr unsigned widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
        for (size_t g = 0; g < count; ++g) {
            const std::string group = deltas.substr(16 * g, 16);
            uint32_t choice = random_.next_uint() % 4;
            const bool zero = group.find_first_not_of('\0') == std::string::npos;
            if (widths[control][choice] == 0 && !zero) choice = 3;
            header[g / 4] =
                static_cast<char>(header[g / 4] | static_cast<int>(choice << (g % 4 * 2)));
            body += packed(group, widths[control][choice]);
        }
        return header + body;
    }

    static std::string packed(const std::string& group, unsigned bits) {
        if (bits == 0) return {};
        if (bits == 8) return group;
        const unsigned ones = (1U << bits) - 1;
        std::string out(2 * bits, '\0');
        std::string whole;
        for (size_t i = 0; i < 16; ++i) {
            const unsigned value = std::min<unsigned>(static_cast<uint8_t>(group[i]), ones);
            const unsigned slot = static_cast<unsigned>(i) % (8 / bits);
            const unsigned shift = bits == 1 ? slot : 8 - bits * (slot + 1);
            char& byte = out[i * bits / 8];
            byte = static_cast<char>(static_cast<uint8_t>(byte) | value << shift);
            if (value == ones) whole += group[i];
        }
        return out + whole;
    }

    std::string data_;
    size_t stride_;
    Pcg32 random_;
    std::string modes_;
};

bool decode(const std::string& data, const ElementLayout& layout, std::string& out) {
    Bytes bytes(layout.count * layout.stride);
    const bool done = decode_attributes_v1(std::as_bytes(std::span(data)), layout, bytes);
    out = raw(bytes);
    return done;
}

std::string sample_data(size_t stride, size_t count, uint64_t seed) {
    Pcg32 random(seed);
    std::string out(stride * count, '\0');
    for (size_t i = 0; i < out.size(); ++i) {
        const uint32_t noise = random.next_uint();
        out[i] = static_cast<char>(i % stride % 4 == 0 ? noise : i / stride / 9);
    }
    return out;
}

TEST(MeshoptAttributes, EveryModeComesBack) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
        for (const size_t stride : {4U, 8U, 12U, 64U, 256U}) {
            for (const size_t count : {1U, 16U, 33U, 256U, 700U}) {
                const std::string data = sample_data(stride, count, seed);
                std::string out;
                ASSERT_TRUE(decode(Encoder(data, stride, seed).encode(), {count, stride}, out))
                    << stride << ' ' << count << ' ' << seed;
                EXPECT_EQ(out, data) << stride << ' ' << count << ' ' << seed;
            }
        }
    }
}

/// The deltas that the specification spells out for its example of 4-bit coding.
TEST(MeshoptAttributes, TheSpecificationsExampleIsReadAsItSays) {
    std::string data = "\xa1\xa9\x02\x17\x5f\xf0\xbc\x77\xa9\x21";
    data += std::string("\0\x34\xb5", 3) + std::string(24, '\0');
    std::string out;
    ASSERT_TRUE(decode(data, {16, 4}, out));
    int sum = 0;
    const int deltas[16] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    for (size_t i = 0; i < 16; ++i) {
        sum += deltas[i];
        EXPECT_EQ(static_cast<uint8_t>(out[4 * i]), static_cast<uint8_t>(sum)) << i;
        EXPECT_EQ(out.substr(4 * i + 1, 3), std::string(3, '\0'));
    }
}

TEST(MeshoptAttributes, CorruptDataAreRefusedOrDecodedButNeverMore) {
    const std::string data = sample_data(12, 100, 3);
    const std::string good = Encoder(data, 12, 3).encode();
    std::string out;
    for (size_t length = 0; length < good.size(); ++length)
        EXPECT_FALSE(decode(good.substr(0, length), {100, 12}, out)) << length;
    EXPECT_FALSE(decode(good + "x", {100, 12}, out));
    EXPECT_FALSE(decode(good, {99, 12}, out));
    EXPECT_FALSE(decode(good, {500, 12}, out));
    for (const char mode : {'\x03', '\x10', '\x11', '\x0f'}) {
        std::string bad = good;
        bad.back() = mode;
        EXPECT_FALSE(decode(bad, {100, 12}, out)) << static_cast<int>(mode);
    }
    Pcg32 random(4);
    size_t refused = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string damaged = good;
        damaged[random.next_uint() % damaged.size()] = static_cast<char>(random.next_uint());
        refused += decode(damaged, {100, 12}, out) ? 0 : 1;
    }
    EXPECT_GT(refused, 100U);
}

}  // namespace
}  // namespace obscura::gltf
