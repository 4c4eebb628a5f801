// tests/cli/denoise_test.cpp - obscura render --denoise, and what files say of it.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <numeric>

namespace obscura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class DenoiseOption : public Cli {
protected:
    ReadImage shot(std::vector<std::string> more, const std::string& file) const {
        const std::vector<std::string> common = {
            "--size", "40x30", "--spp", "8", "--float", "-o", file};
        more.insert(more.end(), common.begin(), common.end());
        expect_result(render("box.gltf", more), 0, "OK");
        return read_image_file(folder_ / file).value();
    }

    /// The values of the channels that begin so.
    static std::vector<float> values(const ReadImage& image, const std::string& prefix) {
        std::vector<float> out;
        for (size_t i = 0; i < image.pixels.size(); ++i) {
            const std::string& channel = image.channels[i % image.channels.size()];
            if (channel.starts_with(prefix)) out.push_back(image.pixels[i]);
        }
        return out;
    }
};

TEST_F(DenoiseOption, ChangesTheBeautyAndSaysSo) {
    const ReadImage noisy = shot({}, "noisy.exr");
    const ReadImage clean = shot({"--denoise"}, "clean.exr");
    EXPECT_EQ(clean.channels, noisy.channels) << "the layers that it needs are its own";
    EXPECT_NE(clean.pixels, noisy.pixels);
    EXPECT_EQ(values(clean, "A"), values(noisy, "A"));
    EXPECT_THAT(clean.spec.get_string_attribute("obscura:denoise"), HasSubstr("halves"));
    EXPECT_EQ(noisy.spec.get_string_attribute("obscura:denoise"), "");
    const auto sum = [](const std::vector<float>& all) {
        return std::accumulate(all.begin(), all.end(), 0.0);
    };
    EXPECT_NEAR(sum(clean.pixels) / sum(noisy.pixels), 1, 1e-4);
}

TEST_F(DenoiseOption, KeepsTheNoisyBeautyOnRequest) {
    const ReadImage noisy = shot({}, "noisy.exr");
    const ReadImage clean = shot({"--denoise", "--keep-noisy"}, "clean.exr");
    EXPECT_THAT(clean.channels, Contains("noisy.R"));
    EXPECT_EQ(values(clean, "noisy.R"), values(noisy, "R"));
    expect_result(render("box.gltf", {"--keep-noisy", "-o", "a.exr"}), 64, "E-USAGE-CONFLICT");
    expect_result(
        render("box.gltf", {"--denoise", "--keep-noisy", "-o", "a.png"}), 64, "E-USAGE-CONFLICT");
}

TEST_F(DenoiseOption, LeavesLayersOfDataAndKeepsWhatWasAskedFor) {
    const std::vector<std::string> layers = {"--aov", "normal,half_1,diffuse_direct"};
    std::vector<std::string> denoised = layers;
    denoised.emplace_back("--denoise");
    const ReadImage noisy = shot(layers, "noisy.exr");
    const ReadImage clean = shot(denoised, "clean.exr");
    EXPECT_EQ(clean.channels, noisy.channels);
    EXPECT_EQ(values(clean, "normal"), values(noisy, "normal"));
    EXPECT_EQ(values(clean, "half_1"), values(noisy, "half_1"));
    EXPECT_NE(values(clean, "diffuse_direct"), values(noisy, "diffuse_direct"));
}

/// Pixels that stop at 4, 8, 16 and 20 samples: with halves of different size the beauty would seem
/// to have light beside its samples, which would stay noisy.
TEST_F(DenoiseOption, TakesPixelsOfDifferentNumbersOfSamples) {
    const std::vector<std::string> adaptive = {
        "--noise-target", "0.02", "--spp-min", "4", "--spp", "20", "--float", "--size", "40x30"};
    std::vector<std::string> layers = {"--aov", "half_1,half_2", "-o", "noisy.exr"};
    layers.insert(layers.end(), adaptive.begin(), adaptive.end());
    expect_result(render("box.gltf", layers), 0, "OK");
    const ReadImage noisy = read_image_file(folder_ / "noisy.exr").value();
    std::vector<std::string> denoised = {"--denoise", "-o", "clean.exr"};
    denoised.insert(denoised.end(), adaptive.begin(), adaptive.end());
    expect_result(render("box.gltf", denoised), 0, "OK");
    const ReadImage clean = read_image_file(folder_ / "clean.exr").value();
    EXPECT_EQ(values(clean, "A"), values(noisy, "A"));
    EXPECT_NE(values(clean, "R"), values(noisy, "R"));
}

/// The scene names layers of its own, behind those that were asked for; masks are in a file.
TEST_F(DenoiseOption, GoesWithLightGroupsAndMasks) {
    const ReadImage clean =
        shot({"--denoise", "--light-groups", "each", "--segmentation", "m.png"}, "a.exr");
    EXPECT_THAT(clean.channels, Contains(testing::StartsWith("light_")));
    EXPECT_THAT(clean.channels, Not(Contains(testing::StartsWith("half_"))));
    EXPECT_THAT(clean.channels, Not(Contains(testing::StartsWith("segmentation"))));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "m.json"));
    const std::vector<float> beauty = values(clean, "R");
    std::vector<float> sum(beauty.size());
    for (size_t i = 0; i < clean.pixels.size(); ++i) {
        const std::string& channel = clean.channels[i % clean.channels.size()];
        if (channel.starts_with("light_") && channel.ends_with(".R"))
            sum[i / clean.channels.size()] += clean.pixels[i];
    }
    for (size_t i = 0; i < sum.size(); ++i)
        ASSERT_NEAR(sum[i], beauty[i], 1e-5f * beauty[i]) << i;
}

TEST_F(DenoiseOption, NeedsLightAndTwoSamples) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--spp", "1"},
                                                 {"--noise-target", "0.1", "--spp-min", "3"},
                                                 {"--integrator", "normal"},
                                                 {"--integrator", "ao"}}) {
        std::vector<std::string> all = {"--denoise", "-o", "a.exr"};
        all.insert(all.end(), more.begin(), more.end());
        expect_result(render("box.gltf", all), 64, "E-USAGE-CONFLICT");
    }
}

}  // namespace
}  // namespace obscura
