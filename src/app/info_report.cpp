// app/info_report.cpp - `obscura info`: a scene as text and as JSON.
// SPDX-License-Identifier: Apache-2.0
#include "app/info_report.h"

#include "app/numbers.h"
#include "base/log.h"
#include "camera/names.h"

#include <fmt/format.h>
#include <numeric>

namespace obscura::app {

namespace {

constexpr double degrees_per_radian = 180.0 / 3.14159265358979323846;

size_t all_texture_bytes(const AssetInfo& info) {
    size_t sum = 0;
    for (const ImageInfo& image : info.images)
        sum += texture_bytes(image);
    return sum;
}

const char* use_of(const ImageInfo& image) {
    if (image.used_as_color) return image.used_as_data ? "colour and data" : "colour";
    return image.used_as_data ? "data" : "unused";
}

std::string mebibytes(size_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024.0 * 1024.0));
}

std::string title(const char* heading) {
    return fmt::format("{:<14}", heading);
}

std::string quoted_name(const std::string& name) {
    return in_quotes(escape_control(name));
}

void append_meshes(const Scene& scene, std::string& text) {
    const AssetInfo& info = scene.info;
    text += title("meshes") + fmt::format("{}\n", info.meshes.size());
    for (size_t i = 0; i < info.meshes.size(); ++i) {
        text += fmt::format("  {:>4} {}: {} triangles\n",
                            i,
                            quoted_name(info.meshes[i].name),
                            info.meshes[i].count);
    }
    text += title("triangles") + fmt::format("{} in the file, {} in the world\n",
                                             triangles_in_file(info),
                                             info.triangles_in_world);
    std::string shapes;
    for (const NamedCount& shape : info.shapes) {
        shapes += fmt::format("{}{} {}", shapes.empty() ? "" : ", ", shape.count, shape.name);
    }
    if (!shapes.empty()) text += title("shapes") + shapes + "\n";
    text += title("instances") + fmt::format("{}\n", scene.instances.size());
    if (info.points_in_world + info.line_segments_in_world > 0) {
        text += title("points, lines") + fmt::format("{} points, {} line segments\n",
                                                     info.points_in_world,
                                                     info.line_segments_in_world);
    }
    if (info.splats_in_world > 0)
        text += title("splats") + fmt::format("{}\n", info.splats_in_world);
}

void append_materials(const Scene& scene, std::string& text) {
    const std::vector<std::string> names = file_materials(scene);
    text += title("materials") + fmt::format("{}\n", names.size());
    for (size_t i = 0; i < names.size(); ++i) {
        text += fmt::format("  {:>4} {}\n", i, quoted_name(names[i]));
    }
    const AssetInfo& info = scene.info;
    text += title("textures") + fmt::format("{} images, {} with mip levels\n",
                                            info.images.size(),
                                            mebibytes(all_texture_bytes(info)));
    for (size_t i = 0; i < info.images.size(); ++i) {
        const ImageInfo& image = info.images[i];
        text += fmt::format("  {:>4} {}: {} {}x{}{}, {}, {}\n",
                            i,
                            quoted_name(image.name),
                            image.format.empty() ? "unread" : image.format,
                            image.width,
                            image.height,
                            image.bits == 16 ? ", 16 bits" : "",
                            use_of(image),
                            mebibytes(texture_bytes(image)));
    }
}

void append_lights(const Scene& scene, std::string& text) {
    text += title("lights") + fmt::format("{}\n", scene.lights.size());
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const PunctualLight& light = scene.lights[i];
        const std::string name = i < scene.info.light_names.size() ? scene.info.light_names[i] : "";
        text += fmt::format("  {:>4} {}: {}, {:g} {:g} {:g} {}\n",
                            i,
                            quoted_name(name),
                            light_type_name(light),
                            light.intensity[0],
                            light.intensity[1],
                            light.intensity[2],
                            light_unit_name(light));
    }
}

void append_cameras(const Scene& scene, std::string& text) {
    text += title("cameras") + fmt::format("{}\n", scene.cameras.size());
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        const SceneCamera& camera = scene.cameras[i];
        text +=
            fmt::format("  {:>4} {}: {}, ", i, quoted_name(camera.name), camera_type_name(camera));
        if (camera.type == SceneCameraType::orthographic) {
            text += fmt::format("xmag {:g} m, ymag {:g} m\n", camera.xmag_m, camera.ymag_m);
        } else {
            const std::string aspect =
                camera.aspect > 0 ? fmt::format("{:g}", camera.aspect) : "the picture's";
            text += fmt::format(
                "yfov {:g} deg, aspect {}\n", camera.yfov_rad * degrees_per_radian, aspect);
        }
        text += fmt::format("       model {}", camera_model_name(camera));
        for (const auto& [name, value] : settings_texts(camera.settings))
            text += fmt::format(" {}={}", name, value);
        text += "\n       world from camera\n";
        for (const auto& row : camera.world_from_camera.m) {
            text += fmt::format("       [{:>12.6g} {:>12.6g} {:>12.6g} {:>12.6g} ]\n",
                                row[0],
                                row[1],
                                row[2],
                                row[3]);
        }
    }
}

void append_rest(const AssetInfo& info, std::string& text) {
    text += title("animations") + fmt::format("{}\n", info.animations.size());
    for (size_t i = 0; i < info.animations.size(); ++i) {
        text += fmt::format("  {:>4} {}: {:g} s, {} channels\n",
                            i,
                            quoted_name(info.animations[i].name),
                            info.animations[i].end_s,
                            info.animations[i].channels);
    }
    text += title("extensions") + fmt::format("{}\n", info.extensions.size());
    for (const ExtensionInfo& extension : info.extensions) {
        text += fmt::format("       {}: {}{}\n",
                            escape_control(extension.name),
                            extension.supported ? "supported" : "ignored",
                            extension.required ? ", required" : "");
        for (const std::string& material : extension.materials) {
            text += fmt::format("         material {}\n", quoted_name(material));
        }
    }
}

}  // namespace

const char* light_type_name(const PunctualLight& light) {
    if (light.profile >= 0) return "profile";
    switch (static_cast<PunctualType>(light.type)) {
        case PunctualType::point:
            return "point";
        case PunctualType::spot:
            return "spot";
        case PunctualType::directional:
            return "directional";
    }
    return "unknown";
}

const char* light_unit_name(const PunctualLight& light) {
    if (light.profile >= 0) return "times the profile";
    return static_cast<PunctualType>(light.type) == PunctualType::directional ? "lux" : "candela";
}

const char* camera_type_name(const SceneCamera& camera) {
    return camera.type == SceneCameraType::perspective ? "perspective" : "orthographic";
}

const char* camera_model_name(const SceneCamera& camera) {
    const CameraModel core = camera.type == SceneCameraType::perspective
                                 ? CameraModel::pinhole
                                 : CameraModel::orthographic;
    return name_of(camera_model_names, implied_model(camera.settings).value_or(core));
}

std::vector<std::string> file_materials(const Scene& scene) {
    std::vector<std::string> names;
    for (size_t index = 0; index < scene.material_names.size(); ++index) {
        // Reduced copies of a material follow the first of each.
        const bool is_next = scene.material_numbers[index] == static_cast<int32_t>(names.size());
        if (is_next) names.push_back(scene.material_names[index]);
    }
    return names;
}

size_t triangles_in_file(const AssetInfo& info) {
    return std::accumulate(
        info.meshes.begin(), info.meshes.end(), size_t{0}, [](size_t sum, const NamedCount& mesh) {
            return sum + mesh.count;
        });
}

size_t texture_bytes(const ImageInfo& image) {
    const size_t copies = (image.used_as_color ? 1U : 0U) + (image.used_as_data ? 1U : 0U);
    if (copies == 0 || image.width < 1 || image.height < 1) return 0;
    const size_t planes = image.bits == 16 ? 2 : 1;
    return copies * planes * mip_chain_texels(image.width, image.height) * sizeof(uint32_t);
}

std::string info_table(const Scene& scene) {
    const AssetInfo& info = scene.info;
    std::string text;
    const auto line = [&](const char* heading, const std::string& content) {
        if (!content.empty()) text += title(heading) + escape_control(content) + "\n";
    };
    line("file", info.file_name);
    line("glTF", info.version);
    line("generator", info.generator);
    line("copyright", info.copyright);
    for (size_t i = 0; i < info.scenes.size(); ++i) {
        const bool shown = static_cast<int>(i) == info.scene;
        text += title(i == 0 ? "scenes" : "") +
                fmt::format("{} {}{}\n", i, quoted_name(info.scenes[i]), shown ? " (shown)" : "");
    }
    for (size_t i = 0; i < info.variants.size(); ++i) {
        const bool shown = info.variants[i] == info.variant;
        text += title(i == 0 ? "variants" : "") +
                fmt::format("{}{}\n", quoted_name(info.variants[i]), shown ? " (shown)" : "");
    }
    if (!scene.bounds.empty()) {
        const Vec3f& low = scene.bounds.low;
        const Vec3f& high = scene.bounds.high;
        text += title("bounds") + fmt::format("{:g} {:g} {:g} to {:g} {:g} {:g} m\n",
                                              low.x,
                                              low.y,
                                              low.z,
                                              high.x,
                                              high.y,
                                              high.z);
    }
    append_meshes(scene, text);
    append_materials(scene, text);
    append_lights(scene, text);
    if (!info.environment.empty()) {
        text += title("environment") + quoted_name(info.environment) + "\n";
    }
    append_cameras(scene, text);
    append_rest(info, text);
    return text;
}

}  // namespace obscura::app
