// gltf/load.cpp - a glTF 2.0 file (.gltf or .glb) becomes a scene.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/load.h"

#include "gltf/document.h"
#include "gltf/file_bytes.h"
#include "gltf/glb.h"
#include "gltf/instancing.h"
#include "gltf/json_text.h"
#include "gltf/lights_cameras.h"
#include "gltf/meshes.h"
#include "gltf/meshopt.h"
#include "gltf/shapes.h"
#include "gltf/textures.h"
#include "gltf/variants.h"
#include "scene/stroke_radii.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>

namespace obscura {

namespace {

constexpr uint64_t largest_asset_file = UINT32_MAX;  // what a GLB header can count

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Result<Bytes> read_asset_file(const std::filesystem::path& file) {
    FileBytes read = read_file_bytes(file, {largest_asset_file, UINT64_MAX});
    if (read.fault == FileFault::none) return std::move(read.bytes);
    if (read.fault == FileFault::too_large) {
        return fail(ExitCode::bad_data, "E-GLB-SIZE", file.string(), "the file has " + read.reason);
    }
    return fail(ExitCode::missing_scene,
                "E-SCENE-MISSING",
                file.string(),
                "the scene cannot be read: " + read.reason + "; accepted are .gltf and .glb files");
}

/// An asset's file taken apart, with its JSON already read.
struct OpenedAsset {
    Bytes file;  ///< what glb_binary points into
    std::optional<std::span<const std::byte>> glb_binary;
    Document document;
};

Result<OpenedAsset> open_asset(const std::filesystem::path& path, Log& log) {
    const std::string where = path.string();
    Result<Bytes> bytes = read_asset_file(path);
    if (!bytes) return fail(std::move(bytes.error()));
    OpenedAsset asset;
    asset.file = std::move(*bytes);
    const std::span<const std::byte> all = asset.file;
    const std::string_view foreign = guess_foreign_format(all);
    if (all.empty() || !foreign.empty()) {
        const std::string what = all.empty() ? "is empty" : "looks like " + std::string(foreign);
        return fail(ExitCode::bad_data,
                    "E-GLB-FORMAT",
                    where,
                    "the file " + what + "; accepted are glTF 2.0 as JSON text or GLB");
    }
    std::string_view text(reinterpret_cast<const char*>(all.data()), all.size());
    if (is_glb(all)) {
        const Result<GlbParts> parts = split_glb(all, where, log);
        if (!parts) return fail(parts.error());
        text = parts->json;
        asset.glb_binary = parts->binary;
    }
    Result<nlohmann::json> tree = parse_json_text(text, where, log);
    if (!tree) return fail(std::move(tree.error()));
    if (!is_glb(all)) asset.file = Bytes();
    Result<Document> document = read_document(*tree, where, log);
    if (!document) return fail(std::move(document.error()));
    asset.document = std::move(*document);
    return asset;
}

tl::unexpected<Error> unknown_scene(const Document& document, const std::string& asked) {
    std::string names;
    for (size_t i = 0; i < document.scenes.size(); ++i) {
        names += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + document.scenes[i].name + "\"";
    }
    return fail(ExitCode::usage,
                "E-SCENE-UNKNOWN",
                "--scene",
                "the asset has no scene " + asked + "; it has " + (names.empty() ? "none" : names));
}

/// Number of the scene to load; -1 when the file has none.
Result<int> choose_scene(const Document& document, const LoadOptions& options, Log& log) {
    const int count = static_cast<int>(document.scenes.size());
    if (options.scene >= 0) {
        if (options.scene >= count) return unknown_scene(document, std::to_string(options.scene));
        return options.scene;
    }
    if (!options.scene_name.empty()) {
        for (int i = 0; i < count; ++i) {
            if (document.scenes[static_cast<size_t>(i)].name == options.scene_name) return i;
        }
        return unknown_scene(document, "\"" + options.scene_name + "\"");
    }
    if (count == 0) {
        log.warn(document.file, "the asset has no scene; all its root nodes are drawn");
        return -1;
    }
    return std::max(document.scene, 0);
}

void fill_info(const Document& document, AssetInfo& info) {
    info.version = document.version;
    info.generator = document.generator;
    info.copyright = document.copyright;
    for (const GltfScene& scene : document.scenes)
        info.scenes.push_back(scene.name);
    for (const GltfMesh& mesh : document.meshes) {
        size_t triangles = 0;
        for (const GltfPrimitive& primitive : mesh.primitives) {
            triangles += primitive_triangles(document, primitive);
        }
        info.meshes.push_back({mesh.name, triangles});
    }
    info.animations = document.animations;
    info.node_names.reserve(document.nodes.size());
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        const std::string& name = document.nodes[i].name;
        info.node_names.push_back(name.empty() ? "node " + std::to_string(i) : name);
    }
    info.extensions = document.extensions;
    info.variants = document.variants;
    info.xmp = document.xmp;
    info.report = document.report;
}

void warn_about_whole(const Document& document, const Scene& scene, Log& log) {
    if (scene.bounds.empty()) {
        log.warn(document.file,
                 "the scene has no triangles, shapes, points or lines; only its surroundings will "
                 "be seen");
        return;
    }
    const Vec3f extent = scene.bounds.high - scene.bounds.low;
    const float farthest =
        std::max(max_component(abs(scene.bounds.low)), max_component(abs(scene.bounds.high)));
    constexpr float coarse = 1e5f;  // single precision then has steps of 1/160 of the extent
    if (farthest > coarse * max_component(extent)) {
        log.warn(document.file,
                 "the scene lies so far from the origin, for its size, that positions lose "
                 "precision");
    }
}

Result<Scene> build_scene(const std::filesystem::path& file, const LoadOptions& options, Log& log) {
    const auto start = std::chrono::steady_clock::now();
    Result<OpenedAsset> asset = open_asset(file, log);
    if (!asset) return fail(std::move(asset.error()));
    const Document& document = asset->document;
    const Result<int> chosen = choose_scene(document, options, log);
    if (!chosen) return fail(chosen.error());
    Result<void> done;
    if (!options.variant.empty()) done = choose_variant(options.variant, asset->document);
    if (!done) return fail(std::move(done.error()));

    Scene scene;
    scene.info.file_name = file.filename().string();
    scene.info.scene = std::max(*chosen, 0);
    scene.info.variant = options.variant;
    fill_info(document, scene.info);
    const std::filesystem::path folder = file.parent_path();
    Result<BufferStore> buffers = load_buffers(document, {folder, asset->glb_binary}, log);
    if (!buffers) return fail(std::move(buffers.error()));
    done = decode_meshopt(document, *buffers);
    if (!done) return fail(std::move(done.error()));

    const std::vector<PlacedNode> placed = place_nodes(document, *chosen, log);
    MaterialTable materials = make_material_table(document);
    const Result<std::vector<PlacedNode>> placed_meshes =
        expand_instances(document, *buffers, placed);
    if (!placed_meshes) return fail(placed_meshes.error());
    done = add_meshes({document, *buffers, *placed_meshes}, materials, scene, log);
    if (done) done = add_shapes({document, *buffers, placed}, materials, scene, log);
    if (done) done = add_lights_and_cameras(document, placed, scene, log);
    if (!done) return fail(std::move(done.error()));
    if (!scene.bounds.empty()) set_default_stroke_radii(scene);
    release_geometry(document, *buffers);
    scene.info.parse_seconds = seconds_since(start);

    const auto decode_start = std::chrono::steady_clock::now();
    done = add_textures({document, *buffers, folder, options.info_only}, materials, scene, log);
    if (!done) return fail(std::move(done.error()));
    scene.info.decode_seconds = seconds_since(decode_start);
    move_materials(materials, scene);
    warn_about_whole(document, scene, log);
    return scene;
}

}  // namespace

Result<Scene> load_gltf(const std::filesystem::path& file, const LoadOptions& options, Log& log) {
    try {
        return build_scene(file, options, log);
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory,
                    "E-MEMORY",
                    file.string(),
                    "there is not enough memory to load the scene");
    } catch (const std::length_error&) {
        return fail(ExitCode::out_of_memory,
                    "E-MEMORY",
                    file.string(),
                    "the scene asks for more memory than any machine has");
    } catch (const std::exception& problem) {
        return fail(ExitCode::internal, "E-INTERNAL", file.string(), problem.what());
    }
}

}  // namespace obscura
