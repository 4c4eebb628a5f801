// tests/image/encode_exact_test.cpp - numbers that are no colours come back as they were written.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace obscura {
namespace {

template <typename T>
OiioType type_of() {
    if (sizeof(T) == 1) return OiioType::uint8;
    return sizeof(T) == 2 ? OiioType::uint16 : OiioType::float32;
}

template <typename T>
std::vector<std::byte> encoded(OutputFormat format, int channels, const std::vector<T>& values) {
    const int width = static_cast<int>(values.size()) / channels;
    const auto file =
        encode_exact({format, "numbers"}, {width, 1, channels, type_of<T>(), values.data()});
    EXPECT_TRUE(file) << file.error().message;
    return file ? *file : std::vector<std::byte>();
}

/// What another reader finds, in the type of the file.
template <typename T>
void expect_read_back(OutputFormat format, int channels, const std::vector<T>& values) {
    std::vector<std::byte> file = encoded(format, channels, values);
    OIIO::Filesystem::IOMemReader reader(file.data(), file.size());
    const bool is_png = format == OutputFormat::png;
    const auto input = OIIO::ImageInput::open(is_png ? "x.png" : "x.tif", nullptr, &reader);
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().nchannels, channels);
    EXPECT_EQ(input->spec().format, OIIO::TypeDesc(OIIO::BaseTypeFromC<T>::value));
    std::vector<T> found(values.size());
    ASSERT_TRUE(input->read_image(0, 0, 0, channels, input->spec().format, found.data()));
    EXPECT_EQ(std::memcmp(found.data(), values.data(), values.size() * sizeof(T)), 0);
}

TEST(EncodeExact, NumbersComeBack) {
    expect_read_back<uint8_t>(OutputFormat::png, 3, {0, 1, 2, 127, 128, 255, 7, 254, 3});
    expect_read_back<uint16_t>(OutputFormat::png, 1, {0, 1, 255, 256, 32766, 65535});
    constexpr float infinite = std::numeric_limits<float>::infinity();
    expect_read_back<float>(OutputFormat::tiff, 1, {0, 0.1f, 1e-30f, 12345.678f, infinite, -2});
}

TEST(EncodeExact, TheSameNumbersGiveTheSameBytes) {
    const std::vector<float> values = {1, 2, 3};
    EXPECT_EQ(encoded(OutputFormat::tiff, 1, values), encoded(OutputFormat::tiff, 1, values));
}

TEST(EncodeExact, APngSaysNothingOfColors) {
    const std::vector<uint8_t> values = {1, 2, 3};
    const std::vector<std::byte> file = encoded(OutputFormat::png, 3, values);
    const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    for (const char* chunk : {"sRGB", "gAMA", "cICP", "iCCP"})
        EXPECT_EQ(text.find(chunk), std::string::npos) << chunk;
}

TEST(EncodeExact, WhatAFormatCannotHoldIsAnError) {
    const std::vector<uint8_t> values = {1};
    const auto file =
        encode_exact({OutputFormat::png, "numbers"}, {0, 0, 1, OiioType::uint8, values.data()});
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().id, "E-OUT-ENCODE");
}

}  // namespace
}  // namespace obscura
