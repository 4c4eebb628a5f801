// tools/scene_hash.cpp - a hash of every array of a loaded scene: are two the same?
// SPDX-License-Identifier: Apache-2.0
//
// Usage: scene_hash [--arrays] FILE...
//
// Prints a line for each scene and variant of each file, as it is stored and, where it has
// animations, at two times; with --arrays a line for each array, too.
#include "gltf/load.h"

#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace obscura;

/// Source  Fowler, Noll, Vo, FNV-1a of 64 bits
uint64_t hash_bytes(std::span<const std::byte> bytes, uint64_t hash = 0xCBF29CE484222325U) {
    for (const std::byte byte : bytes)
        hash = (hash ^ static_cast<uint64_t>(byte)) * 0x100000001B3U;
    return hash;
}

/// Collects the arrays of one scene.
class SceneHash {
public:
    explicit SceneHash(bool lists_arrays) : lists_arrays_(lists_arrays) {}

    uint64_t total() const { return total_; }

    /// An array of plain records without padding.
    template <typename Array>
    requires requires(const Array& array) { array.data(); }
    void add(const char* name, const Array& array) {
        add_bytes(name, array.size(), std::as_bytes(std::span(array.data(), array.size())));
    }
    void add(const char* name, const std::string& text) {
        add_bytes(name, text.size(), std::as_bytes(std::span(text.data(), text.size())));
    }
    void add(const char* name, double number) {
        add_bytes(name, 1, std::as_bytes(std::span(&number, 1)));
    }
    void add(const char* name, const std::vector<std::string>& texts) {
        std::string all;
        for (const std::string& text : texts) {
            all += text;
            all += '\n';
        }
        add(name, all);
    }

private:
    void add_bytes(const char* name, size_t count, std::span<const std::byte> bytes) {
        const uint64_t hash = hash_bytes(bytes);
        total_ = hash_bytes(std::as_bytes(std::span(&hash, 1)), total_);
        if (!lists_arrays_) return;
        std::printf("    %-24s %9zu %016llx\n", name, count, static_cast<unsigned long long>(hash));
    }

    bool lists_arrays_;
    uint64_t total_ = hash_bytes({});
};

void add_splats(const SplatField& splats, SceneHash& out) {
    out.add("splats.blocks", splats.blocks);
    out.add("splats.boxes", splats.boxes);
    out.add("splats.group_of_block", splats.group_of_block);
    out.add("splats.colors", splats.colors);
    out.add("splats.harmonics", splats.harmonics);
    for (const SplatGroup& group : splats.groups) {
        for (const int32_t number : {group.first, group.count, group.node, group.degree})
            out.add("splats.group", number);
        out.add("splats.linear", group.linear ? 1 : 0);
        out.add("splats.first_color", static_cast<double>(group.first_color));
        out.add("splats.first_harmonic", static_cast<double>(group.first_harmonic));
        out.add("splats.harmonic_step", static_cast<double>(group.harmonic_step));
        out.add("splats.object_from_world", std::span(&group.object_from_world, 1));
    }
}

void add_cameras(const std::vector<SceneCamera>& cameras, SceneHash& out) {
    for (const SceneCamera& camera : cameras) {
        out.add("camera.name", camera.name);
        out.add("camera.type", static_cast<int>(camera.type));
        out.add("camera.world_from_camera", std::span(&camera.world_from_camera, 1));
        out.add("camera.moving", camera.moving);
        for (const double number : {camera.yfov_rad,
                                    camera.aspect,
                                    camera.xmag_m,
                                    camera.ymag_m,
                                    camera.znear_m,
                                    camera.zfar_m})
            out.add("camera.number", number);
        for (const auto& [name, value] : settings_texts(camera.settings))
            out.add("camera.setting", name + "=" + value);
    }
}

void add_info(const AssetInfo& info, SceneHash& out) {
    const auto counts = [&](const char* name, const std::vector<NamedCount>& list) {
        for (const NamedCount& entry : list)
            out.add(name, entry.name + "=" + std::to_string(entry.count));
    };
    out.add("info.asset", {info.version, info.generator, info.copyright, info.xmp});
    out.add("info.scenes", info.scenes);
    out.add("info.variants", info.variants);
    out.add("info.node_names", info.node_names);
    out.add("info.light_names", info.light_names);
    out.add("info.environment", info.environment);
    counts("info.meshes", info.meshes);
    counts("info.shapes", info.shapes);
    for (const AnimationInfo& animation : info.animations) {
        out.add("info.animation", animation.name + "=" + std::to_string(animation.channels));
        out.add("info.animation.end", animation.end_s);
    }
    for (const ImageInfo& image : info.images) {
        out.add("info.image", {image.name, image.format});
        for (const int number : {image.width, image.height, image.bits})
            out.add("info.image.number", number);
        out.add("info.image.use", (image.used_as_color ? 1 : 0) + (image.used_as_data ? 2 : 0));
    }
    for (const ExtensionInfo& extension : info.extensions) {
        out.add("info.extension", extension.name);
        out.add("info.extension.flags",
                (extension.required ? 1 : 0) + (extension.supported ? 2 : 0));
        out.add("info.extension.materials", extension.materials);
    }
    for (const ReportEntry& entry : info.report) {
        out.add("info.report", {entry.place, entry.feature, entry.note});
        out.add("info.report.verdict", static_cast<int>(entry.verdict));
    }
    for (const size_t number : {info.triangles_in_world,
                                info.points_in_world,
                                info.line_segments_in_world,
                                info.splats_in_world})
        out.add("info.number", static_cast<double>(number));
}

void add_scene(const Scene& scene, SceneHash& out) {
    out.add("positions", scene.positions);
    out.add("indices", scene.indices);
    out.add("shapes", scene.shapes);
    out.add("spheres", scene.spheres);
    out.add("curve_points", scene.curve_points);
    out.add("curve_segments", scene.curve_segments);
    out.add("attributes", scene.attributes);
    out.add("primitives", scene.primitives);
    out.add("world_primitive_count", scene.world_primitive_count);
    out.add("still_primitive_count", scene.static_primitive_count);
    for (const Mesh& mesh : scene.meshes) {  // all but the stamp, which depends on earlier loads
        out.add("mesh.first_primitive", mesh.first_primitive);
        out.add("mesh.primitive_count", mesh.primitive_count);
    }
    out.add("instances", scene.instances);
    add_splats(scene.splats, out);
    out.add("motion.steps", scene.motion.steps);
    out.add("motion.positions", scene.motion.positions);
    out.add("motion.normals", scene.motion.normals);
    out.add("motion.instances", scene.motion.instances);
    out.add("motion.lights", scene.motion.lights);
    out.add("materials", scene.materials);
    out.add("layers", scene.layers);
    out.add("media", scene.media);
    out.add("material_names", scene.material_names);
    out.add("material_numbers", scene.material_numbers);
    out.add("textures.texels", scene.textures.texels);
    out.add("textures.rows", scene.textures.records);
    out.add("lights", scene.lights);
    for (const LightProfile& profile : scene.light_profiles) {
        out.add("profile.polar", profile.polar_deg);
        out.add("profile.azimuth", profile.azimuth_deg);
        out.add("profile.candela", profile.candela);
        out.add("profile.polar_is_aim", profile.polar_is_aim ? 1 : 0);
    }
    if (scene.environment) out.add("environment", scene.environment->pixels);
    add_cameras(scene.cameras, out);
    out.add("bounds", std::span(&scene.bounds, 1));
    add_info(scene.info, out);
}

/// Loads a file in one way and prints a line.
Result<Scene> hash_one(const std::string& file,
                       const gltf::LoadOptions& options,
                       bool lists_arrays) {
    Log log(Verbosity::quiet);
    Result<Scene> scene = gltf::load_gltf(file, options, log);
    std::printf("%s scene=%d variant=%s time=%s ",
                file.c_str(),
                options.scene,
                options.variant.c_str(),
                options.time_s ? std::to_string(*options.time_s).c_str() : "-");
    if (!scene) {
        std::printf("%s %s\n", scene.error().id.c_str(), scene.error().where.c_str());
        return scene;
    }
    if (lists_arrays) std::printf("\n");
    SceneHash hash(lists_arrays);
    add_scene(*scene, hash);
    std::printf("%016llx\n", static_cast<unsigned long long>(hash.total()));
    return scene;
}

void hash_file(const std::string& file, bool lists_arrays) {
    gltf::LoadOptions options;
    options.lenient = true;
    options.occlusion = true;
    const Result<Scene> stored = hash_one(file, options, lists_arrays);
    if (!stored) return;
    const AssetInfo info = stored->info;
    for (const std::string& variant : info.variants) {
        options.variant = variant;
        hash_one(file, options, lists_arrays);
    }
    options.variant.clear();
    for (size_t i = 0; i < info.scenes.size() && info.scenes.size() > 1; ++i) {
        options.scene = static_cast<int>(i);
        hash_one(file, options, lists_arrays);
    }
    options.scene = -1;
    if (info.animations.empty()) return;
    options.animation = "all";
    for (const double time_s : {0.0, 0.4}) {
        options.time_s = time_s;
        hash_one(file, options, lists_arrays);
    }
}

}  // namespace

int main(int argc, char** argv) {
    bool lists_arrays = false;
    for (int i = 1; i < argc; ++i) {
        if (std::string_view(argv[i]) == "--arrays") {
            lists_arrays = true;
        } else {
            hash_file(argv[i], lists_arrays);
        }
    }
    return argc > 1 ? 0 : 64;
}
