// tests/gltf/glb_test.cpp - the binary container, whole, broken and cut off (faults A).
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/glb.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

struct BadFile {
    const char* name;
    std::string bytes;
    int code;
    const char* id;
    const char* words;  ///< part of the message
};

void PrintTo(const BadFile& file, std::ostream* out) {
    *out << file.name;
}

std::string json_chunk() {
    return glb_chunk("JSON", R"({"asset":{"version":"2.0"}})", ' ');
}

std::string binary_chunk() {
    return glb_chunk(std::string_view("BIN\0", 4), "12345678", 0);
}

std::string with_length(std::string glb, uint32_t length) {
    return glb.replace(8, 4, u32(length));
}

const std::vector<BadFile>& bad_files() {
    static const std::vector<BadFile> files = {
        {"A1_empty", "", 65, "E-GLB-FORMAT", "empty"},
        {"A4_html", "<!DOCTYPE html><html>", 65, "E-GLB-FORMAT", "HTML"},
        {"A4_gzip", "\x1F\x8B\x08", 65, "E-GLB-FORMAT", "gzip"},
        {"A4_zip", "PK\x03\x04", 65, "E-GLB-FORMAT", "ZIP"},
        {"A4_png", "\x89PNG\r\n", 65, "E-GLB-FORMAT", "PNG"},
        {"A4_other_case", "GLTF" + glb_of(json_chunk()).substr(4), 65, "E-JSON-SYNTAX", "line 1"},
        {"A5_version_1", glb_of(json_chunk(), 1), 69, "E-VERSION", "version 1"},
        {"A5_version_3", glb_of(json_chunk(), 3), 69, "E-VERSION", "version 3"},
        {"A5_version_99", glb_of(json_chunk(), 99), 69, "E-VERSION", "version 99"},
        {"A6_truncated", with_length(glb_of(json_chunk()), 500), 65, "E-GLB-TRUNCATED", "500"},
        {"A8_chunk_too_long",
         glb_of(u32(1000) + "JSON{}  "),
         65,
         "E-GLB-CHUNK",
         "1000 bytes, but only 4"},
        {"A8_chunk_wraps", glb_of(u32(0xFFFFFFFFU) + "JSON{}  "), 65, "E-GLB-CHUNK", "4294967295"},
        {"A8_half_chunk_header",
         glb_of(json_chunk() + "abcd"),
         65,
         "E-GLB-TRUNCATED",
         "4 of the 8"},
        {"A9_binary_first", glb_of(binary_chunk() + json_chunk()), 65, "E-GLB-CHUNK", "not JSON"},
        {"A9_two_json", glb_of(json_chunk() + json_chunk()), 65, "E-GLB-CHUNK", "two JSON"},
        {"no_chunk", glb_of(""), 65, "E-GLB-CHUNK", "too short"},
    };
    return files;
}

class BadGlb : public testing::TestWithParam<BadFile> {};

TEST_P(BadGlb, IsRefusedWithItsReason) {
    const Loaded loaded = load_bytes(GetParam().bytes, "scene.glb");
    EXPECT_EQ(loaded.code(), GetParam().code);
    EXPECT_EQ(loaded.id(), GetParam().id);
    EXPECT_NE(loaded.text().find(GetParam().words), std::string::npos) << loaded.text();
}

INSTANTIATE_TEST_SUITE_P(Faults, BadGlb, testing::ValuesIn(bad_files()), [](const auto& row) {
    return std::string(row.param.name);
});

TEST(Glb, LoadsItsBinaryChunk) {
    const Loaded loaded = load_bytes(triangle_builder().glb(), "scene.glb");
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(loaded.scene->indices, (LargeArray<uint32_t>{0, 1, 2, 0}));
}

TEST(Glb, CutAtEveryByteIsAnErrorAndNeverACrash) {
    const std::string whole = triangle_builder().glb();
    const TempFolder folder;
    for (size_t length = 0; length < whole.size(); ++length) {
        const Loaded loaded = load_file(folder.write("cut.glb", whole.substr(0, length)));
        ASSERT_EQ(loaded.code(), 65) << "cut after " << length << " bytes";
    }
}

/// The same with a header that admits to the cut: chunks and buffers are then too short.
TEST(Glb, CutWithAnHonestLengthIsAnErrorToo) {
    const std::string whole = triangle_builder().glb();
    const TempFolder folder;
    for (size_t length = 12; length < whole.size(); ++length) {
        const std::string cut = with_length(whole.substr(0, length), static_cast<uint32_t>(length));
        const Loaded loaded = load_file(folder.write("cut.glb", cut));
        ASSERT_EQ(loaded.code(), 65) << "cut after " << length << " bytes";
    }
}

TEST(Glb, TrailingBytesWarn) {  // A7
    const Loaded loaded = load_bytes(triangle_builder().glb() + "tail", "scene.glb");
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("4 bytes behind the end"));
}

TEST(Glb, UnknownChunksAreSkipped) {  // A10
    const AssetBuilder builder = triangle_builder();
    const std::string whole = builder.glb() + glb_chunk("XTRA", "abcd", 0);
    const Loaded loaded =
        load_bytes(with_length(whole, static_cast<uint32_t>(whole.size())), "scene.glb");
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
}

TEST(Glb, UnknownSecondChunkLeavesNoBinary) {  // A10
    AssetBuilder builder = triangle_builder();
    json tree = builder.tree;
    tree["buffers"][0]["byteLength"] = builder.bytes.size();
    const std::string chunks = glb_chunk("JSON", tree.dump(), ' ') + glb_chunk("XTRA", "abcd", 0);
    EXPECT_EQ(load_bytes(glb_of(chunks), "scene.glb").id(), "E-BUF-SOURCE");  // A11
}

TEST(Glb, BufferLongerThanTheChunkIsAnError) {  // A12
    AssetBuilder builder = triangle_builder();
    json tree = builder.tree;
    tree["buffers"][0]["byteLength"] = builder.bytes.size() + 100;
    const Loaded loaded = load_bytes(glb_of(tree.dump(), builder.bytes), "scene.glb");
    EXPECT_EQ(loaded.code(), 65);
    EXPECT_EQ(loaded.id(), "E-BUF-LENGTH");
    tree["buffers"][0]["byteLength"] = 0;
    EXPECT_EQ(load_bytes(glb_of(tree.dump(), builder.bytes), "scene.glb").id(), "E-BUF-LENGTH");
}

TEST(Glb, MoreThanFourGigabytesIsRefusedUnread) {  // A13
    const TempFolder folder;
    const auto file = folder.write("huge.glb", triangle_builder().glb());
    std::filesystem::resize_file(file, (1ULL << 32) + 16);  // a hole, not data
    const Loaded loaded = load_file(file);
    EXPECT_EQ(loaded.code(), 65);
    EXPECT_EQ(loaded.id(), "E-GLB-SIZE");
}

TEST(Glb, UnalignedChunkWarns) {  // A15
    std::string text = R"({"asset":{"version":"2.0"}})";
    while (text.size() % 4 != 1)
        text += ' ';
    const std::string chunk = u32(static_cast<uint32_t>(text.size())) + "JSON" + text;
    const Loaded loaded = load_bytes(glb_of(chunk), "scene.glb");
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("not a multiple of 4"));
}

TEST(Glb, JsonPaddedWithZerosIsRead) {
    const std::string chunk = glb_chunk("JSON", R"({"asset":{"version":"2.0"}})", '\0');
    EXPECT_TRUE(load_bytes(glb_of(chunk + binary_chunk()), "scene.glb").scene);
}

}  // namespace
}  // namespace obscura::gltf
