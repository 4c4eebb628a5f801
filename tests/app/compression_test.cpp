// tests/app/compression_test.cpp - names of codecs, and the levels of those that have one.
// SPDX-License-Identifier: Apache-2.0
#include "app/compression.h"

#include <gtest/gtest.h>

namespace obscura::app {
namespace {

std::string error_of(const std::string& text) {
    ExrOptions exr;
    const Result<void> parsed = parse_compression(text, "--compression", exr);
    return parsed ? "" : parsed.error().id;
}

TEST(Compression, EveryCodecHasItsName) {
    for (size_t i = 0; i < compression_names.size(); ++i) {
        ExrOptions exr;
        ASSERT_TRUE(parse_compression(compression_names[i].name, "--compression", exr));
        EXPECT_EQ(static_cast<size_t>(exr.compression), i) << compression_names[i].name;
        EXPECT_EQ(exr.dwa_level, 45) << "OpenEXR's own level";
    }
    EXPECT_EQ(static_cast<size_t>(ExrCompression::dwab), compression_names.size() - 1);
}

TEST(Compression, DwaHasALevel) {
    ExrOptions exr;
    ASSERT_TRUE(parse_compression("dwaa:12.5", "--compression", exr));
    EXPECT_EQ(exr.compression, ExrCompression::dwaa);
    EXPECT_EQ(exr.dwa_level, 12.5F);
    ASSERT_TRUE(parse_compression("dwab:0", "--compression", exr));
    EXPECT_EQ(exr.compression, ExrCompression::dwab);
    EXPECT_EQ(exr.dwa_level, 0);
}

TEST(Compression, MistakesSayWhatTheyAre) {
    EXPECT_EQ(error_of("zip2"), "E-USAGE-CHOICE");
    EXPECT_EQ(error_of(""), "E-USAGE-CHOICE");
    EXPECT_EQ(error_of("ZIP"), "E-USAGE-CHOICE");
    EXPECT_EQ(error_of("zip:5"), "E-USAGE-CONFLICT");
    EXPECT_EQ(error_of("dwaa:"), "E-USAGE-NUMBER");
    EXPECT_EQ(error_of("dwaa:much"), "E-USAGE-NUMBER");
    EXPECT_EQ(error_of("dwaa:-1"), "E-USAGE-RANGE");
}

}  // namespace
}  // namespace obscura::app
