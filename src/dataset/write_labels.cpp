// dataset/write_labels.cpp - writes the label files of one image: depth, ids, masks and their JSON.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/write_labels.h"

#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "base/json/json.h"
#include "base/json/json_file.h"
#include "base/name_search.h"
#include "base/parallel.h"
#include "base/setting_names.h"
#include "film/cryptomatte_names.h"
#include "image/fingerprint.h"
#include "image/write.h"
#include "scene/node_primitives.h"
#include "session/framing.h"
#include "session/opencv_camera.h"
#include "session/segmentation.h"

#include "dataset/image_labels.h"
#include "dataset/run_length.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <span>
#include <system_error>

namespace obscura::dataset {

namespace {

namespace fs = std::filesystem;

constexpr double largest_code = 65535;  ///< of 16 bits

Result<void> write_json(const fs::path& file, const Json& json) {
    const std::string text = json_line(json) + "\n";
    return write_file_atomically(file, std::as_bytes(std::span(text)));
}

/// Writes numbers in [0, 1] as a grey image.
Result<void> write_grey(const fs::path& file,
                        const RayLabels& rays,
                        UnsetArray<float>&& values,
                        int bits) {
    const OutputImage image{rays.width, rays.height, {"Y"}, std::move(values)};
    ImageMetadata metadata;
    metadata.software = "Obscura " OBSCURA_VERSION;
    metadata.is_color = false;
    DisplayEncoding encoding;
    encoding.bits = bits;
    const auto written = write_image_file(file, image, metadata, {}, encoding);
    if (!written) return fail(written.error());
    return {};
}

UnsetArray<float> grey_of(const RayLabels& rays, std::span<const uint32_t> inside) {
    UnsetArray<float> out;
    out.resize(rays.node.size());
    std::fill(out.begin(), out.end(), 0.0f);
    for (const uint32_t pixel : inside)
        out[pixel] = 1;
    return out;
}

Result<void> write_segmentation(const fs::path& file, const RayLabels& rays) {
    UnsetArray<float> codes;
    codes.resize(rays.node.size());
    std::transform(rays.node.begin(), rays.node.end(), codes.begin(), [](int32_t node) {
        return static_cast<float>((node + 1) / largest_code);
    });
    constexpr int bits = 16;
    return write_grey(file, rays, std::move(codes), bits);
}

/// Depths in steps of the unit; 0: unknown. Those beyond what 16 bits hold are too.
struct DepthCodes {
    std::vector<uint16_t> by_pixel;
    size_t too_far = 0;  ///< pixels
};

DepthCodes depth_codes(const RayLabels& rays, double unit_mm) {
    DepthCodes out;
    out.by_pixel.reserve(rays.depth_m.size());
    for (const float depth_m : rays.depth_m) {
        const double code = std::round(static_cast<double>(depth_m) * mm_per_m / unit_mm);
        const bool fits = code <= largest_code;
        out.too_far += fits ? 0 : 1;
        out.by_pixel.push_back(fits ? static_cast<uint16_t>(std::max(code, 0.0)) : uint16_t{0});
    }
    return out;
}

Result<void> write_depth(const fs::path& file, const RayLabels& rays, const DepthCodes& depths) {
    UnsetArray<float> values;
    values.resize(depths.by_pixel.size());
    std::transform(
        depths.by_pixel.begin(), depths.by_pixel.end(), values.begin(), [](uint16_t code) {
            return static_cast<float>(code / largest_code);
        });
    constexpr int bits = 16;
    return write_grey(file, rays, std::move(values), bits);
}

/// An object of an image, with its masks.
struct MaskedObject {
    ObjectLabel label;
    Masks masks;
    std::ptrdiff_t pixels_with_depth = 0;  ///< of all in the image, hidden or not
};

std::vector<MaskedObject> masked_objects(const RayLabels& rays,
                                         const DepthCodes& depths,
                                         const Scene& scene) {
    std::vector<MaskedObject> out;
    for (const ObjectLabel& label : label_objects(rays, scene))
        out.push_back({label, {}});
    parallel_for(out.size(), [&](size_t i) {
        MaskedObject& object = out[i];
        object.masks = masks_of(rays, object.label);
        const std::vector<uint32_t>& all = object.masks.all;
        object.pixels_with_depth = std::count_if(
            all.begin(), all.end(), [&](uint32_t pixel) { return depths.by_pixel[pixel] != 0; });
    });
    return out;
}

/// The name of an object's mask, by its number among those of the image.
std::string mask_file(const std::string& image, size_t object) {
    return fmt::format("{}_{:06}.png", image, object);
}

/// The number of objects that an image's labels tell of; none where they are not whole.
std::optional<size_t> labelled_objects(const fs::path& file) {
    const FileBytes read = read_file_bytes(file, {});
    if (read.fault != FileFault::none) return {};
    const auto* const text = reinterpret_cast<const char*>(read.bytes.data());
    const auto labels =
        nlohmann::json::parse(text, text + read.bytes.size(), nullptr, /*allow_exceptions=*/false);
    if (!labels.is_object() || !labels.contains("objects")) return {};
    return labels.at("objects").size();
}

/// Removes the masks of further objects: an earlier image of this name may have had more.
void remove_masks_from(const fs::path& folder, const std::string& image, size_t object) {
    std::error_code ignored;
    for (bool any = true; any; ++object) {
        any = false;
        for (const char* const masks : {mask_folder, visible_mask_folder})
            any = fs::remove(folder / masks / mask_file(image, object), ignored) || any;
    }
}

/// Masks of each object, by its number among those of the image, as BOP names them.
Result<void> write_masks(const fs::path& folder,
                         const std::string& name,
                         const RayLabels& rays,
                         const std::vector<MaskedObject>& objects,
                         const std::atomic<bool>& stop) {
    std::vector<Result<void>> written(objects.size());
    constexpr int bits = 8;
    parallel_for(objects.size(), [&](size_t i) {
        if (stop) {
            written[i] = fail(ExitCode::stopped_early, "E-STOPPED", name, "stopped on request");
            return;
        }
        const Masks& masks = objects[i].masks;
        const std::string file = mask_file(name, i);
        written[i] = write_grey(folder / mask_folder / file, rays, grey_of(rays, masks.all), bits);
        if (!written[i]) return;
        written[i] = write_grey(
            folder / visible_mask_folder / file, rays, grey_of(rays, masks.visible), bits);
    });
    for (Result<void>& one : written) {
        if (!one) return std::move(one);
    }
    remove_masks_from(folder, name, objects.size());
    return {};
}

Json box_json(const std::optional<PixelBox>& box) {
    if (!box) return nullptr;
    return {box->left, box->top, box->width, box->height};
}

Json rows_json(const Affined& a) {
    Json out = Json::array();
    for (const auto& row : a.m)
        out.push_back({row[0], row[1], row[2]});
    return out;
}

Json mask_json(const RayLabels& rays, std::span<const uint32_t> inside) {
    const auto width = static_cast<size_t>(rays.width);
    const auto height = static_cast<size_t>(rays.height);
    return {{"size", {rays.height, rays.width}},
            {"counts", coco_counts(run_lengths(inside, width, height))}};
}

Json object_json(const RayLabels& rays,
                 const MaskedObject& masked,
                 const Affined& camera_from_world,
                 const std::string& path) {
    const ObjectLabel& object = masked.label;
    const Affined pose = compose(camera_from_world, object.pose.world_from_model);
    return {{"id", object.node + 1},
            {"node", path},
            {"R", rows_json(pose)},
            {"t", {pose.m[0][3], pose.m[1][3], pose.m[2][3]}},
            {"stretch", rows_json(object.pose.stretch)},
            {"box", box_json(object.box)},
            {"box_visible", box_json(object.visible_box)},
            {"pixels", object.pixels},
            {"pixels_inside", object.pixels_inside},
            {"pixels_visible", object.visible_pixels},
            {"pixels_with_depth", masked.pixels_with_depth},
            {"visibility", object.visibility()},
            {"mask", mask_json(rays, masked.masks.all)},
            {"mask_visible", mask_json(rays, masked.masks.visible)}};
}

Json camera_json(const RenderRequest& request, const ChosenCamera& chosen) {
    const ImageSize size = {request.options.width, request.options.height};
    Json out = {{"K", intrinsics_json(chosen, size)}};
    const auto& distortion = chosen.settings.distortion;
    if (is_distorted(chosen.camera) && distortion) out["distortion"] = *distortion;
    add_pose_json(chosen.camera, out);
    Json rows = Json::array();
    for (const auto& row : chosen.camera.world_from_camera.m)
        rows.push_back({row[0], row[1], row[2], row[3]});
    rows.push_back({0, 0, 0, 1});
    out["world_from_camera"] = std::move(rows);
    return out;
}

/// Whether an object of one image may be none in another one: flags go by materials, and these by
/// variants.
bool objects_vary(const RenderRequest& request, const Scene& scene) {
    if (!request.lists.sampling.chooses_variant || scene.info.variants.size() < 2) return false;
    const std::vector<std::string>& materials = scene.material_names;
    const auto& rules = request.load.visibility;
    return std::any_of(rules.begin(), rules.end(), [&](const auto& rule) {
        if ((rule.flag & visibility_no_object) == 0) return false;
        return std::any_of(materials.begin(), materials.end(), [&](const std::string& name) {
            return !name.empty() && fits_pattern(rule.pattern, name);
        });
    });
}

/// All nodes that an image of the scene may show as objects.
std::set<int32_t> object_nodes(const RenderRequest& request, const Scene& scene) {
    // Models have one number in all images: what only some of them show is listed, too.
    const uint8_t left_out = objects_vary(request, scene) ? uint8_t{0} : visibility_no_object;
    std::set<int32_t> nodes;
    for_each_node_primitive(scene, [&](int32_t node, int32_t instance, const Primitive& primitive) {
        const auto number = static_cast<int32_t>(&primitive - scene.primitives.data());
        const bool is_shown = (scene.visibility.of(number, instance) & left_out) == 0;
        if (node >= 0 && is_shown) nodes.insert(node);
    });
    return nodes;
}

Json objects_json(const RenderRequest& request,
                  const Scene& scene,
                  const std::vector<std::string>& paths) {
    Json objects = Json::array();
    for (const int32_t node : object_nodes(request, scene)) {
        const auto number = static_cast<size_t>(node);
        const int32_t mesh = scene.info.node_meshes[number];
        const NodePlace& place = scene.node_places[number];
        objects.push_back({{"id", node + 1},
                           {"node", paths[number]},
                           {"mesh", mesh_name(scene.info, number)},
                           {"mesh_index", mesh < 0 ? Json() : Json(mesh)},
                           {"own_shape", place.has_own_shape},
                           {"stretch", rows_json(rigid_pose(place.world_from_mesh).stretch)}});
    }
    return {{"asset", scene.info.file_name}, {"objects", std::move(objects)}};
}

}  // namespace

std::string image_name(int number) {
    return fmt::format("{:06}", number);
}

double depth_unit_mm(const RenderRequest& request, const Scene& scene) {
    const double radius = bounding_sphere(scene.bounds).radius_m;
    const RenderOptions& options = request.options;
    const double aspect = static_cast<double>(options.width) / options.height;
    const double half = std::tan(0.5 * request.camera.yfov_rad.value_or(default_yfov_rad));
    const double slope = request.lists.sampling.fill[0] * half * std::min(1.0, aspect);
    const double around = radius * (std::sqrt(1 + 1 / (slope * slope)) + 1);
    const double farthest_m =
        request.lists.sampling.space == ViewSpace::box ? 2 * radius : std::max(around, 3 * radius);
    const double unit = std::pow(10.0, std::ceil(std::log10(farthest_m * mm_per_m / largest_code)));
    return std::clamp(unit, min_depth_unit_mm, max_depth_unit_mm);
}

/// Once for all images: folders, names, and what is the same in all.
Result<void> LabelWriter::begin(const RenderRequest& request, const Scene& scene) {
    if (!paths_.empty()) return {};
    for (const char* name : all_folders) {
        const bool is_of_masks = name == mask_folder || name == visible_mask_folder;
        if (name == color_folder || name == layers_folder) continue;  // made with the outputs
        if (is_of_masks && !options_.writes_masks) continue;
        std::error_code error;
        fs::create_directories(options_.folder / name, error);
        if (!error) continue;
        return fail(ExitCode::cannot_create,
                    "E-OUT-CREATE",
                    (options_.folder / name).string(),
                    "the folder cannot be made: " + error.message());
    }
    std::vector<std::string> paths = node_paths(scene.info);
    auto written = write_json(options_.folder / objects_file, objects_json(request, scene, paths));
    if (written) paths_ = std::move(paths);
    return written;
}

void LabelWriter::warn_of_far_pixels(const fs::path& file, size_t count, Log& log) const {
    if (count == 0) return;
    log.warn(file.string(),
             fmt::format("{} pixels are further away than 65535 steps of {} mm; they are 0, "
                         "unknown. {} takes larger steps",
                         count,
                         unit_mm_,
                         setting("depth-unit")));
}

Result<void> LabelWriter::write(const LabelledImage& image, Log& log) {
    const RenderRequest& request = image.request;
    const Scene& scene = image.prepared.scene();
    if (auto fits = check_segmentation(scene); !fits) return fits;
    if (auto begun = begin(request, scene); !begun) return begun;
    unit_mm_ = options_.depth_unit_mm.value_or(depth_unit_mm(request, scene));
    const RayLabels rays = trace_labels(image.prepared, image.camera.camera, request.options);
    const DepthCodes depths = depth_codes(rays, unit_mm_);
    const std::vector<MaskedObject> objects = masked_objects(rays, depths, scene);
    const fs::path color = request.outputs.front().filename();
    const std::string name = color.stem().string();
    const std::string png = name + ".png";
    if (objects.empty()) log.warn(name, "the image shows no object; its labels are empty");
    const fs::path depth_file = options_.folder / depth_folder / png;
    if (auto written = write_depth(depth_file, rays, depths); !written) return written;
    warn_of_far_pixels(depth_file, depths.too_far, log);
    auto coded = write_segmentation(options_.folder / segmentation_folder / png, rays);
    if (!coded) return coded;
    if (options_.writes_masks) {
        auto masks = write_masks(options_.folder, name, rays, objects, image.stop);
        if (!masks) return masks;
    }
    const Affined camera_from_world = opencv_from_world(image.camera.camera);
    Json list = Json::array();
    for (const MaskedObject& object : objects)
        list.push_back(object_json(
            rays, object, camera_from_world, paths_[static_cast<size_t>(object.label.node)]));
    const Json document = {
        {"image", (fs::path(color_folder) / color).string()},
        {"depth", (fs::path(depth_folder) / png).string()},
        {"depth_unit_mm", unit_mm_},
        {"depth_along", measures_from_eye(image.camera.camera.model) ? "ray" : "axis"},
        {"segmentation", (fs::path(segmentation_folder) / png).string()},
        {"width", rays.width},
        {"height", rays.height},
        {"camera", camera_json(request, image.camera)},
        {"variant", scene.info.variant.empty() ? Json() : Json(scene.info.variant)},
        {"environment_rotation", request.environment_rotation_deg},
        {"time", scene.info.time_s ? Json(*scene.info.time_s) : Json()},
        {"objects", std::move(list)}};
    return write_json(options_.folder / labels_folder / (name + ".json"), document);
}

bool LabelWriter::has_written(const fs::path& image) const {
    const std::string name = image.stem().string();
    const auto has_image = [&](const char* folder, const std::string& file) {
        return read_fingerprint(options_.folder / folder / file).has_value();
    };
    const std::optional<size_t> objects =
        labelled_objects(options_.folder / labels_folder / (name + ".json"));
    if (!objects || !has_image(depth_folder, name + ".png") ||
        !has_image(segmentation_folder, name + ".png"))
        return false;
    for (size_t i = 0; options_.writes_masks && i < *objects; ++i) {
        const std::string file = mask_file(name, i);
        if (!has_image(mask_folder, file) || !has_image(visible_mask_folder, file)) return false;
    }
    return true;
}

}  // namespace obscura::dataset
