// dataset/write_labels.cpp - writes the label files of one image: depth, ids, masks and their JSON.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/write_labels.h"

#include "base/atomic_file.h"
#include "base/json/json.h"
#include "base/parallel.h"
#include "film/cryptomatte_names.h"
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

UnsetArray<float> grey_of(std::span<const uint8_t> mask) {
    UnsetArray<float> out;
    out.resize(mask.size());
    std::transform(mask.begin(), mask.end(), out.begin(), [](uint8_t inside) {
        return static_cast<float>(inside);
    });
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

/// Depths beyond what 16 bits hold become 0, unknown; returns how many.
Result<size_t> write_depth(const fs::path& file, const RayLabels& rays, double unit_mm) {
    UnsetArray<float> codes;
    codes.resize(rays.depth_m.size());
    size_t lost = 0;
    for (size_t i = 0; i < codes.size(); ++i) {
        const double code = std::round(static_cast<double>(rays.depth_m[i]) * mm_per_m / unit_mm);
        const bool fits = code <= largest_code;
        lost += fits ? 0 : 1;
        codes[i] = static_cast<float>(fits ? std::max(code, 0.0) / largest_code : 0);
    }
    constexpr int bits = 16;
    if (auto written = write_grey(file, rays, std::move(codes), bits); !written)
        return fail(written.error());
    return lost;
}

/// Masks of each object, by its number among those of the image, as BOP names them.
Result<void> write_masks(const LabelOptions& options,
                         const std::string& name,
                         const RayLabels& rays,
                         const std::vector<ObjectLabel>& objects) {
    std::vector<Result<void>> written(objects.size());
    constexpr int bits = 8;
    parallel_for(objects.size(), [&](size_t i) {
        const int32_t node = objects[i].node;
        const std::string file = fmt::format("{}_{:06}.png", name, i);
        written[i] = write_grey(
            options.folder / mask_folder / file, rays, grey_of(silhouette_mask(rays, node)), bits);
        if (!written[i]) return;
        written[i] = write_grey(options.folder / visible_mask_folder / file,
                                rays,
                                grey_of(visible_mask(rays, node)),
                                bits);
    });
    for (Result<void>& one : written) {
        if (!one) return std::move(one);
    }
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

Json mask_json(const RayLabels& rays, const std::vector<uint8_t>& mask) {
    const auto width = static_cast<size_t>(rays.width);
    const auto height = static_cast<size_t>(rays.height);
    return {{"size", {rays.height, rays.width}},
            {"counts", coco_counts(run_lengths(mask, width, height))}};
}

Json object_json(const RayLabels& rays,
                 const ObjectLabel& object,
                 const Affined& camera_from_world,
                 const std::string& path) {
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
            {"visibility", object.visibility()},
            {"mask", mask_json(rays, silhouette_mask(rays, object.node))},
            {"mask_visible", mask_json(rays, visible_mask(rays, object.node))}};
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

/// All nodes that something of the scene belongs to.
Json objects_json(const Scene& scene) {
    std::set<int32_t> nodes;
    for_each_node_primitive(
        scene, [&](int32_t node, int32_t /*instance*/, const Primitive& /*primitive*/) {
            if (node >= 0) nodes.insert(node);
        });
    const std::vector<std::string> paths = node_paths(scene.info);
    Json objects = Json::array();
    for (const int32_t node : nodes) {
        const auto number = static_cast<size_t>(node);
        const int32_t mesh = scene.info.node_meshes[number];
        objects.push_back({{"id", node + 1},
                           {"node", paths[number]},
                           {"mesh", mesh_name(scene.info, number)},
                           {"mesh_index", mesh < 0 ? Json() : Json(mesh)},
                           {"stretch", rows_json(rigid_pose(scene.node_places[number]).stretch)}});
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
    return std::pow(10.0, std::ceil(std::log10(farthest_m * mm_per_m / largest_code)));
}

Result<void> write_labels(const LabelOptions& options, const LabelledImage& image, Log& log) {
    const RenderRequest& request = image.request;
    const Scene& scene = image.prepared.scene();
    if (auto fits = check_segmentation(scene); !fits) return fits;
    const RayLabels rays = trace_labels(image.prepared, image.camera.camera, request.options);
    const std::vector<ObjectLabel> objects = label_objects(rays, scene);
    const std::string name = request.outputs.front().stem().string();
    const double unit_mm = options.depth_unit_mm.value_or(depth_unit_mm(request, scene));

    const fs::path color = request.outputs.front().filename();
    const std::string png = name + ".png";
    const Result<size_t> lost = write_depth(options.folder / depth_folder / png, rays, unit_mm);
    if (!lost) return fail(lost.error());
    if (*lost > 0) {
        log.warn((options.folder / depth_folder / png).string(),
                 fmt::format("{} pixels are further away than 65535 steps of {} mm; they are 0, "
                             "unknown. --depth-unit takes larger steps",
                             *lost,
                             unit_mm));
    }
    auto ids = write_segmentation(options.folder / segmentation_folder / png, rays);
    if (!ids) return ids;
    if (options.writes_masks) {
        if (auto masks = write_masks(options, name, rays, objects); !masks) return masks;
    }
    const std::vector<std::string> paths = node_paths(scene.info);
    const Affined camera_from_world = opencv_from_world(image.camera.camera);
    Json list = Json::array();
    for (const ObjectLabel& object : objects)
        list.push_back(
            object_json(rays, object, camera_from_world, paths[static_cast<size_t>(object.node)]));
    const Json document = {
        {"image", (fs::path(color_folder) / color).string()},
        {"depth", (fs::path(depth_folder) / png).string()},
        {"depth_unit_mm", unit_mm},
        {"depth_along", measures_from_eye(image.camera.camera.model) ? "ray" : "axis"},
        {"segmentation", (fs::path(segmentation_folder) / png).string()},
        {"width", rays.width},
        {"height", rays.height},
        {"camera", camera_json(request, image.camera)},
        {"variant", scene.info.variant.empty() ? Json() : Json(scene.info.variant)},
        {"environment_rotation", request.environment_rotation_deg},
        {"time", scene.info.time_s ? Json(*scene.info.time_s) : Json()},
        {"objects", std::move(list)}};
    if (auto all = write_json(options.folder / objects_file, objects_json(scene)); !all) return all;
    return write_json(options.folder / labels_folder / (name + ".json"), document);
}

}  // namespace obscura::dataset
