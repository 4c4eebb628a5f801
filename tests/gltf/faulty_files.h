// tests/gltf/faulty_files.h - assets with textures that tests break.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/images.h"

namespace obscura::gltf::test {

inline LoadOptions lenient_options() {
    LoadOptions options;
    options.lenient = true;
    return options;
}

/// The result of lenient loading, and what it lacks.
struct LenientlyLoaded : Loaded {
    Degraded lost;
};

inline LenientlyLoaded load_leniently(const json& tree) {
    const TempFolder folder;
    const auto file = folder.write("scene.gltf", tree.dump());
    Log log(Verbosity::quiet);
    Degraded lost;
    const auto load = [&]() -> Result<Scene> {
        Result<PosedAsset> asset = PosedAsset::open(file, lenient_options(), false, log);
        if (!asset) return fail(asset.error());
        Result<Scene> scene = asset->scene_at(0, true, log);
        lost = asset->degraded();
        return scene;
    };
    LenientlyLoaded out{{load(), {}}, {}};
    out.lost = lost;
    for (const std::string& warning : log.warnings())
        out.warnings += warning + "\n";
    return out;
}

/// A triangle with a base colour (image 0) and a metallic-roughness texture (image 1), of 2 x 2.
inline AssetBuilder textured_builder() {
    AssetBuilder builder = triangle_builder();
    json& tree = builder.tree;
    tree["materials"][0] = json::parse(R"({"pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}})");
    tree["meshes"][0]["primitives"][0]["material"] = 0;
    for (int i = 0; i < 2; ++i) {
        tree["textures"].push_back({{"source", i}});
        tree["images"].push_back({{"uri", png_uri(2, 2)}});
    }
    return builder;
}

/// Overwrites the float at the beginning of an accessor's data.
inline void set_first_float(AssetBuilder& builder, size_t accessor, float value) {
    const size_t view = builder.tree["accessors"][accessor]["bufferView"].get<size_t>();
    const size_t at = builder.tree["bufferViews"][view]["byteOffset"].get<size_t>();
    builder.bytes.replace(at, 4, raw(std::vector<float>{value}));
}

}  // namespace obscura::gltf::test
