// tests/render/aov_test.cpp - layers beside the beauty, against what the scene says by hand.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte.h"
#include "film/layers.h"
#include "image/channel_planes.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

namespace obscura::test {
namespace {

constexpr int width = 48;
constexpr int height = 32;
constexpr int samples = 24;

Material plain(float red, float roughness, float metallic) {
    Material m;
    m.base_color[0] = red;
    m.base_color[1] = 0.5f;
    m.base_color[2] = 0.25f;
    m.roughness = roughness;
    m.metallic = metallic;
    return m;
}

/// A wall that fills the view at z = 0, and a smaller sign in front of its middle, at z = 1. Nodes
/// 0 and 1 lie below node 2.
Scene wall_and_sign() {
    SceneBuilder builder;
    Material sign = plain(0.125f, 0.75f, 1.0f);
    sign.emission[1] = 2.0f;
    const int32_t wall_material = builder.material(plain(1.0f, 0.5f, 0.0f));
    const int32_t sign_material = builder.material(sign);
    builder.quad({-8, -8, 0}, {16, 0, 0}, {0, 16, 0}, wall_material);
    builder.quad({-0.51f, -0.47f, 1}, {1, 0, 0}, {0, 1, 0}, sign_material);
    builder.scene().info.node_names = {"wall", "sign", "room"};
    builder.scene().info.node_parents = {2, 2, -1};
    return builder.take();
}

Camera ahead() {
    return look_at({0, 0, 3}, {0, 0, 0}, 0.9f, width, height);
}

RenderOptions options_with(std::vector<std::string> names) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples_per_pixel = samples;
    options.layers = layers_of(names, 6).value();
    return options;
}

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const LayerDescription& layer : all_layers())
        names.push_back(layer.name);
    return names;
}

/// A rendering of wall_and_sign, and its layers by name.
class Layers : public testing::Test {
protected:
    void render_layers(const RenderOptions& options) {
        result = render_scene(wall_and_sign(), {constant_environment(1)}, ahead(), options);
    }
    const FilmLayer& layer(const std::string& name) const {
        for (const FilmLayer& one : result.film.layers) {
            if (one.layer.name == name) return one;
        }
        throw std::runtime_error("no layer " + name);
    }
    float at(const std::string& name, size_t pixel, size_t channel = 0) const {
        const FilmLayer& one = layer(name);
        return one.pixels[pixel * one.layer.channels.size() + channel];
    }

    RenderResult result;
};

constexpr size_t corner_pixel = 3 * width + 5;                     // shows the wall alone
constexpr size_t middle_pixel = (height / 2) * width + width / 2;  // shows the sign alone

TEST_F(Layers, TellWhatTheFirstHitIs) {
    render_layers(options_with(all_names()));
    ASSERT_EQ(result.film.layers.size(), all_layers().size());
    EXPECT_NEAR(at("depth", corner_pixel), 3, 1e-5);
    EXPECT_NEAR(at("depth", middle_pixel), 2, 1e-5);
    for (const size_t pixel : {corner_pixel, middle_pixel}) {
        const bool sign = pixel == middle_pixel;
        const Vec3f place{
            at("position", pixel, 0), at("position", pixel, 1), at("position", pixel, 2)};
        EXPECT_NEAR(place.z, sign ? 1 : 0, 1e-5);
        EXPECT_NEAR(at("distance", pixel), length(place - Vec3f{0, 0, 3}), 1e-5);
        EXPECT_NEAR(at("facing", pixel), at("depth", pixel) / at("distance", pixel), 0.02);
        for (const char* name : {"normal", "normal_geometric"}) {
            EXPECT_NEAR(at(name, pixel, 0), 0, 1e-6) << name;
            EXPECT_NEAR(at(name, pixel, 2), 1, 1e-6) << name;
        }
        EXPECT_NEAR(at("base_color", pixel, 0), sign ? 0.125 : 1, 1e-6);
        EXPECT_NEAR(at("base_color", pixel, 1), 0.5, 1e-6);
        EXPECT_NEAR(at("base_color", pixel, 2), 0.25, 1e-6);
        EXPECT_NEAR(at("roughness", pixel), sign ? 0.75 : 0.5, 1e-6);
        EXPECT_NEAR(at("metallic", pixel), sign ? 1 : 0, 1e-6);
        EXPECT_NEAR(at("emission_color", pixel, 1), sign ? 2 : 0, 1e-6);
        EXPECT_EQ(at("emission_color", pixel, 0), 0);
        EXPECT_EQ(at("opacity", pixel), 1);
        EXPECT_EQ(at("id_node", pixel), sign ? 2 : 1);
        EXPECT_EQ(at("id_material", pixel), sign ? 2 : 1);
        EXPECT_EQ(at("instance", pixel), 0);
        EXPECT_EQ(at("sample_count", pixel), samples);
    }
}

TEST_F(Layers, NearestTakesOneSampleAndMeanTakesAll) {
    RenderOptions options = options_with({"depth", "metallic", "id_node"});
    render_layers(options);
    int mixed = 0;
    for (size_t pixel = 0; pixel < size_t{width} * height; ++pixel) {
        const float sign = at("metallic", pixel);  // the share of the pixel that shows the sign
        EXPECT_NEAR(at("depth", pixel), sign > 0 ? 2 : 3, 1e-5);
        EXPECT_EQ(at("id_node", pixel), sign > 0 ? 2 : 1);
        mixed += sign > 0 && sign < 1 ? 1 : 0;
    }
    EXPECT_GT(mixed, 20);
}

TEST_F(Layers, LeaveTheBeautyAsItIs) {
    render_layers(options_with({}));
    const std::vector<float> alone(result.film.pixels.begin(), result.film.pixels.end());
    render_layers(options_with(all_names()));
    ASSERT_EQ(result.film.pixels.size(), alone.size());
    EXPECT_EQ(std::memcmp(result.film.pixels.data(), alone.data(), alone.size() * 4), 0);
}

TEST_F(Layers, DependOnNeitherTilesNorCrops) {
    RenderOptions options = options_with(all_names());
    render_layers(options);
    const RenderResult whole = std::move(result);
    options.tile_size = 7;
    options.crop = PixelRect{10, 6, 21, 17};
    render_layers(options);
    for (size_t k = 0; k < whole.film.layers.size(); ++k) {
        const FilmLayer& of_whole = whole.film.layers[k];
        const FilmLayer& of_part = result.film.layers[k];
        const size_t channels = of_part.layer.channels.size();
        UnsetArray<float> whole_pixels(of_whole.pixels.size());
        UnsetArray<float> part_pixels(of_part.pixels.size());
        interleave_planes(of_whole.pixels, channels, whole_pixels.data());
        interleave_planes(of_part.pixels, channels, part_pixels.data());
        const size_t row = 21 * channels;
        for (size_t y = 0; y < 17; ++y) {
            const float* from = whole_pixels.data() + ((y + 6) * width + 10) * channels;
            ASSERT_EQ(std::memcmp(part_pixels.data() + y * row, from, row * 4), 0)
                << of_part.layer.name << " row " << y;
        }
    }
}

TEST_F(Layers, CostIsTheNumberOfRays) {
    render_layers(options_with({"cost"}));
    const FilmLayer& cost = layer("cost");
    const double sum = std::accumulate(cost.pixels.begin(), cost.pixels.end(), 0.0);
    const RenderCounters& c = result.counters;
    EXPECT_EQ(sum, static_cast<double>(c.camera_rays + c.bounce_rays + c.shadow_rays));
    EXPECT_GT(at("cost", corner_pixel), samples);
}

TEST_F(Layers, VarianceTellsHowFarPixelsScatter) {
    RenderOptions options = options_with({"variance"});
    constexpr int runs = 60;
    std::vector<double> sum(2), squares(2), told(2);
    for (int run = 0; run < runs; ++run) {
        options.seed = static_cast<uint64_t>(run);
        render_layers(options);
        const size_t pixels[] = {corner_pixel, middle_pixel};
        for (size_t k = 0; k < 2; ++k) {
            const float* rgb = result.film.pixels.data() + 4 * pixels[k];
            const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
            sum[k] += y;
            squares[k] += y * y;
            told[k] += static_cast<double>(at("variance", pixels[k])) / runs;
        }
    }
    for (size_t k = 0; k < 2; ++k) {
        const double spread = (squares[k] - sum[k] * sum[k] / runs) / (runs - 1);
        // Stratified samples scatter less than the estimate, which takes them as independent.
        EXPECT_LT(spread, told[k] * 2);
        EXPECT_GT(told[k], 0);
    }
}

/// The coverage of a name in a Cryptomatte layer, as a compositor finds it.
double matte(const FilmLayer& layer, size_t pixel, const std::string& name) {
    const float id = cryptomatte_id(cryptomatte_hash(name));
    const size_t channels = layer.layer.channels.size();
    double sum = 0;
    for_planes(channels, layer.pixels.size() / channels, [&](const ChannelPlane& plane) {
        const float* ranks = layer.pixels.data() + plane.first_value + pixel * plane.channels;
        for (size_t c = 0; c < plane.channels; c += 2) {
            if (std::bit_cast<uint32_t>(ranks[c]) == std::bit_cast<uint32_t>(id))
                sum += static_cast<double>(ranks[c + 1]);
        }
    });
    return sum;
}

TEST_F(Layers, MattesAreTheCoverageOfNames) {
    render_layers(options_with({"metallic", "crypto_object", "crypto_material", "crypto_asset"}));
    for (size_t pixel = 0; pixel < size_t{width} * height; ++pixel) {
        const double sign = static_cast<double>(at("metallic", pixel));
        EXPECT_NEAR(matte(layer("crypto_object"), pixel, "/room/sign"), sign, 1e-6);
        EXPECT_NEAR(matte(layer("crypto_object"), pixel, "/room/wall"), 1 - sign, 1e-6);
        EXPECT_NEAR(matte(layer("crypto_material"), pixel, "material 2"), sign, 1e-6);
        EXPECT_NEAR(matte(layer("crypto_asset"), pixel, "/room"), 1, 1e-6);
    }
}

TEST(LayerNames, AreCheckedAndCountOnce) {
    const std::vector<std::string> twice = {"depth", "normal", "depth"};
    EXPECT_EQ(layers_of(twice, 6)->size(), 2U);
    const std::vector<std::string> wrong = {"dept"};
    const auto layers = layers_of(wrong, 6);
    ASSERT_FALSE(layers);
    EXPECT_EQ(layers.error().id, "E-AOV-NAME");
    EXPECT_NE(layers.error().message.find("normal_geometric"), std::string::npos);
}

TEST(AovEntries, AreInTheOrderOfTheEnumeration) {
    for (size_t i = 0; i < aov_entries.size(); ++i)
        EXPECT_EQ(static_cast<size_t>(aov_entries[i].aov), i);
}

}  // namespace
}  // namespace obscura::test
