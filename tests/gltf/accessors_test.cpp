// tests/gltf/accessors_test.cpp - every component type, shape and layout of accessors.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/accessors.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace obscura::gltf {
namespace {

/// A document with one buffer, one view and accessors over it.
struct Store {
    Document document;
    BufferStore buffers;

    explicit Store(const std::vector<std::byte>& bytes, uint64_t stride = 0) {
        document.file = "a.gltf";
        document.buffers.push_back({"", {}, bytes.size()});
        document.views.push_back({0, 0, bytes.size(), stride, {}});
        buffers.owned.push_back(bytes);
        buffers.buffers.emplace_back(buffers.owned[0]);
    }

    int add(const GltfAccessor& accessor) {
        document.accessors.push_back(accessor);
        return static_cast<int>(document.accessors.size()) - 1;
    }

    std::vector<float> floats(const GltfAccessor& accessor, const ElementChoice& choice = {}) {
        const auto out = read_floats(document, buffers, add(accessor), choice);
        return out ? *out : std::vector<float>{};
    }
};

template <typename T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
    std::vector<std::byte> out(values.size() * sizeof(T));
    std::memcpy(out.data(), values.data(), out.size());
    return out;
}

GltfAccessor accessor_of(ComponentType component, uint64_t count, int rows, int columns = 1) {
    GltfAccessor out;
    out.view = 0;
    out.component = component;
    out.count = count;
    out.rows = rows;
    out.columns = columns;
    return out;
}

/// Reads extreme values of an integer type as they are and normalised.
template <typename T>
void check_integer(ComponentType component, const std::vector<float>& normalized) {
    using Limits = std::numeric_limits<T>;
    const std::vector<T> values = {Limits::lowest(), 0, Limits::max()};
    Store store(bytes_of(values));
    GltfAccessor accessor = accessor_of(component, 3, 1);
    EXPECT_EQ(
        store.floats(accessor),
        (std::vector<float>{static_cast<float>(values[0]), 0, static_cast<float>(values[2])}));
    accessor.normalized = true;
    EXPECT_EQ(store.floats(accessor), normalized);
}

TEST(Accessors, IntegersAsTheyAreAndNormalized) {
    check_integer<int8_t>(ComponentType::int8, {-1, 0, 1});
    check_integer<uint8_t>(ComponentType::uint8, {0, 0, 1});
    check_integer<int16_t>(ComponentType::int16, {-1, 0, 1});
    check_integer<uint16_t>(ComponentType::uint16, {0, 0, 1});
    check_integer<uint32_t>(ComponentType::uint32, {0, 0, 1});
}

TEST(Accessors, NormalizedSteps) {
    Store store(bytes_of(std::vector<int8_t>{-127, -128, 64, 1}));
    GltfAccessor accessor = accessor_of(ComponentType::int8, 4, 1);
    accessor.normalized = true;
    EXPECT_EQ(store.floats(accessor), (std::vector<float>{-1, -1, 64.0f / 127, 1.0f / 127}));
}

TEST(Accessors, FloatsPackedStridedAndMisaligned) {
    std::vector<float> values(24);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(i);
    Store packed(bytes_of(values));
    EXPECT_EQ(packed.floats(accessor_of(ComponentType::float32, 8, 3)), values);

    Store strided(bytes_of(values), 16);
    GltfAccessor accessor = accessor_of(ComponentType::float32, 3, 2);
    accessor.byte_offset = 4;
    EXPECT_EQ(strided.floats(accessor), (std::vector<float>{1, 2, 5, 6, 9, 10}));

    std::vector<std::byte> shifted = bytes_of(values);
    shifted.insert(shifted.begin(), std::byte{99});
    Store odd(shifted);
    accessor = accessor_of(ComponentType::float32, 2, 3);
    accessor.byte_offset = 1;
    EXPECT_TRUE(accessor_is_misaligned(odd.document, accessor));
    EXPECT_EQ(odd.floats(accessor), (std::vector<float>{0, 1, 2, 3, 4, 5}));
}

TEST(Accessors, MatrixColumnsStartAtMultiplesOfFour) {
    const std::vector<uint8_t> bytes = {1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99};
    Store store(bytes_of(bytes));
    const GltfAccessor mat3 = accessor_of(ComponentType::uint8, 1, 3, 3);
    EXPECT_EQ(element_size(mat3), 12U);
    EXPECT_EQ(store.floats(mat3), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));

    Store two(bytes_of(std::vector<uint8_t>{1, 2, 99, 99, 3, 4, 99, 99}));
    EXPECT_EQ(two.floats(accessor_of(ComponentType::uint8, 1, 2, 2)),
              (std::vector<float>{1, 2, 3, 4}));
    EXPECT_EQ(element_size(accessor_of(ComponentType::uint16, 1, 3, 3)), 24U);
    EXPECT_EQ(element_size(accessor_of(ComponentType::float32, 1, 4, 4)), 64U);
}

TEST(Accessors, ChosenElementsOnly) {
    Store store(bytes_of(std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7}));
    const std::vector<uint32_t> chosen = {3, 0, 3};
    EXPECT_EQ(store.floats(accessor_of(ComponentType::float32, 4, 2), {false, chosen}),
              (std::vector<float>{6, 7, 0, 1, 6, 7}));
}

/// Four floats 10 11 12 13 of which `indices` are replaced by 20, 21...
std::vector<float> sparse(const std::vector<uint16_t>& indices, const ElementChoice& choice) {
    std::vector<float> floats = {10, 11, 12, 13};
    for (size_t i = 0; i < indices.size(); ++i)
        floats.push_back(20.0f + static_cast<float>(i));
    std::vector<std::byte> bytes = bytes_of(floats);
    const std::vector<std::byte> tail = bytes_of(indices);
    bytes.insert(bytes.end(), tail.begin(), tail.end());
    Store store(bytes);
    GltfAccessor accessor = accessor_of(ComponentType::float32, 4, 1);
    accessor.sparse = {indices.size(), 0, 4 * floats.size(), ComponentType::uint16, 0, 16};
    EXPECT_EQ(accessor_problem(store.document, accessor), "");
    return store.floats(accessor, choice);
}

TEST(Accessors, SparseReplacesElements) {
    const std::vector<uint32_t> chosen = {3, 2, 1};
    EXPECT_EQ(sparse({1, 3}, {}), (std::vector<float>{10, 20, 12, 21}));
    EXPECT_EQ(sparse({1, 3}, {false, chosen}), (std::vector<float>{21, 12, 20}));
}

TEST(Accessors, SparseInAnyOrderLastOneCounts) {  // C9
    const std::vector<uint32_t> chosen = {1};
    EXPECT_EQ(sparse({3, 1, 1}, {}), (std::vector<float>{10, 22, 12, 20}));
    EXPECT_EQ(sparse({3, 1, 1}, {false, chosen}), (std::vector<float>{22}));
}

TEST(Accessors, SparseOverNothingReplacesZeros) {
    Store store(bytes_of(std::vector<float>{7, 8}));
    store.document.views.push_back({0, 0, 8, 0, {}});
    GltfAccessor accessor = accessor_of(ComponentType::float32, 3, 1);
    accessor.view = -1;
    EXPECT_EQ(store.floats(accessor), (std::vector<float>{0, 0, 0}));
    // 7.0f starts with a zero byte: the index of element 0, replaced by 8.
    accessor.sparse = {1, 0, 0, ComponentType::uint8, 1, 4};
    EXPECT_EQ(store.floats(accessor), (std::vector<float>{8, 0, 0}));
}

TEST(Accessors, IndicesMayBeSparse) {
    // Indices 10 11 12 13; elements 3, 1 and 1 become 20, 21 and 22: the last of equal ones counts.
    std::vector<std::byte> bytes = bytes_of(std::vector<uint16_t>{10, 11, 12, 13, 20, 21, 22});
    const std::vector<std::byte> tail = bytes_of(std::vector<uint8_t>{3, 1, 1});
    bytes.insert(bytes.end(), tail.begin(), tail.end());
    Store store(bytes);
    GltfAccessor accessor = accessor_of(ComponentType::uint16, 4, 1);
    accessor.sparse = {3, 0, 14, ComponentType::uint8, 0, 8};
    EXPECT_EQ(*read_indices(store.document, store.buffers, store.add(accessor)),
              (std::vector<uint32_t>{10, 22, 12, 20}));
    accessor.view = -1;
    EXPECT_EQ(*read_indices(store.document, store.buffers, store.add(accessor)),
              (std::vector<uint32_t>{0, 22, 0, 20}));
    accessor.count = 3;  // the sparse element 3 is behind the end
    EXPECT_FALSE(read_indices(store.document, store.buffers, store.add(accessor)));
}

TEST(Accessors, IndicesOfEverySize) {
    const auto read = [](const std::vector<std::byte>& bytes, ComponentType type, uint64_t stride) {
        Store store(bytes, stride);
        return *read_indices(store.document, store.buffers, store.add(accessor_of(type, 3, 1)));
    };
    const std::vector<uint32_t> expected = {5, 200, 3};
    EXPECT_EQ(read(bytes_of(std::vector<uint8_t>{5, 200, 3}), ComponentType::uint8, 0), expected);
    EXPECT_EQ(read(bytes_of(std::vector<uint16_t>{5, 200, 3}), ComponentType::uint16, 0), expected);
    EXPECT_EQ(read(bytes_of(std::vector<uint32_t>{5, 200, 3}), ComponentType::uint32, 0), expected);
    EXPECT_EQ(read(bytes_of(std::vector<uint16_t>{5, 9, 200, 9, 3}), ComponentType::uint16, 4),
              expected);
}

/// The buffer shrank between the check and the read: still no byte behind its end is touched.
TEST(Accessors, ShorterBuffersAreErrors) {
    Store store(bytes_of(std::vector<float>{1, 2, 3}));
    const int accessor = store.add(accessor_of(ComponentType::float32, 4, 1));
    const auto out = read_floats(store.document, store.buffers, accessor, {});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().id, "E-ACC-RANGE");
    EXPECT_EQ(out.error().where, "a.gltf#/accessors/0");
    const int index = store.add(accessor_of(ComponentType::uint16, 7, 1));
    EXPECT_FALSE(read_indices(store.document, store.buffers, index));
}

}  // namespace
}  // namespace obscura::gltf
