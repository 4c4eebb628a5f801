// tests/gltf/buffers_test.cpp - sources of buffers, and arithmetic that cannot overflow.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/buffers.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace obscura::gltf {
namespace {

using namespace test;

/// The same answer in 128 bits, where nothing overflows.
std::optional<uint64_t> exact_extent(const ElementRange& range, uint64_t total) {
    using Wide = unsigned __int128;
    if (range.offset > total) return std::nullopt;
    if (range.count == 0) return 0;
    const Wide extent = static_cast<Wide>(range.count - 1) * range.stride + range.element_size;
    if (extent + range.offset > total) return std::nullopt;
    return static_cast<uint64_t>(extent);
}

/// Numbers of every size, and those around powers of two.
uint64_t any_size(Pcg32& random) {
    const uint64_t bits = static_cast<uint64_t>(random.next_uint()) << 32 | random.next_uint();
    const uint64_t value = bits >> (random.next_uint() % 64);
    return random.next_uint() % 4 == 0 ? (1ULL << (random.next_uint() % 64)) - value % 3 : value;
}

TEST(Buffers, RangesAgreeWithExactArithmetic) {
    Pcg32 random(11);
    size_t inside = 0;
    for (int i = 0; i < 2000000; ++i) {
        const ElementRange range{
            any_size(random), any_size(random), any_size(random), any_size(random)};
        const uint64_t total = any_size(random);
        const std::optional<uint64_t> expected = exact_extent(range, total);
        ASSERT_EQ(range_extent(range, total), expected)
            << range.offset << ' ' << range.stride << ' ' << range.count << ' '
            << range.element_size << ' ' << total;
        inside += expected.has_value() ? 1 : 0;
    }
    EXPECT_GT(inside, 1000U);  // both answers were tried
}

TEST(Buffers, CheckedSpanIsTheRange) {
    const Bytes bytes(100);
    const auto span = checked_span(bytes, {10, 20, 4, 8});
    ASSERT_TRUE(span);
    EXPECT_EQ(span->data(), bytes.data() + 10);
    EXPECT_EQ(span->size(), 68U);
    EXPECT_TRUE(checked_span(bytes, {92, 8, 1, 8}));
    EXPECT_FALSE(checked_span(bytes, {93, 8, 1, 8}));
    EXPECT_FALSE(checked_span({}, {0, 1, 1, 1}));
}

/// The triangle with its buffer in a file.
json external_asset(const std::string& uri) {
    AssetBuilder builder = triangle_builder();
    json tree = builder.tree;
    tree["buffers"][0] = {{"byteLength", builder.bytes.size()}, {"uri", uri}};
    return tree;
}

TEST(Buffers, ExternalFilesAreRead) {
    const TempFolder folder;
    const std::string bytes = triangle_builder().bytes;
    folder.write("a b.bin", bytes);
    folder.write("long.bin", bytes + "more than byteLength says");
    for (const char* uri : {"a%20b.bin", "a b.bin", "./a b.bin", "long.bin"}) {
        const Loaded loaded = load_file(folder.write("s.gltf", external_asset(uri).dump()));
        ASSERT_TRUE(loaded.scene) << uri << ' ' << loaded.text();
        EXPECT_EQ(position_of(*loaded.scene, 1), (std::vector<float>{2, 0, 0}));
    }
}

TEST(Buffers, FolderMayBeTheCurrentOne) {
    const TempFolder folder;
    folder.write("a.bin", triangle_builder().bytes);
    folder.write("s.gltf", external_asset("a.bin").dump());
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const Loaded loaded = load_file("s.gltf");
    std::filesystem::current_path(before);
    EXPECT_TRUE(loaded.scene) << loaded.text();
}

TEST(Buffers, BadFilesAreErrors) {
    const TempFolder folder;
    folder.write("short.bin", triangle_builder().bytes.substr(1));
    struct Case {
        const char* uri;
        int code;
        const char* id;
    };
    for (const Case& c : {Case{"short.bin", 67, "E-RES-SHORT"},  // C20
                          Case{"absent.bin", 67, "E-RES-MISSING"},
                          Case{"../s.bin", 77, "E-URI-REFUSED"},
                          Case{"%2e%2e/s.bin", 77, "E-URI-REFUSED"},
                          Case{"https://example.org/s.bin", 77, "E-URI-REFUSED"}}) {
        const Loaded loaded = load_file(folder.write("s.gltf", external_asset(c.uri).dump()));
        EXPECT_EQ(loaded.code(), c.code) << c.uri;
        EXPECT_EQ(loaded.id(), c.id) << c.uri;
        EXPECT_NE(loaded.text().find("#/buffers/0"), std::string::npos) << loaded.text();
    }
}

}  // namespace
}  // namespace obscura::gltf
