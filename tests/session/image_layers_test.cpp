// tests/session/image_layers_test.cpp - layers of a film become layers of an image.
// SPDX-License-Identifier: Apache-2.0
#include "session/image_layers.h"

#include "session/asset_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <gmock/gmock.h>
#include <utility>

namespace obscura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

FilmLayer film_layer(const std::string& name, std::vector<std::string> names = {}) {
    FilmLayer out;
    out.layer = layers_of(std::vector<std::string>{name}, 2).value().front();
    out.pixels.resize(out.layer.channels.size());
    for (size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = static_cast<float>(i + 1);
    out.names = std::move(names);
    return out;
}

std::vector<FilmLayer> film_layers() {
    std::vector<FilmLayer> layers;
    layers.push_back(film_layer("normal"));
    layers.push_back(film_layer("crypto_object", {"/b", "", "/a"}));
    layers.push_back(film_layer("crypto_material", {"", "red"}));
    return layers;
}

TEST(ImageLayers, KeepWhatTheFilmSays) {
    const std::vector<ImageLayer> layers = image_layers(film_layers(), "");
    ASSERT_EQ(layers.size(), 3U);
    EXPECT_EQ(layers[0].name, "normal");
    EXPECT_THAT(layers[0].channels, ElementsAre("normal.X", "normal.Y", "normal.Z"));
    EXPECT_EQ(layers[0].kind, LayerKind::data);
    EXPECT_EQ(layers[0].reduction, "mean");
    EXPECT_THAT(layers[0].pixels, ElementsAre(1, 2, 3));
    EXPECT_TRUE(layers[0].metadata.empty());
    EXPECT_EQ(layers[1].kind, LayerKind::id);
    EXPECT_EQ(layers[1].channels.size(), 4U);
}

TEST(ImageLayers, CryptomatteSpeaksInTheHeaderAndLeavesOutEmptyNames) {
    const std::vector<ImageLayer> layers = image_layers(film_layers(), "");
    const auto& metadata = layers[1].metadata;
    ASSERT_EQ(metadata.size(), 4U);
    const std::string key = metadata[0].first.substr(0, metadata[0].first.rfind('/'));
    EXPECT_EQ(key.size(), std::string("cryptomatte/1234567").size());
    EXPECT_THAT(metadata[0], Pair(key + "/name", "crypto_object"));
    EXPECT_THAT(metadata[1], Pair(key + "/hash", "MurmurHash3_32"));
    EXPECT_THAT(metadata[2], Pair(key + "/conversion", "uint32_to_float32"));
    EXPECT_EQ(metadata[3].first, key + "/manifest");
    EXPECT_THAT(metadata[3].second, HasSubstr(R"("/a":")"));
    EXPECT_THAT(metadata[3].second, HasSubstr(R"("/b":")"));
    EXPECT_THAT(metadata[3].second, Not(HasSubstr(R"("":)")));
    EXPECT_NE(layers[2].metadata[0].first, metadata[0].first) << "a key of its own";
    EXPECT_THAT(layers[1].names, ElementsAre("/b", "/a"));
    EXPECT_TRUE(layers[0].names.empty());
}

TEST(ImageLayers, AManifestInAFileIsNamedAndHoldsTheNamesOfAllLayers) {
    const std::vector<ImageLayer> layers = image_layers(film_layers(), "names.json");
    for (const size_t i : {size_t{1}, size_t{2}}) {
        ASSERT_EQ(layers[i].metadata.size(), 4U);
        EXPECT_THAT(layers[i].metadata[3].first, testing::EndsWith("/manif_file"));
        EXPECT_EQ(layers[i].metadata[3].second, "names.json");
    }
    const std::string document = cryptomatte_document(film_layers());
    for (const char* name : {R"("/a":)", R"("/b":)", R"("red":)"})
        EXPECT_THAT(document, HasSubstr(name));
    EXPECT_THAT(document, Not(HasSubstr(R"("":)")));
}

TEST(ImageLayers, ARenderedImageHasThemAndTheirMemoryIsCounted) {
    Log log(Verbosity::quiet);
    const std::filesystem::path cornell = OBSCURA_SOURCE_DIR "/assets/cornell/cornell.gltf";
    Result<AssetRenderer> renderer = AssetRenderer::open(cornell, {}, false, log);
    ASSERT_TRUE(renderer);
    ASSERT_TRUE(renderer->pose({}, log));
    RenderRequest request;
    request.options.width = 32;
    request.options.height = 24;
    request.options.samples_per_pixel = 1;
    request.options.layers =
        layers_of(std::vector<std::string>{"depth", "crypto_object"}, 2).value();
    const Result<ChosenCamera> camera = renderer->prepare(request, {}, log);
    ASSERT_TRUE(camera);
    Result<FinishedImage> image = renderer->render(request, *camera, {}, log);
    ASSERT_TRUE(image);
    const std::vector<ImageLayer>& layers = image->image.layers;
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_GT(*std::max_element(layers[0].pixels.begin(), layers[0].pixels.end()), 0.0F);
    EXPECT_EQ(layers[1].pixels.size(), size_t{32} * 24 * 4);
    EXPECT_THAT(layers[1].metadata.at(3).first, testing::EndsWith("/manifest"));
    EXPECT_TRUE(image->crypto_manifest.empty());
    const size_t channels = 4 + 1 + 4;
    EXPECT_EQ(renderer->statistics().film_bytes, channels * 32 * 24 * sizeof(float));

    request.crypto_manifest = "folder/names.json";
    image = renderer->render(request, *camera, {}, log);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->image.layers[1].metadata.at(3).second, "names.json");
    EXPECT_FALSE(image->crypto_manifest.empty());
}

}  // namespace
}  // namespace obscura
