// tests/gltf/animation_pointer_test.cpp - pointers of KHR_animation_pointer and their targets.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/animation_pointer.h"

#include "gltf/animated_files.h"
#include "gltf/images.h"
#include "gltf/parse/material_factors.h"

#include <gtest/gtest.h>

#include "support/text_files.h"
#include <cstring>

namespace obscura::gltf {
namespace {

using namespace test;

constexpr const char* ies_file =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 3 1 2 0 0 0\n1 1 10\n"
    "0 90\n0 90 180\n100 10\n100 40\n100 20\n";

/// Names of textures get one; numbers are such that other numbers have an effect.
json full_material(bool glossy) {
    json out = json::parse(R"({"emissiveFactor": [0.5, 0.5, 0.5], "alphaMode": "MASK"})");
    json& extensions = out["extensions"];
    for (const MaterialEntry& entry : material_entries) {
        const bool is_glossy = (entry.object.extensions & extension_specular_glossiness) != 0;
        if (is_glossy != glossy && entry.object.extensions != 0) continue;
        const std::string object = std::string("/") + entry.object.place;
        if (entry.numbers == nullptr) {
            const std::string place = (object == "/" ? "" : object) + "/" + entry.key;
            out[json::json_pointer(place)] = {{"index", 0}};
        }
    }
    if (glossy) return out;
    extensions["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
    extensions["KHR_materials_volume"]["attenuationColor"] = {0.5, 0.5, 0.5};
    return out;
}

/// An asset with one of everything that can be animated.
AssetBuilder full_asset() {
    AssetBuilder builder = triangle_builder();
    json& tree = builder.tree;
    json primitive = tree["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", 1}}, {{"POSITION", 1}}};
    primitive["material"] = 0;
    tree["meshes"][0] = {{"primitives", {primitive, primitive}}, {"weights", {0.5, 0.25}}};
    tree["meshes"][0]["primitives"][1]["material"] = 1;
    tree["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
    tree["materials"] = {full_material(false), full_material(true)};
    tree["images"][0]["uri"] = png_uri(2, 2);
    tree["textures"][0]["source"] = 0;
    json faces;
    for (int face = 1; face <= 6; ++face) {
        tree["images"][static_cast<size_t>(face)]["uri"] = png_uri(2, 2);
        faces.push_back(face);
    }
    tree["extensions"] = json::parse(R"({
        "EXT_lights_image_based": {"lights": [{"specularImageSize": 2}]},
        "KHR_lights_punctual": {"lights": [
            {"type": "spot", "spot": {"innerConeAngle": 0.125, "outerConeAngle": 0.5}},
            {"type": "point"}]}})");
    tree["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImages"] = {faces};
    tree["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"uri", "data:application/x-ies-lm-63;base64," + base64(ies_file)}}};
    tree["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    tree["cameras"] = json::parse(R"([
        {"type": "perspective",
         "perspective": {"yfov": 1, "aspectRatio": 1, "znear": 0.5, "zfar": 9},
         "extensions": {"OBSCURA_camera": {
             "near": 0.5, "far": 9, "focalLength": 0.5, "sensor": [0.5, 0.5], "shift": [0, 0],
             "distortion": [0, 0, 0, 0, 0],
             "lens": {"fstop": 2, "focusDistance": 2, "blades": 5, "bladeRotation": 0,
                      "anamorphic": 1},
             "exposure": {"shutter": 0.5, "iso": 100}}}},
        {"type": "orthographic",
         "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.5, "zfar": 9}},
        {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5},
         "extensions": {"OBSCURA_camera": {
             "lens": {"radius": 0.5}, "exposure": {"ev100": 1}}}},
        {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5},
         "extensions": {"OBSCURA_camera": {
             "fisheye": {"fov": 3, "coefficients": [0, 0, 0, 0]}}}},
        {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5},
         "extensions": {"OBSCURA_camera": {"environment": {"fov": 1, "stereo": 0.5}}}}])");
    tree["nodes"][0]["name"] = "Triangle";
    for (int camera = 0; camera < 5; ++camera)
        builder.add_root({{"camera", camera}});
    builder.add_root(json::parse(R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})"));
    builder.add_root(json::parse(R"({"extensions": {"KHR_lights_punctual": {"light": 1}}})"));
    builder.add_root(json::parse(R"({"extensions": {"EXT_lights_ies": {"light": 0}}})"));
    return builder;
}

Loaded load_lit(const json& tree, std::optional<double> time_s) {
    LoadOptions options;
    options.occlusion = true;
    options.time_s = time_s;
    return load_tree(tree, options);
}

template <typename T>
void add_bytes(const std::vector<T>& entries, std::vector<double>& out) {
    for (const T& entry : entries) {
        std::array<uint32_t, sizeof(T) / 4> words;
        std::memcpy(words.data(), &entry, sizeof(T));
        out.insert(out.end(), words.begin(), words.end());
    }
}

/// What animations can change in a scene, as numbers.
std::vector<double> seen_numbers(const Scene& scene) {
    std::vector<double> out;
    add_bytes(scene.materials, out);
    add_bytes(scene.layers, out);
    add_bytes(scene.lights, out);
    out.insert(out.end(), scene.textures.texels.begin(), scene.textures.texels.end());
    for (const SceneCamera& camera : scene.cameras) {
        for (const double number : {camera.yfov_rad, camera.aspect, camera.xmag_m, camera.ymag_m})
            out.push_back(number);
        out.push_back(camera.znear_m);
        out.push_back(camera.zfar_m);
        for (const auto& [name, value] : settings_texts(camera.settings))
            out.push_back(static_cast<double>(std::hash<std::string>()(name + value)));
    }
    out.push_back(static_cast<double>(scene.info.triangles_in_world));
    for (const Vec3f& corner : {scene.bounds.low, scene.bounds.high})
        out.insert(out.end(), {corner.x, corner.y, corner.z});
    if (scene.environment) {
        for (const float number : scene.environment->pixels)
            out.push_back(number);
    }
    return out;
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
    const size_t at = text.find(part);
    return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

/// The members of the document that match a pattern.
std::string pointer_of(const std::string& pattern, const json& tree) {
    if (pattern.find("EXT_lights_ies") != std::string::npos) return replaced(pattern, "*", "8");
    if (pattern.find("pbrSpecularGlossiness") != std::string::npos) {
        return replaced(pattern, "*", "1");
    }
    for (int camera = 0; camera < 5 && pattern.rfind("/cameras", 0) == 0; ++camera) {
        const std::string pointer = replaced(pattern, "*", std::to_string(camera));
        if (tree.contains(json::json_pointer(pointer))) return pointer;
    }
    return replaced(replaced(pattern, "*", "0"), "TEXTURE", "emissiveTexture");
}

/// A good value of a property, other than its own.
double value_for(const std::string& pointer) {
    const std::pair<const char*, double> others[] = {{"lens/blades", 7},
                                                     {"KHR_materials_ior/ior", 1.75},
                                                     {"iridescenceIor", 1.75},
                                                     {"innerConeAngle", 0.25},
                                                     {"zfar", 7.5},
                                                     {"/far", 7.5},
                                                     {"visible", 0},
                                                     {"selectable", 0},
                                                     {"hoverable", 0}};
    for (const auto& [part, value] : others) {
        if (pointer.find(part) != std::string::npos) return value;
    }
    return 0.75;
}

const char* type_of(const std::string& pointer, size_t width) {
    constexpr const char* types[] = {"SCALAR", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return pointer.find("/weights") != std::string::npos ? "SCALAR" : types[width];
}

/// The JSON at the pointer once the value is set.
json written(const std::string& pointer, size_t width, double value) {
    if (pointer.find("visible") != std::string::npos) return value != 0;
    if (pointer.find("blades") != std::string::npos) return static_cast<int>(value);
    return width == 1 ? json(value) : json(std::vector<double>(width, value));
}

Document document_of(const json& tree) {
    Log log(Verbosity::quiet);
    Problems problems;
    Result<Document> document = read_document(tree, "a.gltf", problems, log);
    EXPECT_TRUE(document) << document.error().message;
    return document ? std::move(*document) : Document{};
}

/// Animating the pointer gives the same scene as a file with the value.
void expect_arrival(const AssetBuilder& base, const std::string& pointer, size_t width) {
    SCOPED_TRACE(pointer);
    const double value = value_for(pointer);
    AssetBuilder animated = base;
    add_animation(animated,
                  "Set",
                  {{pointer_target(pointer.c_str()),
                    {0},
                    type_of(pointer, width),
                    std::vector<float>(width, static_cast<float>(value))}});
    AssetBuilder changed = base;
    changed.tree[json::json_pointer(pointer)] = written(pointer, width, value);
    const Loaded got = load_lit(animated.finished(), 1.0);
    const Loaded expected = load_lit(changed.finished(), std::nullopt);
    const Loaded before = load_lit(base.finished(), std::nullopt);
    ASSERT_TRUE(got.scene) << got.text();
    ASSERT_TRUE(expected.scene) << expected.text();
    EXPECT_EQ(got.scene->info.animations.at(0).channels, 1U);
    if (pointer.ends_with("/visible")) {  // what may come back keeps its materials
        EXPECT_EQ(got.scene->info.triangles_in_world, expected.scene->info.triangles_in_world);
        EXPECT_LT(got.scene->info.triangles_in_world, before.scene->info.triangles_in_world);
        return;
    }
    const std::vector<double> arrived = seen_numbers(*got.scene);
    const std::vector<double> wanted = seen_numbers(*expected.scene);
    ASSERT_EQ(arrived.size(), wanted.size());
    // Geometry moved by an animation is read in its node's own space.
    const bool moves = pointer.rfind("/nodes", 0) == 0 || pointer.rfind("/meshes", 0) == 0;
    for (size_t i = 0; i < wanted.size(); ++i) {
        if (arrived[i] == wanted[i]) continue;
        ASSERT_NEAR(arrived[i], wanted[i], moves ? 1e-6 : 0) << i;
    }
    EXPECT_NE(wanted, seen_numbers(*before.scene)) << "the value is seen";
}

/// Pointers into the whole asset, one for each pattern, and how many numbers each has.
std::vector<std::pair<std::string, size_t>> all_pointers(const json& tree) {
    const Document document = document_of(tree);
    std::vector<std::pair<std::string, size_t>> out;
    for (const std::string& pattern : property_patterns()) {
        const std::string pointer = pointer_of(pattern, tree);
        std::optional<PointedProperty> found = find_property(document, pointer);
        const bool is_list = !found;  // of OBSCURA_camera: only its elements are properties
        if (is_list) found = find_property(document, pointer + "/0");
        EXPECT_TRUE(found) << pointer;
        if (!found || !found->in_use) continue;
        const size_t listed = is_list ? tree.at(json::json_pointer(pointer)).size() : found->width;
        out.emplace_back(pointer, found->width == 0 ? 2 : listed);
    }
    return out;
}

/// The asset's JSON; with an animation, for numbers of materials are kept only beside one.
json tree_of(const AssetBuilder& builder) {
    json tree = builder.finished();
    tree["animations"] = json::array({json::object()});
    return tree;
}

bool is_lens_list(const std::string& pointer, size_t width) {
    return width > 1 && pointer.find("OBSCURA_camera") != std::string::npos;
}

TEST(AnimationPointer, EveryPropertyArrivesInTheScene) {
    const AssetBuilder base = full_asset();
    const auto pointers = all_pointers(tree_of(base));
    EXPECT_GT(pointers.size(), 70U);
    for (const auto& [pointer, width] : pointers) {
        if (!is_lens_list(pointer, width)) expect_arrival(base, pointer, width);
    }
}

/// Each list has 0.5 everywhere: the rotations are unit.
TEST(AnimationPointer, AnElementOfAListChangesNothingElse) {
    const AssetBuilder base = full_asset();
    size_t elements = 0;
    for (const auto& [pointer, width] : all_pointers(tree_of(base))) {
        AssetBuilder listed = base;
        if (width > 1) listed.tree[json::json_pointer(pointer)] = std::vector<double>(width, 0.5);
        for (size_t element = 0; element < width && width > 1; ++element, ++elements)
            expect_arrival(listed, pointer + "/" + std::to_string(element), 1);
    }
    EXPECT_GT(elements, 50U);
}

TEST(AnimationPointer, EveryTextureHasATransform) {
    const json tree = tree_of(full_asset());
    const Document document = document_of(tree);
    size_t textures = 0;
    for (size_t i = 0; i < material_entries.size(); ++i) {
        const MaterialEntry& entry = material_entries[i];
        if (entry.numbers != nullptr) continue;
        const bool glossy = (entry.object.extensions & extension_specular_glossiness) != 0;
        const std::string object = entry.object.place;
        const std::string pointer = std::string("/materials/") + (glossy ? "1/" : "0/") + object +
                                    (object.empty() ? "" : "/") + entry.key +
                                    "/extensions/KHR_texture_transform/offset/1";
        const auto found = find_property(document, pointer);
        ASSERT_TRUE(found) << pointer;
        EXPECT_EQ(found->property.texture, static_cast<int>(i)) << pointer;
        EXPECT_EQ(found->property.element, 1) << pointer;
        ++textures;
    }
    EXPECT_EQ(textures, 20U);
}

TEST(AnimationPointer, TheDocumentationListsThem) {
    std::string list;
    for (const std::string& pattern : property_patterns())
        list += pattern + "\n";
    const std::string text = read_text(OBSCURA_SOURCE_DIR "/docs/gltf.md");
    EXPECT_NE(text.find("```\n" + list + "```\n"), std::string::npos) << list;
}

TEST(AnimationPointer, FindsNothingElse) {
    const Document document = document_of(tree_of(full_asset()));
    for (const char* pointer :
         {"",
          "/",
          "nodes/0/translation",
          "/nodes/99/translation",
          "/nodes/-1/translation",
          "/nodes/x/translation",
          "/nodes/0",
          "/nodes/0/name",
          "/nodes/0/translation/",
          "/nodes/0/translation/3",
          "/nodes/0/translation/0/0",
          "/nodes/0/rotation/4",
          "/nodes/0/translations",
          "/meshes/7/weights",
          "/cameras/0/orthographic/xmag",
          "/cameras/1/perspective/yfov",
          "/cameras/0/perspective/yfov/0",
          "/cameras/0/extensions/OBSCURA_camera/lens/radius",
          "/cameras/0/extensions/OBSCURA_camera/sensor",
          "/cameras/0/extensions/OBSCURA_camera/sensor/2",
          "/cameras/0/extensions/OBSCURA_camera/model",
          "/materials/9/alphaCutoff",
          "/materials/0/pbrMetallicRoughness/baseColorFactor/4",
          "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
          "/materials/1/extensions/KHR_materials_sheen/sheenColorTexture/extensions/"
          "KHR_texture_transform/scale",
          "/extensions/KHR_lights_punctual/lights/1/spot/innerConeAngle",
          "/extensions/KHR_lights_punctual/lights/0/type",
          "/materials/99999999999/alphaCutoff"}) {
        EXPECT_FALSE(find_property(document, pointer)) << pointer;
    }
    const char* hidden = "/nodes/0/extensions/KHR_node_hoverability/hoverable";
    EXPECT_FALSE(find_property(document, hidden)->in_use);
}

/// Numbers out of range are clamped as in a file, impossible ones are the file's errors.
TEST(AnimationPointer, ValuesAreHeldToTheirRanges) {
    const auto load_with = [](const std::string& pointer, float value) {
        AssetBuilder builder = full_asset();
        add_animation(builder, "Set", {{pointer_target(pointer.c_str()), {0}, "SCALAR", {value}}});
        return load_lit(builder.finished(), 0.0);
    };
    const Loaded bright = load_with("/materials/0/pbrMetallicRoughness/metallicFactor", 3);
    ASSERT_TRUE(bright.scene) << bright.text();
    EXPECT_EQ(bright.scene->materials.at(1).metallic, 1.0F);
    const Loaded unlimited = load_with("/extensions/KHR_lights_punctual/lights/1/range", -2);
    ASSERT_TRUE(unlimited.scene) << unlimited.text();
    EXPECT_EQ(unlimited.scene->lights.at(1).range, 0.0F);
    struct Bad {
        const char* pointer;
        float value;
        const char* id;
    };
    const Bad entries[] = {
        {"/cameras/0/perspective/aspectRatio", 0, "E-CAM-ASPECT"},
        {"/cameras/2/perspective/aspectRatio", 0, "E-CAM-ASPECT"},
        {"/cameras/0/perspective/zfar", 0.25F, "E-CAM-CLIP"},
        {"/cameras/2/perspective/zfar", 0, "E-CAM-CLIP"},
        {"/cameras/0/perspective/znear", 0, "E-CAM-CLIP"},
        {"/cameras/1/orthographic/xmag", 0, "E-CAM-MAG"},
        {"/cameras/1/orthographic/zfar", 0.25F, "E-CAM-CLIP"},
        {"/cameras/0/extensions/OBSCURA_camera/lens/fstop", 0, "E-CAM-VALUE"},
        {"/cameras/0/extensions/OBSCURA_camera/lens/blades", 2, "E-CAM-VALUE"},
        {"/cameras/0/extensions/OBSCURA_camera/lens/blades", 5.5F, "E-JSON-TYPE"},
        {"/cameras/0/extensions/OBSCURA_camera/far", 0.25F, "E-CAM-VALUE"},
    };
    for (const Bad& entry : entries) {
        const Loaded loaded = load_with(entry.pointer, entry.value);
        EXPECT_EQ(loaded.id(), entry.id) << entry.pointer;
        EXPECT_TRUE(loaded.text().find(std::string("#") + entry.pointer) != std::string::npos)
            << loaded.text();
    }
}

TEST(AnimationPointer, AnInnerConeComesBackWhenTheOuterOneGrows) {
    AssetBuilder builder = full_asset();
    const char* outer = "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle";
    add_animation(builder, "Open", {{pointer_target(outer), {0, 1}, "SCALAR", {0.1F, 0.5F}}});
    const Loaded open = load_lit(builder.finished(), 1.0);
    const Loaded still = load_lit(full_asset().finished(), std::nullopt);
    ASSERT_TRUE(open.scene) << open.text();
    EXPECT_EQ(open.scene->lights.at(0).spot_scale, still.scene->lights.at(0).spot_scale);
    const Loaded narrow = load_lit(builder.finished(), 0.0);
    EXPECT_FLOAT_EQ(narrow.scene->lights.at(0).spot_on_axis, 1000.0F) << "a sharp edge";
}

/// An asset that is posed at several times, in any order.
void expect_order_does_not_matter(const AssetBuilder& builder) {
    const TempFolder folder;
    const auto file = folder.write("scene.gltf", builder.finished().dump());
    Log log(Verbosity::quiet);
    LoadOptions options;
    options.occlusion = true;
    Result<PosedAsset> asset = PosedAsset::open(file, options, true, log);
    ASSERT_TRUE(asset);
    for (const double time_s : {1.0, 0.0, 0.5, 1.0, 0.5}) {
        Result<Scene> scene = asset->scene_at(time_s, false, log);
        ASSERT_TRUE(scene) << scene.error().message;
        const Loaded alone = load_lit(builder.finished(), time_s);
        EXPECT_EQ(seen_numbers(*scene), seen_numbers(*alone.scene)) << time_s;
        EXPECT_EQ(scene->info.images.size(), alone.scene->info.images.size()) << time_s;
        asset->take_back(std::move(*scene));
    }
}

TEST(AnimationPointer, PosesDoNotDependOnEarlierOnes) {
    AssetBuilder turning = full_asset();
    add_animation(turning,
                  "Turn",
                  {{pointer_target("/nodes/0/rotation/2"), {0, 1}, "SCALAR", {0, 3}},
                   {pointer_target("/extensions/EXT_lights_image_based/lights/0/rotation/1"),
                    {0, 1},
                    "SCALAR",
                    {0, 2}}});
    expect_order_does_not_matter(turning);
    AssetBuilder polished = full_asset();
    const char* glossiness =
        "/materials/1/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor";
    add_animation(polished, "Polish", {{pointer_target(glossiness), {0, 1}, "SCALAR", {0, 1}}});
    expect_order_does_not_matter(polished);
}

TEST(AnimationPointer, AQuaternionMustKeepALength) {
    AssetBuilder builder = full_asset();
    add_animation(
        builder, "Stop", {{pointer_target("/nodes/0/rotation/3"), {0, 1}, "SCALAR", {1, 0}}});
    EXPECT_TRUE(load_lit(builder.finished(), 0.5).scene);
    const Loaded loaded = load_lit(builder.finished(), 1.0);
    EXPECT_EQ(loaded.id(), "E-NODE-ROTATION");
    EXPECT_EQ(loaded.code(), 65);
}

}  // namespace
}  // namespace obscura::gltf
