// tests/image/exr_header_test.cpp - every attribute of an EXR's header, its type and its value.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_reading.h"
#include "image/test_images.h"

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <set>

namespace obscura {
namespace {

using namespace testing_images;

OutputImage four_pixels() {
    OutputImage image{2, 2, {"R", "G", "B"}, {}};
    image.pixels.resize(12);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.5f);
    return image;
}

class ExrHeader : public FolderTest {
protected:
    Imf::Header header_of(const ImageMetadata& metadata,
                          const OutputImage& image = four_pixels(),
                          const ExrOptions& options = {},
                          int part = 0) {
        const auto written = write_image_file(folder_ / "a.exr", image, metadata, options, {});
        EXPECT_TRUE(written) << written.error().message;
        const Imf::MultiPartInputFile file((folder_ / "a.exr").c_str());
        return file.header(part);
    }
};

template <typename T>
T value_of(const Imf::Header& header, const std::string& name) {
    const auto* attribute = header.findTypedAttribute<Imf::TypedAttribute<T>>(name);
    EXPECT_NE(attribute, nullptr) << name << " is missing or has another type";
    return attribute ? attribute->value() : T();
}

TEST_F(ExrHeader, ColoursAreThoseOfTheirSpace) {
    ImageMetadata metadata;
    metadata.space.interop_id = "lin_ap1_scene";
    metadata.space.primaries = ap1_primaries;
    metadata.space.white = aces_white;
    const Imf::Header header = header_of(metadata);
    EXPECT_EQ(value_of<std::string>(header, "colorInteropID"), "lin_ap1_scene");
    const auto found = value_of<Imf::Chromaticities>(header, "chromaticities");
    EXPECT_EQ(found.red, Imath::V2f(0.713f, 0.293f));
    EXPECT_EQ(found.white, Imath::V2f(0.32168f, 0.33767f));
    metadata.space.interop_id = "";
    const Imf::Header nameless = header_of(metadata);
    EXPECT_TRUE(nameless.find("colorInteropID") == nameless.end());
}

TEST_F(ExrHeader, NumbersAreNumbers) {
    ImageMetadata metadata;
    metadata.samples_per_pixel = 64;
    metadata.seed = 0x7FFFFFFF;
    metadata.extra = {{"obscura:warnings", 3},
                      {"obscura:timeSeconds", 0.1},
                      {"obscura:scale", 0.1f},
                      {"obscura:camera", "placed by hand"},
                      {"obscura:variant", ""}};
    const Imf::Header header = header_of(metadata);
    EXPECT_EQ(value_of<int>(header, "obscura:samplesPerPixel"), 64);
    EXPECT_EQ(value_of<int>(header, "obscura:seed"), 0x7FFFFFFF);
    EXPECT_EQ(value_of<int>(header, "obscura:warnings"), 3);
    EXPECT_EQ(value_of<double>(header, "obscura:timeSeconds"), 0.1);
    EXPECT_EQ(value_of<float>(header, "obscura:scale"), 0.1f);
    EXPECT_EQ(text_of(header, "obscura:camera"), "placed by hand");
    EXPECT_EQ(header.find("obscura:variant"), header.end());
    metadata.seed = 0x80000000ULL;
    EXPECT_EQ(text_of(header_of(metadata), "obscura:seed"), "2147483648") << "exact in any case";
}

TEST_F(ExrHeader, StandardAttributesAreOpenExrs) {
    ImageMetadata metadata;
    StandardAttributes& standard = metadata.standard;
    standard.world_to_camera.emplace();
    standard.world_to_ndc.emplace();
    for (size_t i = 0; i < 16; ++i) {
        (*standard.world_to_camera)[i] = static_cast<float>(i) / 2;
        (*standard.world_to_ndc)[i] = static_cast<float>(100 - i);
    }
    standard.screen_window_width = 1.5f;
    standard.screen_window_center = {-0.25f, 0.125f};
    standard.fstop = 2.8f;
    standard.exposure_s = 0.02f;
    standard.iso = 400;
    standard.focus_m = 3.5f;
    standard.white_luminance = 1;
    standard.time_code = TimeCode{1, 2, 3, 23};
    standard.capture_date = "2024:05:06 07:08:09";
    standard.is_latlong = true;
    const Imf::Header header = header_of(metadata);
    for (int i = 0; i < 16; ++i) {
        EXPECT_EQ(Imf::worldToCamera(header)[i / 4][i % 4], static_cast<float>(i) / 2);
        EXPECT_EQ(Imf::worldToNDC(header)[i / 4][i % 4], static_cast<float>(100 - i));
    }
    EXPECT_EQ(header.screenWindowWidth(), 1.5f);
    EXPECT_EQ(header.screenWindowCenter(), Imath::V2f(-0.25f, 0.125f));
    EXPECT_EQ(Imf::aperture(header), 2.8f);
    EXPECT_EQ(Imf::expTime(header), 0.02f);
    EXPECT_EQ(Imf::isoSpeed(header), 400);
    EXPECT_EQ(Imf::focus(header), 3.5f);
    EXPECT_EQ(Imf::whiteLuminance(header), 1);
    EXPECT_EQ(Imf::timeCode(header).hours(), 1);
    EXPECT_EQ(Imf::timeCode(header).minutes(), 2);
    EXPECT_EQ(Imf::timeCode(header).seconds(), 3);
    EXPECT_EQ(Imf::timeCode(header).frame(), 23);
    EXPECT_EQ(Imf::capDate(header), "2024:05:06 07:08:09");
    EXPECT_EQ(Imf::envmap(header), Imf::ENVMAP_LATLONG);
}

TEST_F(ExrHeader, FrameRatesAreFractions) {
    const std::pair<double, std::pair<int, unsigned>> rates[] = {
        {24, {24, 1}}, {23.976, {24000, 1001}}, {29.97, {30000, 1001}}, {12.5, {25, 2}}};
    for (const auto& [rate, fraction] : rates) {
        ImageMetadata metadata;
        metadata.standard.frame_rate_hz = rate;
        const Imf::Rational found = Imf::framesPerSecond(header_of(metadata));
        EXPECT_EQ(found.n, fraction.first);
        EXPECT_EQ(found.d, fraction.second);
    }
}

TEST_F(ExrHeader, WhatIsNotKnownIsNotSaid) {
    const Imf::Header header = header_of({});
    std::set<std::string> names;
    for (auto a = header.begin(); a != header.end(); ++a)
        names.insert(a.name());
    EXPECT_EQ(names,
              (std::set<std::string>{"channels",
                                     "chromaticities",
                                     "colorInteropID",
                                     "compression",
                                     "dataWindow",
                                     "displayWindow",
                                     "lineOrder",
                                     "obscura:kind",
                                     "obscura:samplesPerPixel",
                                     "obscura:seed",
                                     "pixelAspectRatio",
                                     "screenWindowCenter",
                                     "screenWindowWidth",
                                     "type"}));
    EXPECT_EQ(header.screenWindowWidth(), 1);
    EXPECT_EQ(header.screenWindowCenter(), Imath::V2f(0, 0));
}

TEST_F(ExrHeader, OnlyColoursHaveAWhite) {
    ImageMetadata metadata;
    metadata.standard.white_luminance = 1;
    metadata.is_color = false;
    EXPECT_FALSE(Imf::hasWhiteLuminance(header_of(metadata)));
}

/// OpenEXR, "Storing Multi-View Images": parts have `view`, and then none has `multiView`.
TEST_F(ExrHeader, TheViewsOfAnImageArePartsOfAMultipartFile) {
    ImageMetadata metadata;
    metadata.standard.views = {"left", "right"};
    const OutputImage image = four_pixels();
    const ExrOptions parts{.layout = ExrLayout::multipart};
    for (const auto& [part, view] : {std::pair{0, "left"}, std::pair{1, "right"}}) {
        const Imf::Header header = header_of(metadata, image, parts, part);
        EXPECT_EQ(header.view(), view);
        EXPECT_EQ(header.name(), std::string("rgba-") + view);
        EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {1, 0}));
        EXPECT_EQ(header.dataWindow(), Imath::Box2i({0, 0}, {1, 0}));
        EXPECT_FALSE(Imf::hasMultiView(header));
    }
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::separate}) {
        const Imf::Header header = header_of(metadata, image, {.layout = layout});
        EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {1, 1})) << "one above the other";
        EXPECT_FALSE(header.hasView() || Imf::hasMultiView(header));
    }
    EXPECT_FALSE(header_of({}, image, parts).hasView());
}

TEST_F(ExrHeader, EqualImagesAreEqualFiles) {
    ImageMetadata metadata;
    metadata.software = "Obscura 0.1.0";
    metadata.standard.time_code = TimeCode{0, 0, 1, 2};
    header_of(metadata);
    const ByteVector first = read_bytes(folder_ / "a.exr");
    header_of(metadata);
    EXPECT_EQ(read_bytes(folder_ / "a.exr"), first);
}

}  // namespace
}  // namespace obscura
