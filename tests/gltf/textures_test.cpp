// tests/gltf/textures_test.cpp - images in the arena: shared, doubled, missing, broken, too large.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/textures.h"

#include "gltf/gltf_files.h"
#include "gltf/images.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

/// The triangle with a material; images and textures are the caller's.
json textured(const json& material) {
    json tree = triangle_asset();
    tree["materials"][0] = material;
    tree["meshes"][0]["primitives"][0]["material"] = 0;
    return tree;
}

json one_texture() {
    json tree = textured({{"emissiveTexture", {{"index", 0}}}});
    tree["textures"][0]["source"] = 0;
    return tree;
}

Loaded load_image(const json& image, const LoadOptions& options = {}) {
    json tree = one_texture();
    tree["images"][0] = image;
    return load_tree(tree, options);
}

TEST(Textures, TexelsAndMipsLieInTheArena) {
    const Loaded loaded = load_image({{"uri", png_uri(4, 2)}, {"name", "Label"}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const TextureArena& arena = loaded.scene->textures;
    ASSERT_EQ(arena.records.size(), 1U);
    const TextureRecord& record = arena.records[0];
    EXPECT_EQ(record.width, 4);
    EXPECT_EQ(record.height, 2);
    EXPECT_EQ(record.levels, 3);
    EXPECT_EQ(record.level_offset[1], 8);
    EXPECT_EQ(record.level_offset[2], 10);
    EXPECT_EQ(arena.texels.size(), 11U);
    EXPECT_EQ(arena.texels[6], 0xFF4D0A14U);  // x 2, y 1
    EXPECT_EQ(arena.texels[10] >> 16, 0xFF4DU);
    EXPECT_EQ(record.sampler,
              pack_sampler(Wrap::repeat, Wrap::repeat, false, false, MipMode::linear, true));
    const ImageInfo& info = loaded.scene->info.images[0];
    EXPECT_EQ(info.name, "Label");
    EXPECT_EQ(info.format, "png");
    EXPECT_EQ(info.width, 4);
    EXPECT_TRUE(info.used_as_color);
    EXPECT_FALSE(info.used_as_data);
}

/// A line of 16-bit greys, each one code apart, as normals or heights have them.
TEST(Textures, SixteenBitsStay) {
    constexpr unsigned count = 2001;
    std::vector<unsigned> bytes;
    for (unsigned i = 0; i < count; ++i)
        bytes.insert(bytes.end(), {(30000 + i) >> 8, (30000 + i) & 255U});
    const auto png = testing_images::PngBuilder(count, 1, 16, 0).finish({bytes});
    json tree = textured({{"normalTexture", {{"index", 0}}}});
    tree["textures"][0]["source"] = 0;
    tree["images"][0]["uri"] =
        "data:image/png;base64," + base64({reinterpret_cast<const char*>(png.data()), png.size()});
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const TextureArena& arena = loaded.scene->textures;
    const TextureRecord& record = arena.records.at(0);
    ASSERT_NE(record.low_plane, 0);
    EXPECT_EQ(arena.texels.size(), 2 * mip_chain_texels(count, 1));
    EXPECT_TRUE(view_of(arena).wide);
    const auto first = static_cast<size_t>(record.level_offset[0]);
    for (unsigned i = 0; i < count; ++i) {
        ASSERT_NEAR(texel_channel(arena, record, first + i, 1), (30000 + i) / 65535.0, 1e-7);
    }
    const auto last = static_cast<size_t>(record.level_offset[record.levels - 1]);
    EXPECT_NEAR(texel_channel(arena, record, last, 0), 31000 / 65535.0, 1e-4) << "the mean";
    EXPECT_EQ(loaded.scene->info.images[0].bits, 16);
}

TEST(Textures, OcclusionIsReadOnlyWhereItIsAskedFor) {
    json tree = textured({{"occlusionTexture", {{"index", 0}, {"strength", 0.25}}}});
    tree["textures"][0]["source"] = 0;
    tree["images"][0]["uri"] = png_uri(4, 2);
    const Loaded off = load_tree(tree);
    ASSERT_TRUE(off.scene) << off.text();
    EXPECT_EQ(off.scene->materials.at(1).occlusion_texture.texture, -1);
    EXPECT_TRUE(off.scene->textures.texels.empty());
    LoadOptions options;
    options.occlusion = true;
    const Loaded ambient = load_tree(tree, options);
    ASSERT_TRUE(ambient.scene) << ambient.text();
    EXPECT_EQ(ambient.scene->materials.at(1).occlusion_texture.texture, 0);
    EXPECT_EQ(ambient.scene->materials.at(1).occlusion_strength, 0.25f);
    EXPECT_TRUE(ambient.scene->info.images[0].used_as_data);
}

TEST(Textures, InfoOnlyMeasures) {
    LoadOptions options;
    options.info_only = true;
    const Loaded loaded = load_image({{"uri", png_uri(4, 2)}}, options);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.scene->textures.texels.empty());
    EXPECT_EQ(loaded.scene->textures.records.size(), 1U);
    EXPECT_EQ(loaded.scene->info.images[0].height, 2);
    EXPECT_EQ(loaded.scene->indices.size(), 3U + 1);
}

/// One image: colour with two samplers and data with one. Texels exist twice, records three times.
TEST(Textures, ColorAndDataAreStoredApartAndSamplersShare) {  // D18
    json tree = textured(json::parse(R"({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                 "metallicRoughnessTexture": {"index": 1}},
        "emissiveTexture": {"index": 2}, "normalTexture": {"index": 1}})"));
    tree["images"][0]["uri"] = png_uri(4, 4);
    tree["samplers"][0] = {{"wrapS", 33071}, {"magFilter", 9728}};
    tree["textures"] = {{{"source", 0}}, {{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    const Material& material = scene.materials[1];
    EXPECT_EQ(scene.textures.texels.size(), 2U * 21);
    ASSERT_EQ(scene.textures.records.size(), 3U);
    const auto record = [&](const TextureSlot& slot) {
        return scene.textures.records[static_cast<size_t>(slot.texture)];
    };
    const TextureRecord base = record(material.base_color_texture);
    const TextureRecord emissive = record(material.emissive_texture);
    const TextureRecord data = record(material.normal_texture);
    EXPECT_EQ(material.normal_texture.texture, material.metallic_roughness_texture.texture);
    EXPECT_EQ(base.level_offset[0], emissive.level_offset[0]);
    EXPECT_NE(base.level_offset[0], data.level_offset[0]);
    EXPECT_NE(base.sampler, emissive.sampler);
    EXPECT_EQ(base.sampler & sampler_srgb, sampler_srgb);
    EXPECT_EQ(data.sampler & sampler_srgb, 0U);
    // The same image, but averages differ: linear light against plain numbers.
    EXPECT_EQ(scene.textures.texels[static_cast<size_t>(base.level_offset[0]) + 5],
              scene.textures.texels[static_cast<size_t>(data.level_offset[0]) + 5]);
    EXPECT_NE(scene.textures.texels[static_cast<size_t>(base.level_offset[2])],
              scene.textures.texels[static_cast<size_t>(data.level_offset[2])]);
    EXPECT_TRUE(scene.info.images[0].used_as_color && scene.info.images[0].used_as_data);
}

TEST(Textures, SamplersOfEveryKind) {
    struct Case {
        json sampler;
        uint32_t packed;
    };
    const auto pack = [](Wrap u, Wrap v, bool mag, bool min, MipMode mip) {
        return pack_sampler(u, v, mag, min, mip, true);
    };
    constexpr Wrap repeat = Wrap::repeat;
    const Case cases[] = {
        {{{"minFilter", 9728}}, pack(repeat, repeat, false, true, MipMode::none)},
        {{{"minFilter", 9729}}, pack(repeat, repeat, false, false, MipMode::none)},
        {{{"minFilter", 9984}}, pack(repeat, repeat, false, true, MipMode::nearest)},
        {{{"minFilter", 9985}}, pack(repeat, repeat, false, false, MipMode::nearest)},
        {{{"minFilter", 9986}}, pack(repeat, repeat, false, true, MipMode::linear)},
        {{{"magFilter", 9728}}, pack(repeat, repeat, true, false, MipMode::linear)},
        {{{"wrapS", 33071}, {"wrapT", 33648}},
         pack(Wrap::clamp, Wrap::mirror, false, false, MipMode::linear)},
    };
    for (const Case& c : cases) {
        json tree = one_texture();
        tree["images"][0]["uri"] = png_uri(1, 1);
        tree["samplers"][0] = c.sampler;
        tree["textures"][0]["sampler"] = 0;
        const Loaded loaded = load_tree(tree);
        ASSERT_TRUE(loaded.scene) << loaded.text();
        EXPECT_EQ(loaded.scene->textures.records[0].sampler, c.packed) << c.sampler;
    }
}

TEST(Textures, ImagesInBuffersAndFiles) {
    AssetBuilder builder = triangle_builder();
    const int view = builder.add_view(png_bytes(2, 1));
    builder.tree["images"][0] = {{"bufferView", view}, {"mimeType", "image/png"}};
    builder.tree["images"][1] = {{"uri", "sub/my%20picture.png"}};
    builder.tree["textures"] = {{{"source", 0}}, {{"source", 1}}};
    builder.tree["materials"][0] = {{"emissiveTexture", {{"index", 0}}},
                                    {"normalTexture", {{"index", 1}}}};
    builder.tree["meshes"][0]["primitives"][0]["material"] = 0;
    const TempFolder folder;
    std::filesystem::create_directory(folder / "sub");
    folder.write("sub/my picture.png", png_bytes(1, 3));
    const Loaded loaded = load_file(folder.write("s.glb", builder.glb()));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(loaded.scene->info.images[0].name, "image 0");
    EXPECT_EQ(loaded.scene->info.images[0].width, 2);
    EXPECT_EQ(loaded.scene->info.images[1].name, "sub/my%20picture.png");
    EXPECT_EQ(loaded.scene->info.images[1].height, 3);
}

TEST(Textures, BadImagesAreErrors) {
    const std::string png = png_bytes(4, 4);
    const std::string prefix = "data:image/png;base64,";
    struct Case {
        const char* name;
        std::string uri;
        int code;
        const char* id;
    };
    const Case cases[] = {
        {"D1 missing", "absent.png", 67, "E-RES-MISSING"},
        {"D3 truncated", prefix + base64(png.substr(0, png.size() / 2)), 67, "E-IMG-CORRUPT"},
        {"D3 header only", prefix + base64(png.substr(0, 33)), 67, "E-IMG-CORRUPT"},
        {"D16 not a picture",
         prefix + base64("II*\0 some TIFF data and more of it"),
         67,
         "E-IMG-FORMAT"},
        {"network", "https://example.org/a.png", 77, "E-URI-REFUSED"},
        {"escape", "../a.png", 77, "E-URI-REFUSED"},
        {"C19 mime", "data:text/html;base64," + base64(png), 65, "E-URI-DATA"},
        {"C19 base64", "data:image/png;base64,A*", 65, "E-URI-DATA"},
    };
    for (const Case& c : cases) {
        const Loaded loaded = load_image({{"uri", c.uri}});
        EXPECT_EQ(loaded.code(), c.code) << c.name << ' ' << loaded.text();
        EXPECT_EQ(loaded.id(), c.id) << c.name << ' ' << loaded.text();
        EXPECT_NE(loaded.text().find("#/images/0"), std::string::npos) << loaded.text();
    }
}

/// The data count, whatever the name or the media type promises.
TEST(Textures, NamesAndMediaTypesThatLieWarn) {
    struct Case {
        const char* file;
        const char* warning;
    };
    for (const Case& c : {Case{"a.jpg", "named as jpeg but the data are png"},
                          Case{"a.JPEG", "named as jpeg but the data are png"},
                          Case{"a.webp", "named as webp but the data are png"},
                          Case{"a.png", ""},
                          Case{"a.dat", ""},
                          Case{"a", ""}}) {
        json tree = one_texture();
        tree["images"][0] = {{"uri", c.file}};
        const TempFolder folder;
        folder.write(c.file, png_bytes(1, 3));
        const Loaded loaded = load_file(folder.write("s.gltf", tree.dump()));
        ASSERT_TRUE(loaded.scene) << loaded.text();
        EXPECT_EQ(loaded.warnings.empty(), std::string(c.warning).empty()) << loaded.warnings;
        EXPECT_NE(loaded.warnings.find(c.warning), std::string::npos) << loaded.warnings;
    }
    const std::string uri = png_uri(4, 2);
    const Loaded typed = load_image({{"uri", "data:image/jpeg" + uri.substr(uri.find(';'))}});
    EXPECT_TRUE(typed.warns("the media type is \"image/jpeg\" but the data are png"))
        << typed.warnings;
}

/// The warning about the name comes after the headers were read and before the texels are: then
/// somebody saves the image in another size.
TEST(Textures, ImagesThatChangeWhileLoadingAreErrors) {
    json tree = one_texture();
    tree["images"][0] = {{"uri", "a.jpg"}};
    const TempFolder folder;
    folder.write("a.jpg", png_bytes(2, 2));
    Log log(Verbosity::normal, [&](const LogMessage& message) {
        if (message.text.find("named as jpeg") != std::string_view::npos)
            folder.write("a.jpg", png_bytes(4, 2));
    });
    const Result<Scene> scene = load_gltf(folder.write("s.gltf", tree.dump()), {}, log);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().id, "E-IMG-CHANGED");
    EXPECT_EQ(scene.error().code, ExitCode::bad_resource);
    EXPECT_NE(scene.error().where.find("#/images/0"), std::string::npos) << scene.error().where;
}

TEST(Textures, UnusedBadImagesOnlyWarn) {
    json tree = one_texture();
    tree["images"] = {{{"uri", png_uri(1, 1)}}, {{"uri", "absent.png"}}};
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("#/images/1"));
    EXPECT_TRUE(loaded.warns("no drawn material uses the image"));
}

TEST(Textures, WrongMediaTypesWarn) {  // D5
    const Loaded loaded =
        load_image({{"uri", "data:image/jpeg;base64," + base64(png_bytes(1, 1))}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("\"image/jpeg\" but the data are png"));
}

/// Every image is of an allowed size, but their sum is more than 32-bit offsets reach: refused by
/// the headers alone.
TEST(Textures, TooManyTexelsAreRefusedUnread) {  // D6, D7
    // Black and white, so that a file of 100 kB could hold it.
    const testing_images::ByteVector start = testing_images::PngBuilder(22000, 22000, 1, 0)
                                                 .chunk("IDAT", testing_images::ByteVector(100000))
                                                 .chunk("IEND", testing_images::ByteVector())
                                                 .so_far();
    const std::string uri = "data:image/png;base64," +
                            base64({reinterpret_cast<const char*>(start.data()), start.size()});
    json tree = textured(json::parse(R"({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                 "metallicRoughnessTexture": {"index": 1}},
        "emissiveTexture": {"index": 2}, "normalTexture": {"index": 3}})"));
    for (int i = 0; i < 4; ++i) {
        tree["images"].push_back({{"uri", uri}});
        tree["textures"].push_back({{"source", i}});
    }
    const Loaded loaded = load_tree(tree);
    EXPECT_EQ(loaded.code(), 77) << loaded.text();
    EXPECT_EQ(loaded.id(), "E-LIMIT-TEXELS") << loaded.text();
}

TEST(Textures, WebpIsPreferred) {
    json tree = one_texture();
    tree["images"] = {{{"uri", png_uri(2, 2)}},
                      {{"uri", "data:image/webp;base64," + base64(webp_bytes())}}};
    tree["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->info.images[1].format, "webp");
    EXPECT_TRUE(loaded.scene->info.images[1].used_as_color);
    EXPECT_FALSE(loaded.scene->info.images[0].used_as_color);
    EXPECT_EQ(loaded.scene->textures.records[0].width, 1);
}

TEST(Textures, Ktx2IsPreferredAndNeedsNoFallback) {  // F11
    json tree = one_texture();
    tree["images"] = {{{"uri", png_uri(2, 2)}},
                      {{"uri", "data:image/webp;base64," + base64(webp_bytes())}},
                      {{"uri", ktx2_uri(ktx2_greys(4, 3))}}};
    tree["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    tree["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 2;
    const Loaded with = load_tree(tree);
    ASSERT_TRUE(with.scene) << with.text();
    EXPECT_EQ(with.scene->info.images[2].format, "ktx2");
    EXPECT_FALSE(with.scene->info.images[0].used_as_color);
    EXPECT_EQ(with.scene->textures.records.at(0).width, 4);

    tree["textures"][0].erase("source");
    tree["extensionsUsed"] = {"KHR_texture_basisu", "EXT_texture_webp"};
    tree["extensionsRequired"] = {"KHR_texture_basisu"};
    const Loaded without = load_tree(tree);
    ASSERT_TRUE(without.scene) << without.text();
    EXPECT_EQ(without.scene->textures.records.at(0).width, 4);
    EXPECT_TRUE(without.warnings.empty()) << without.warnings;
}

TEST(Textures, Ktx2LevelsAreTakenAndMissingOnesMade) {
    for (const unsigned stored : {4U, 2U}) {
        const Loaded loaded = load_image({{"uri", ktx2_uri(ktx2_greys(8, stored))}});
        ASSERT_TRUE(loaded.scene) << loaded.text();
        const TextureArena& arena = loaded.scene->textures;
        ASSERT_EQ(arena.records.at(0).levels, 4);
        for (unsigned level = 0; level < 4; ++level) {
            const unsigned grey = 10 * (std::min(level, stored - 1) + 1);
            const auto at = static_cast<size_t>(arena.records[0].level_offset[level]);
            EXPECT_EQ(arena.texels.at(at), 0xFF000000U | grey * 0x010101U) << level;
        }
    }
}

TEST(Textures, Ktx2ThatIsNotWhatTheMaterialReadsWarns) {
    auto linear = ktx2_greys(1, 1);
    linear.format = 37;
    linear.transfer = 1;
    const Loaded color = load_image({{"uri", ktx2_uri(linear)}});
    ASSERT_TRUE(color.scene) << color.text();
    EXPECT_TRUE(color.warns("says that it is linear")) << color.warnings;

    json tree = textured({{"normalTexture", {{"index", 0}}}});
    tree["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 0;
    tree["images"][0]["uri"] = ktx2_uri(ktx2_greys(1, 1));
    const Loaded data = load_tree(tree);
    ASSERT_TRUE(data.scene) << data.text();
    EXPECT_TRUE(data.warns("says that it is sRGB")) << data.warnings;
    EXPECT_FALSE(color.warns("says that it is sRGB")) << color.warnings;
}

TEST(Textures, Ktx2ThatIsNotAnImageIsRefused) {
    auto cube = ktx2_greys(1, 1);
    cube.faces = 6;
    const Loaded loaded = load_image({{"uri", ktx2_uri(cube)}});
    EXPECT_EQ(loaded.code(), 69) << loaded.text();
    EXPECT_EQ(loaded.id(), "E-IMG-FEATURE") << loaded.text();
}

}  // namespace
}  // namespace obscura::gltf
