// tests/image/test_images.h - encoded images and folders for the image tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/png_builder.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <webp/encode.h>

namespace obscura::testing_images {

inline std::filesystem::path temporary_folder(const std::string& name) {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::temp_directory_path() /
           ("obscura_" + name + "_" + std::to_string(::getpid()) + "_" + info->name());
}

/// A fixture with an empty folder of its own, removed afterwards.
class FolderTest : public testing::Test {
protected:
    void SetUp() override {
        folder_ = temporary_folder("image");
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

inline ByteVector to_bytes(const void* data, size_t count) {
    const auto* begin = static_cast<const std::byte*>(data);
    return ByteVector(begin, begin + count);
}

inline ByteVector read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(stream)),
                           std::istreambuf_iterator<char>());
    return to_bytes(text.data(), text.size());
}

inline void write_bytes(const std::filesystem::path& file, const ByteVector& bytes) {
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
}

/// Encodes by OpenImageIO into memory; `pixels` has the type and size that `spec` says.
inline ByteVector encode_with_oiio(const char* format, OIIO::ImageSpec spec, const void* pixels) {
    spec.attribute("oiio:UnassociatedAlpha", 1);
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput stream(encoded);
    const auto output = OIIO::ImageOutput::create(format);
    EXPECT_TRUE(output && output->set_ioproxy(&stream) && output->open(format, spec) &&
                output->write_image(spec.format, pixels) && output->close())
        << OIIO::geterror();
    return to_bytes(encoded.data(), encoded.size());
}

/// 8-bit test pattern: smooth, every channel different; alpha (of four) from 0 to 255.
inline std::vector<unsigned char> pattern(int width, int height, int channels) {
    std::vector<unsigned char> codes;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int values[] = {
                x * 255 / width, y * 255 / height, 255 - x * 128 / width, (x * 7 + y * 5) % 256};
            for (int c = 0; c < channels; ++c)
                codes.push_back(static_cast<unsigned char>(values[c]));
        }
    }
    return codes;
}

inline ByteVector png_pattern(int width, int height, int channels) {
    const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    return encode_with_oiio("png", spec, pattern(width, height, channels).data());
}

inline ByteVector jpeg_pattern(int width, int height, int channels, bool progressive = false) {
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("compression", "jpeg:98");
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("jpeg:progressive", progressive ? 1 : 0);
    return encode_with_oiio("jpeg", spec, pattern(width, height, channels).data());
}

inline ByteVector webp_pattern(int width, int height, bool lossless) {
    const std::vector<unsigned char> codes = pattern(width, height, 4);
    uint8_t* data = nullptr;
    const size_t size = lossless
                            ? WebPEncodeLosslessRGBA(codes.data(), width, height, 4 * width, &data)
                            : WebPEncodeRGBA(codes.data(), width, height, 4 * width, 95.0f, &data);
    const ByteVector bytes = to_bytes(data, size);
    WebPFree(data);
    return bytes;
}

}  // namespace obscura::testing_images
