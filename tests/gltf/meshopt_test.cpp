// tests/gltf/meshopt_test.cpp - compressed buffer views decode to the original, or to an error.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/meshopt.h"

#include "gltf/gltf_files.h"
#include "gltf/meshopt_encode.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <array>
#include <cmath>
#include <meshoptimizer.h>

namespace obscura::gltf {
namespace {

using namespace test;

/// One compressed view and nothing else.
struct OneView {
    std::string data;
    GltfMeshopt layout;
    uint64_t offset = 0;  ///< of the data in their buffer

    Result<Bytes> decode() const {
        Document document;
        document.file = "test.gltf";
        document.buffers.resize(2);
        GltfBufferView view;
        view.buffer = 1;
        view.byte_length = layout.count * layout.byte_stride;
        view.meshopt = layout;
        view.meshopt.buffer = 0;
        view.meshopt.byte_offset = offset;
        view.meshopt.byte_length = data.size();
        document.views.push_back(view);
        BufferStore store;
        store.buffers.resize(2);
        const std::string all = std::string(offset, 'x') + data;
        store.buffers[0] = std::as_bytes(std::span(all));
        const Result<void> done = decode_meshopt(document, store);
        if (!done) return fail(done.error());
        const std::span<const std::byte> bytes = view_bytes(document, store, 0);
        return Bytes(bytes.begin(), bytes.end());
    }
};

template <typename T>
std::vector<T> values_of(const Bytes& bytes) {
    std::vector<T> out(bytes.size() / sizeof(T));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
    return out;
}

constexpr MeshoptMode attributes = MeshoptMode::attributes;
constexpr MeshoptMode triangles = MeshoptMode::triangles;
constexpr MeshoptMode indices = MeshoptMode::indices;

/// A strip of triangles over `columns` columns.
std::vector<uint32_t> grid_indices(uint32_t columns) {
    std::vector<uint32_t> out;
    for (uint32_t i = 0; i + 1 < columns; ++i) {
        const uint32_t a = 2 * i;
        out.insert(out.end(), {a, a + 1, a + 2, a + 2, a + 1, a + 3});
    }
    return out;
}

TEST(Meshopt, AttributesComeBackByteByByte) {
    Pcg32 random(5);
    for (const size_t stride : {4U, 8U, 12U, 20U, 256U}) {
        for (const size_t count : {1U, 15U, 16U, 17U, 257U, 1000U}) {
            std::string data(stride * count, '\0');
            for (size_t i = 0; i < data.size(); ++i) {
                // Slow and fast bytes, so that every width of the codec occurs.
                const uint32_t noise = random.next_uint();
                data[i] = static_cast<char>(i % stride % 3 == 0 ? noise : i / stride / 7);
            }
            const OneView view{encode_attributes(data, stride), {0, 0, 0, stride, count}, 3};
            const Result<Bytes> bytes = view.decode();
            ASSERT_TRUE(bytes) << bytes.error().message;
            EXPECT_EQ(raw(*bytes), data) << stride << ' ' << count;
        }
    }
}

TEST(Meshopt, IndicesComeBackInBothModesAndWidths) {
    const std::vector<uint32_t> order = grid_indices(300);
    const std::vector<uint16_t> narrow(order.begin(), order.end());
    const std::string listed = encode_triangles(order);
    const std::string sequence = encode_sequence(order);
    const uint64_t count = order.size();
    const auto list32 = OneView{listed, {0, 0, 0, 4, count, triangles}}.decode();
    const auto list16 = OneView{listed, {0, 0, 0, 2, count, triangles}}.decode();
    const auto sequence32 = OneView{sequence, {0, 0, 0, 4, count, indices}}.decode();
    const auto sequence16 = OneView{sequence, {0, 0, 0, 2, count, indices}}.decode();
    ASSERT_TRUE(list32 && list16 && sequence32 && sequence16);
    EXPECT_EQ(values_of<uint32_t>(*sequence32), order);
    EXPECT_EQ(values_of<uint16_t>(*sequence16), narrow);
    // The codec of triangles may turn one round; it keeps their order and winding.
    const std::vector<uint32_t> wide = values_of<uint32_t>(*list32);
    const std::vector<uint16_t> thin = values_of<uint16_t>(*list16);
    for (size_t t = 0; t < order.size(); t += 3) {
        bool same = false;
        for (size_t turn = 0; turn < 3; ++turn) {
            same =
                same || (wide[t] == order[t + turn] && wide[t + 1] == order[t + (turn + 1) % 3] &&
                         wide[t + 2] == order[t + (turn + 2) % 3]);
        }
        EXPECT_TRUE(same) << "triangle " << t / 3;
        EXPECT_EQ(thin[t], wide[t]);
    }
}

std::array<float, 4> random_quaternion(Pcg32& random, int components) {
    std::array<float, 4> q = {};
    float length = 0;
    for (int i = 0; i < components; ++i) {
        q[static_cast<size_t>(i)] = 2 * random.next_float() - 1;
        length += q[static_cast<size_t>(i)] * q[static_cast<size_t>(i)];
    }
    for (float& value : q)
        value /= std::sqrt(length);
    return q;
}

/// Unit vectors through the octahedral filter, as bytes and as shorts.
TEST(Meshopt, OctahedralFilterGivesTheDirections) {
    Pcg32 random(6);
    constexpr size_t count = 300;
    std::vector<float> vectors;
    for (size_t i = 0; i < count; ++i) {
        const auto v = random_quaternion(random, 3);
        vectors.insert(vectors.end(), v.begin(), v.end());
    }
    for (const size_t stride : {4U, 8U}) {
        std::string filtered(count * stride, '\0');
        meshopt_encodeFilterOct(
            filtered.data(), count, stride, stride == 4 ? 8 : 14, vectors.data());
        const OneView view{encode_attributes(filtered, stride),
                           {0, 0, 0, stride, count, attributes, MeshoptFilter::octahedral}};
        const Result<Bytes> bytes = view.decode();
        ASSERT_TRUE(bytes);
        for (size_t i = 0; i < count; ++i) {
            for (size_t axis = 0; axis < 3; ++axis) {
                const size_t at = 4 * i + axis;
                const float value =
                    stride == 4 ? static_cast<float>(values_of<int8_t>(*bytes)[at]) / 127.0f
                                : static_cast<float>(values_of<int16_t>(*bytes)[at]) / 32767.0f;
                EXPECT_NEAR(value, vectors[at], stride == 4 ? 0.03 : 5e-4);
            }
        }
    }
}

TEST(Meshopt, QuaternionFilterGivesTheRotations) {
    Pcg32 random(7);
    constexpr size_t count = 200;
    std::vector<float> rotations;
    for (size_t i = 0; i < count; ++i) {
        const auto q = random_quaternion(random, 4);
        rotations.insert(rotations.end(), q.begin(), q.end());
    }
    std::string filtered(count * 8, '\0');
    meshopt_encodeFilterQuat(filtered.data(), count, 8, 14, rotations.data());
    const OneView view{encode_attributes(filtered, 8),
                       {0, 0, 0, 8, count, attributes, MeshoptFilter::quaternion}};
    const Result<Bytes> bytes = view.decode();
    ASSERT_TRUE(bytes);
    const std::vector<int16_t> decoded = values_of<int16_t>(*bytes);
    for (size_t i = 0; i < count; ++i) {
        float dot = 0;  // q and -q are one rotation
        for (size_t c = 0; c < 4; ++c)
            dot += static_cast<float>(decoded[4 * i + c]) / 32767.0f * rotations[4 * i + c];
        EXPECT_NEAR(std::abs(dot), 1, 1e-4);
    }
}

TEST(Meshopt, ExponentialFilterGivesTheNumbers) {
    Pcg32 random(8);
    constexpr size_t count = 500;
    std::vector<float> numbers(3 * count);
    for (float& number : numbers)
        number = std::ldexp(random.next_float() - 0.5f, static_cast<int>(random.next_uint() % 40));
    // By hand: the library's encoder changes its parameters from version to version.
    std::string filtered(count * 12, '\0');
    for (size_t i = 0; i < numbers.size(); ++i) {
        const int exponent = std::ilogb(numbers[i]) - 21;
        const int mantissa = static_cast<int>(std::lrint(std::ldexp(numbers[i], -exponent)));
        const uint32_t word =
            static_cast<uint32_t>(exponent) << 24 | (static_cast<uint32_t>(mantissa) & 0xffffffU);
        std::memcpy(filtered.data() + 4 * i, &word, 4);
    }
    const OneView view{encode_attributes(filtered, 12),
                       {0, 0, 0, 12, count, attributes, MeshoptFilter::exponential}};
    const Result<Bytes> bytes = view.decode();
    ASSERT_TRUE(bytes);
    const std::vector<float> decoded = values_of<float>(*bytes);
    for (size_t i = 0; i < numbers.size(); ++i)
        EXPECT_NEAR(decoded[i], numbers[i], std::abs(numbers[i]) * 1e-6f);
}

/// Luma and chroma by the lifting that keeps integers: the inverse of KHR_meshopt_compression,
/// appendix B, filter 4, for colours of `bits` bits.
template <typename T>
std::string filtered_colors(const std::vector<std::array<int, 4>>& colors, int bits) {
    std::vector<T> out;
    const int bit = 1 << (bits - 1);
    for (const auto& [r, g, b, a] : colors) {
        const int co = (r - b) / 2;
        const int tmp = (r + b) / 2;
        const int y = (tmp + g) / 2;
        const int cg = (g - tmp) / 2;
        for (const int value : {y, co, cg, (a >> 1) | bit})
            out.push_back(static_cast<T>(value));
    }
    return raw(out);
}

TEST(Meshopt, ColorFilterGivesTheColours) {
    Pcg32 random(9);
    std::vector<std::array<int, 4>> colors = {{255, 255, 255, 255}, {0, 0, 0, 0}};
    for (int i = 0; i < 200; ++i) {
        const uint32_t word = random.next_uint();
        colors.push_back({static_cast<int>(word & 255),
                          static_cast<int>(word >> 8 & 255),
                          static_cast<int>(word >> 16 & 255),
                          static_cast<int>(word >> 24)});
    }
    for (const size_t stride : {4U, 8U}) {
        const std::string filtered = stride == 4 ? filtered_colors<uint8_t>(colors, 8)
                                                 : filtered_colors<uint16_t>(colors, 8);
        const OneView view{encode_attributes(filtered, stride),
                           {0, 0, 0, stride, colors.size(), attributes, MeshoptFilter::color}};
        const Result<Bytes> bytes = view.decode();
        ASSERT_TRUE(bytes);
        for (size_t i = 0; i < 4 * colors.size(); ++i) {
            const double value = stride == 4 ? values_of<uint8_t>(*bytes)[i] / 255.0
                                             : values_of<uint16_t>(*bytes)[i] / 65535.0;
            EXPECT_NEAR(value, colors[i / 4][i % 4] / 255.0, 3.01 / 255) << i;
        }
    }
}

TEST(Meshopt, CorruptDataAreErrors) {
    const std::string data = encode_attributes(std::string(12 * 100, 'a'), 12);
    const std::string list = encode_triangles(grid_indices(40));
    const std::string sequence = encode_sequence(grid_indices(40));
    const uint64_t count = grid_indices(40).size();
    for (const OneView& good : {OneView{data, {0, 0, 0, 12, 100}},
                                OneView{list, {0, 0, 0, 2, count, triangles}},
                                OneView{sequence, {0, 0, 0, 4, count, indices}}}) {
        ASSERT_TRUE(good.decode());
        for (size_t length = 0; length < good.data.size(); ++length) {
            OneView cut = good;
            cut.data.resize(length);
            const Result<Bytes> bytes = cut.decode();
            ASSERT_FALSE(bytes) << length;
            EXPECT_EQ(bytes.error().id, "E-MESHOPT-DATA");
            EXPECT_EQ(bytes.error().where, "test.gltf#/bufferViews/0");
        }
        OneView other = good;
        other.data[0] = 0x7f;
        ASSERT_FALSE(other.decode());
        EXPECT_EQ(other.decode().error().id, "E-MESHOPT-VERSION");
        Pcg32 random(10);
        for (int i = 0; i < 2000; ++i) {  // any answer, but always one
            OneView damaged = good;
            for (int flips = 0; flips < 3; ++flips) {
                damaged.data[random.next_uint() % damaged.data.size()] =
                    static_cast<char>(random.next_uint());
            }
            const Result<Bytes> bytes = damaged.decode();
            if (!bytes) continue;
            EXPECT_EQ(bytes->size(), good.layout.count * good.layout.byte_stride);
        }
    }
}

TEST(Meshopt, CountsThatTheDataCannotHoldAreErrorsBeforeMemoryIsAsked) {
    const std::string data = encode_attributes(std::string(12 * 100, 'a'), 12);
    const Result<Bytes> bytes = OneView{data, {0, 0, 0, 12, 1ULL << 40}}.decode();
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().id, "E-MESHOPT-DATA");
    const std::string large((max_decoded_bytes >> 10) + 1024, '\0');
    const Result<Bytes> huge =
        OneView{large, {0, 0, 0, 256, (max_decoded_bytes >> 8) + 1}}.decode();
    ASSERT_FALSE(huge);
    EXPECT_EQ(huge.error().id, "E-LIMIT-DECODED");
    EXPECT_EQ(static_cast<int>(huge.error().code), 77);
}

}  // namespace
}  // namespace obscura::gltf
