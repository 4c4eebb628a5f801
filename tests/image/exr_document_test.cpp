// tests/image/exr_document_test.cpp - EXR files changed in some channels.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_document.h"

#include "image/exr_reading.h"
#include "image/exr_stream.h"
#include "image/test_images.h"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include "support/memory_limit.h"
#include "support/random.h"
#include <cstring>

namespace obscura {
namespace {

using namespace testing_images;

UnsetArray<float> random_values(size_t count, uint64_t seed) {
    Pcg32 random(seed);
    UnsetArray<float> values(count);
    for (float& value : values)
        value = 1000 * random.next_float() - 300;
    return values;
}

constexpr int columns = 37, rows = 23;
constexpr size_t pixel_count = size_t{columns} * size_t{rows};

/// A part of a larger image with two layers.
OutputImage image_of_layers() {
    OutputImage image{columns, rows, {"R", "G", "B", "A"}, random_values(4 * pixel_count, 1)};
    image.part_of = ImagePart{100, 80, 11, 7};
    image.layers.push_back({"key",
                            {"key.R", "key.G", "key.B"},
                            LayerKind::color,
                            random_values(3 * pixel_count, 2),
                            "C.*<L'key'>",
                            "mean"});
    image.layers.push_back(
        {"id", {"id.X"}, LayerKind::id, random_values(pixel_count, 3), "", "nearest"});
    return image;
}

ByteVector exr_of(const OutputImage& image, const ExrOptions& options) {
    ImageMetadata metadata;
    metadata.asset = "room.glb";
    metadata.standard.fstop = 2.8f;
    metadata.extra = {{"obscura:number", 3}, {"obscura:real", 0.5}};
    const Result<EncodedFile> file =
        encode_image({OutputFormat::exr, "a.exr"}, image, metadata, options, {});
    EXPECT_TRUE(file);
    return file->bytes;
}

ExrDocument document_of(const ByteVector& bytes) {
    Result<ExrDocument> out = ExrDocument::read(bytes, "a.exr");
    EXPECT_TRUE(out) << out.error().message;
    return *out;
}

std::string refusal(const ByteVector& bytes) {
    const Result<ExrDocument> out = ExrDocument::read(bytes, "a.exr");
    return out ? "accepted" : out.error().id;
}

/// An open file in memory.
struct OpenFile {
    explicit OpenFile(ByteVector from) : bytes(std::move(from)) {}
    ByteVector bytes;
    ExrMemoryReader stream{bytes, "a.exr"};
    Imf::MultiPartInputFile file{stream};
};

void expect_bits(const std::vector<float>& a, const std::vector<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

/// The part that has the beauty's red.
size_t beauty_part(const ExrDocument& document) {
    for (size_t i = 0; i < document.parts().size(); ++i) {
        for (const ExrChannel& channel : document.parts()[i].channels)
            if (channel.name == "R") return i;
    }
    return document.parts().size();
}

TEST(ExrDocument, TellsPartsChannelsAndAttributes) {
    const ExrDocument document =
        document_of(exr_of(image_of_layers(), {.layout = ExrLayout::multipart}));
    ASSERT_EQ(document.parts().size(), 3U);
    const ExrPartInfo& beauty = document.parts()[0];
    EXPECT_EQ(beauty.name, "rgba");
    EXPECT_EQ(beauty.width, columns);
    EXPECT_EQ(beauty.height, rows);
    EXPECT_EQ(beauty.place.width, 100);
    EXPECT_EQ(beauty.place.x, 11);
    EXPECT_EQ(beauty.place.y, 7);
    ASSERT_EQ(beauty.channels.size(), 4U);
    EXPECT_TRUE(beauty.channels[0].is_half);
    EXPECT_FALSE(document.parts()[2].channels[0].is_half);
    EXPECT_EQ(std::get<std::string>(beauty.attributes.at("obscura:asset")), "room.glb");
    EXPECT_EQ(std::get<int>(beauty.attributes.at("obscura:number")), 3);
    EXPECT_EQ(std::get<double>(beauty.attributes.at("obscura:real")), 0.5);
    EXPECT_EQ(std::get<float>(beauty.attributes.at("aperture")), 2.8f);
    EXPECT_EQ(std::get<std::string>(document.parts()[1].attributes.at("obscura:expression")),
              "C.*<L'key'>");
}

TEST(ExrDocument, ReadsInterleavedValues) {
    const OutputImage image = image_of_layers();
    const ExrDocument document = document_of(exr_of(image, {.depth = ExrDepth::float32}));
    const std::vector<std::string> names = {"key.R", "key.G", "key.B"};
    const Result<UnsetArray<float>> values = document.values(0, names);
    ASSERT_TRUE(values);
    EXPECT_EQ(*values, image.layers[0].pixels);
}

/// Whatever the layout, depth, codec and tiles: only what is changed changes.
class Rewriting : public testing::TestWithParam<ExrOptions> {};

TEST_P(Rewriting, ChangesNothingElse) {
    const ByteVector before = exr_of(image_of_layers(), GetParam());
    const ExrDocument document = document_of(before);
    ExrChange change{beauty_part(document), {"R", "G", "B"}, random_values(3 * pixel_count, 9)};
    const UnsetArray<float> colors = change.pixels;
    const std::vector<ExrChange> changes = {std::move(change)};
    const std::vector<ImageAttribute> attributes = {{"obscura:denoise", "yes"}};
    const Result<EncodedFile> after = document.with_changes(changes, attributes);
    ASSERT_TRUE(after) << after.error().message;
    OpenFile old_file(before);
    OpenFile new_file(after->bytes);
    ASSERT_EQ(new_file.file.parts(), old_file.file.parts());
    for (int part = 0; part < new_file.file.parts(); ++part) {
        const Imf::Header& header = new_file.file.header(part);
        const Imf::Header& old = old_file.file.header(part);
        EXPECT_EQ(text_of(header, "obscura:denoise"), "yes");
        EXPECT_TRUE(header.dataWindow() == old.dataWindow());
        EXPECT_TRUE(header.displayWindow() == old.displayWindow());
        for (auto one = old.begin(); one != old.end(); ++one) {
            const std::string name = one.name();
            if (name == "compression" || name == "chunkCount") continue;
            const Imf::Attribute& now = header[name];
            EXPECT_STREQ(now.typeName(), one.attribute().typeName()) << name;
        }
        const Channels was = channels_of(old_file.file, part);
        const Channels now = channels_of(new_file.file, part);
        ASSERT_EQ(now.size(), was.size());
        for (const auto& [name, values] : was) {
            if (name != "R" && name != "G" && name != "B") expect_bits(now.at(name), values);
        }
    }
    if (GetParam().depth == ExrDepth::half) return;
    expect_exact(channels_of(new_file.file, static_cast<int>(beauty_part(document))),
                 {"R", "G", "B"},
                 colors);
}

INSTANTIATE_TEST_SUITE_P(
    Storage,
    Rewriting,
    testing::Values(ExrOptions{},
                    ExrOptions{.depth = ExrDepth::float32},
                    ExrOptions{.layout = ExrLayout::multipart},
                    ExrOptions{.depth = ExrDepth::float32, .layout = ExrLayout::multipart},
                    ExrOptions{.compression = ExrCompression::b44},
                    ExrOptions{.compression = ExrCompression::piz},
                    ExrOptions{.layout = ExrLayout::multipart, .compression = ExrCompression::dwaa},
                    ExrOptions{.layout = ExrLayout::multipart, .compression = ExrCompression::b44},
                    ExrOptions{.layout = ExrLayout::multipart,
                               .compression = ExrCompression::pxr24},
                    ExrOptions{.depth = ExrDepth::float32, .tile_size = 16},
                    ExrOptions{.depth = ExrDepth::float32, .tile_size = 16, .mipmap = true},
                    ExrOptions{.layout = ExrLayout::multipart, .tile_size = 8, .mipmap = true}));

TEST(ExrDocument, KeepsTheCodecUnlessItWouldRoundWhatStays) {
    const auto codec_after = [](ExrLayout layout, ExrCompression codec) {
        const ExrDocument document =
            document_of(exr_of(image_of_layers(), {.layout = layout, .compression = codec}));
        const std::vector<ExrChange> changes = {
            {beauty_part(document), {"R", "G", "B"}, random_values(3 * pixel_count, 9)}};
        const Result<EncodedFile> after = document.with_changes(changes, {});
        EXPECT_TRUE(after);
        OpenFile file(after->bytes);
        const Imf::Compression now = file.file.header(0).compression();
        EXPECT_EQ(after->report.lossless_instead, now != static_cast<Imf::Compression>(codec));
        return now;
    };
    EXPECT_EQ(codec_after(ExrLayout::single, ExrCompression::piz), Imf::PIZ_COMPRESSION);
    EXPECT_EQ(codec_after(ExrLayout::multipart, ExrCompression::dwaa), Imf::DWAA_COMPRESSION);
    EXPECT_EQ(codec_after(ExrLayout::multipart, ExrCompression::b44), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(codec_after(ExrLayout::single, ExrCompression::b44), Imf::ZIP_COMPRESSION);
}

TEST(ExrDocument, MakesSmallerCopiesOfWhatChanged) {
    const ExrOptions options = {.depth = ExrDepth::float32, .tile_size = 16, .mipmap = true};
    OutputImage image = image_of_layers();
    const ExrDocument document = document_of(exr_of(image, options));
    image.pixels = random_values(4 * pixel_count, 9);
    const std::vector<ExrChange> changes = {{0, image.channels, image.pixels}};
    const Result<EncodedFile> after = document.with_changes(changes, {});
    ASSERT_TRUE(after) << after.error().message;
    OpenFile changed(after->bytes);
    OpenFile written(exr_of(image, options));
    for (int level = 0; level < 6; ++level) {
        EXPECT_EQ(level_of(changed.file, 0, level), level_of(written.file, 0, level)) << level;
    }
}

TEST(ExrDocument, AddsChannelsAndParts) {
    const UnsetArray<float> pixels = random_values(3 * pixel_count, 9);
    const std::vector<std::string> channels = {"noisy.R", "noisy.G", "noisy.B"};
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart}) {
        const ExrDocument document = document_of(exr_of(image_of_layers(), {.layout = layout}));
        ExrChange change{0, channels, pixels, ExrDepth::float32, {{"obscura:kind", "color"}}};
        if (layout == ExrLayout::multipart) change.new_part = "noisy";
        const std::vector<ExrChange> changes = {std::move(change)};
        const Result<EncodedFile> after = document.with_changes(changes, {});
        ASSERT_TRUE(after) << after.error().message;
        OpenFile file(after->bytes);
        const int part = layout == ExrLayout::multipart ? 3 : 0;
        ASSERT_EQ(file.file.parts(), part + 1);
        const Channels found = channels_of(file.file, part);
        expect_exact(found, channels, pixels);
        EXPECT_EQ(found.size(), part == 0 ? 11U : 3U);
        EXPECT_EQ(text_of(file.file.header(part), "obscura:kind"), "color");
    }
}

TEST(ExrDocument, RefusesWhatIsNoSuchFile) {
    EXPECT_EQ(refusal({}), "E-EXR-FORMAT");
    constexpr char png[] = "\x89PNG\r\n\x1a\n and more";
    EXPECT_EQ(refusal(to_bytes(png, sizeof png)), "E-EXR-FORMAT");
}

/// Cut anywhere: in the header, in the table of offsets, in the pixels.
TEST(ExrDocument, RefusesWhatIsCutOffOrDamaged) {
    const ByteVector whole = exr_of(image_of_layers(), {.layout = ExrLayout::multipart});
    const std::vector<std::string> names = {"R", "G", "B"};
    const std::vector<ExrChange> changes = {{0, names, random_values(3 * pixel_count, 9)}};
    const auto cut = [&](size_t length) {
        return ByteVector(whole.begin(), whole.begin() + static_cast<long>(length));
    };
    for (const size_t length : {size_t{4}, size_t{9}, size_t{200}})
        EXPECT_EQ(refusal(cut(length)), "E-EXR-CORRUPT") << length;
    const Result<EncodedFile> short_pixels =
        document_of(cut(whole.size() - 100)).with_changes(changes, {});
    ASSERT_FALSE(short_pixels);
    EXPECT_EQ(short_pixels.error().id, "E-EXR-CORRUPT");
    ByteVector damaged = exr_of(image_of_layers(), {});
    std::fill(damaged.end() - 3000, damaged.end() - 100, std::byte{0xFF});
    const ExrDocument document = document_of(damaged);
    const Result<UnsetArray<float>> values = document.values(0, names);
    ASSERT_FALSE(values);
    EXPECT_EQ(values.error().id, "E-EXR-CORRUPT");
    const Result<EncodedFile> after = document.with_changes(changes, {});
    ASSERT_FALSE(after);
    EXPECT_EQ(after.error().id, "E-EXR-CORRUPT");
}

TEST(ExrDocument, SaysThatThereIsNoMemory) {
    const ExrDocument document = document_of(exr_of(image_of_layers(), {}));
    const std::vector<std::string> names = {"R", "G", "B"};
    const test::MemoryLimit limit(3 * pixel_count * sizeof(float));
    const Result<UnsetArray<float>> values = document.values(0, names);
    ASSERT_FALSE(values);
    EXPECT_EQ(values.error().id, "E-EXR-MEMORY");
}

/// Places of a text's end in a file.
size_t end_of(const std::string& text, const ByteVector& bytes) {
    const ByteVector wanted = to_bytes(text.c_str(), text.size() + 1);
    const auto found = std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
    return static_cast<size_t>(found - bytes.begin()) + wanted.size();
}

/// OpenEXR allocates tables by the data window.
TEST(ExrDocument, RefusesSidesBeyondTheLimitAndNone) {
    ByteVector bytes = exr_of(image_of_layers(), {});
    const size_t window = end_of("box2i", bytes) + sizeof(int32_t);
    const auto with_bottom = [&](int32_t bottom) {
        ByteVector out = bytes;
        std::memcpy(&out[window + 3 * sizeof(int32_t)], &bottom, sizeof bottom);
        return refusal(out);
    };
    EXPECT_EQ(with_bottom(1 << 21), "E-EXR-LIMIT");
    EXPECT_EQ(with_bottom(-1), "E-EXR-CORRUPT");
}

}  // namespace
}  // namespace obscura
