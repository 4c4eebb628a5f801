// app/camera_choice.cpp - which camera a picture is taken with.
// SPDX-License-Identifier: Apache-2.0
#include "app/camera_choice.h"

#include "app/framing.h"
#include "app/numbers.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// A camera before it becomes one of the models: a pinhole's half angle or a parallel view's half
/// height, and the distance at which one turns into the other.
struct Placed {
    Affined world_from_camera;
    CameraModel model = CameraModel::pinhole;
    double tan_half_yfov = 0;
    double half_height_m = 0;
    double znear_m = 0;  ///< 0: from the scene's size
    double zfar_m = 0;
    std::string description;
};

/// Distance from the camera to the scene's middle along the view; the radius when that is behind.
double distance_to_middle(const Affined& world_from_camera, const BoundingSphere& sphere) {
    const auto& m = world_from_camera.m;
    const Vec3d backward = {m[0][2], m[1][2], m[2][2]};
    const Vec3d eye = {m[0][3], m[1][3], m[2][3]};
    const double distance = dot(eye - sphere.centre_m, backward);
    return distance > 1e-3 * sphere.radius_m ? distance : sphere.radius_m;
}

std::string list_cameras(const std::vector<SceneCamera>& cameras) {
    std::string text;
    for (size_t i = 0; i < cameras.size(); ++i) {
        text += (i == 0 ? "" : ", ") + std::to_string(i) + " '" + cameras[i].name + "'";
    }
    return text;
}

Result<size_t> find_camera(const std::vector<SceneCamera>& cameras, const std::string& choice) {
    const auto has_name = [&](const SceneCamera& camera) { return camera.name == choice; };
    const auto named = std::count_if(cameras.begin(), cameras.end(), has_name);
    const auto first = std::find_if(cameras.begin(), cameras.end(), has_name);
    if (named == 1) return static_cast<size_t>(first - cameras.begin());
    if (named > 1) {
        return fail(ExitCode::usage,
                    "E-CAM-AMBIGUOUS",
                    "--camera",
                    "several cameras are called '" + choice +
                        "'; give one of the indices: " + list_cameras(cameras));
    }
    if (is_index(choice) && choice.size() < 10 && std::stoul(choice) < cameras.size()) {
        return std::stoul(choice);
    }
    return fail(ExitCode::usage,
                "E-CAM-UNKNOWN",
                "--camera",
                "there is no camera '" + choice + "'; " +
                    (cameras.empty() ? "the scene has none: leave out --camera to frame it all"
                                     : "the scene has: " + list_cameras(cameras)));
}

/// Half the vertical angle's tangent such that the camera's own view is whole in the picture.
double uncropped_half_height(double half_height, double half_width, double picture_aspect) {
    return std::max(half_height, half_width / picture_aspect);
}

Result<Placed> place_from_file(const Scene& scene, size_t index, double picture_aspect) {
    const SceneCamera& source = scene.cameras[index];
    const Result<Affined> rigid = rigid_part(
        source.world_from_camera, scene.info.file_name + " camera '" + source.name + "'");
    if (!rigid) return fail(rigid.error());
    Placed placed;
    placed.world_from_camera = *rigid;
    placed.znear_m = source.znear_m;
    placed.zfar_m = source.zfar_m;
    placed.description = "camera " + std::to_string(index) + " '" + source.name + "' of the file";
    if (source.type == SceneCameraType::orthographic) {
        placed.model = CameraModel::orthographic;
        placed.half_height_m =
            uncropped_half_height(std::abs(source.ymag_m), std::abs(source.xmag_m), picture_aspect);
        return placed;
    }
    const double half_height = std::tan(0.5 * source.yfov_rad);
    placed.tan_half_yfov =
        uncropped_half_height(half_height, half_height * source.aspect, picture_aspect);
    return placed;
}

Framing automatic_framing(const Scene& scene, const CameraRequest& request, double aspect) {
    const bool orthographic = request.model == CameraModel::orthographic && !request.yfov_rad;
    return orthographic ? frame_orthographic(scene.bounds, aspect)
                        : frame_perspective(
                              scene.bounds, request.yfov_rad.value_or(default_yfov_rad), aspect);
}

/// The viewpoint of the options over the framing's. Where --up is not given, a view straight up or
/// down takes the world's -Z as up.
Viewpoint viewpoint_by_hand(const CameraRequest& request, const Viewpoint& framed) {
    Viewpoint view = framed;
    view.eye_m = request.eye_m.value_or(framed.eye_m);
    view.target_m = request.target_m.value_or(framed.target_m);
    if (request.up) {
        view.up = *request.up;
        return view;
    }
    const Vec3d along = view.eye_m - view.target_m;
    const double sideways = std::hypot(along.x, along.z);
    if (sideways <= 1e-6 * length(along)) view.up = {0, 0, -1};
    return view;
}

Result<Placed> place_outside(const Scene& scene, const CameraRequest& request, double aspect) {
    const Framing framing = automatic_framing(scene, request, aspect);
    const bool by_hand = request.eye_m || request.target_m || request.up;
    const Viewpoint view = by_hand ? viewpoint_by_hand(request, framing.view) : framing.view;
    const Result<Affined> world_from_camera = look_at(view);
    if (!world_from_camera) return fail(world_from_camera.error());

    const double distance = length(view.eye_m - view.target_m);
    Placed placed;
    placed.world_from_camera = *world_from_camera;
    placed.model = request.model.value_or(CameraModel::pinhole);
    placed.tan_half_yfov = std::tan(0.5 * request.yfov_rad.value_or(default_yfov_rad));
    placed.half_height_m = by_hand ? distance * placed.tan_half_yfov : framing.half_height_m;
    placed.description =
        by_hand ? "placed by --eye, --target, --up" : "automatic framing of the whole scene";
    return placed;
}

/// Applies --camera-model and --fov to a camera of the file.
void override_lens(Placed& placed, const CameraRequest& request, const BoundingSphere& sphere) {
    const CameraModel wanted = request.model.value_or(placed.model);
    const double distance = distance_to_middle(placed.world_from_camera, sphere);
    if (request.yfov_rad) {
        placed.tan_half_yfov = std::tan(0.5 * *request.yfov_rad);
        placed.half_height_m = distance * placed.tan_half_yfov;
    } else if (wanted != placed.model) {
        if (wanted == CameraModel::orthographic) {
            placed.half_height_m = distance * placed.tan_half_yfov;
        } else {
            placed.tan_half_yfov = placed.half_height_m / distance;
        }
    }
    placed.model = wanted;
}

/// Near and far planes around the whole scene where the camera names none.
void choose_planes(const Placed& placed, const BoundingSphere& sphere, ChosenCamera& out) {
    const double middle = distance_to_middle(placed.world_from_camera, sphere);
    const double far_side = middle + 2 * sphere.radius_m;
    out.zfar_m = placed.zfar_m > 0 ? placed.zfar_m : far_side;
    out.znear_m = placed.znear_m > 0 ? placed.znear_m
                                     : std::max(middle - 2 * sphere.radius_m, 1e-4 * far_side);
    if (!(out.zfar_m > out.znear_m)) out.zfar_m = 1e4 * out.znear_m;
}

bool fits_float(const Camera& camera) {
    const auto positive = [](float f) { return f > 0 && std::isfinite(f); };
    const bool lens = camera.model == CameraModel::orthographic
                          ? positive(camera.orthographic.half_width_m) &&
                                positive(camera.orthographic.half_height_m) &&
                                positive(camera.orthographic.pixel_width_m)
                          : positive(camera.pinhole.tan_half_yfov);
    const auto& m = camera.world_from_camera.m;
    return lens && std::isfinite(m[0][3]) && std::isfinite(m[1][3]) && std::isfinite(m[2][3]);
}

}  // namespace

Result<ChosenCamera> choose_camera(
    const Scene& scene, const CameraRequest& request, int width_px, int height_px, Log& log) {
    const double aspect = static_cast<double>(width_px) / height_px;
    const BoundingSphere sphere = bounding_sphere(scene.bounds);
    const bool by_hand = request.eye_m || request.target_m || request.up;
    const bool from_file = !by_hand && (!request.choice.empty() || !scene.cameras.empty());
    Result<Placed> placed = Placed{};
    if (from_file) {
        const Result<size_t> index =
            request.choice.empty() ? Result<size_t>(0) : find_camera(scene.cameras, request.choice);
        if (!index) return fail(index.error());
        placed = place_from_file(scene, *index, aspect);
        if (placed) override_lens(*placed, request, sphere);
    } else {
        placed = place_outside(scene, request, aspect);
    }
    if (!placed) return fail(placed.error());

    ChosenCamera out;
    out.camera.model = placed->model;
    out.camera.world_from_camera = affine_cast<float>(placed->world_from_camera);
    out.camera.pinhole.tan_half_yfov = static_cast<float>(placed->tan_half_yfov);
    out.camera.pinhole.aspect = static_cast<float>(aspect);
    out.camera.pinhole.pixel_spread = static_cast<float>(2 * placed->tan_half_yfov / height_px);
    out.camera.orthographic.half_width_m = static_cast<float>(placed->half_height_m * aspect);
    out.camera.orthographic.half_height_m = static_cast<float>(placed->half_height_m);
    out.camera.orthographic.pixel_width_m =
        static_cast<float>(2 * placed->half_height_m / height_px);
    if (!fits_float(out.camera)) {
        return fail(ExitCode::bad_data,
                    "E-CAM-RANGE",
                    scene.info.file_name,
                    "the camera's position or size is zero or beyond what 32-bit floats hold");
    }
    choose_planes(*placed, sphere, out);
    out.description = placed->description;
    log.detail("camera: " + out.description);
    return out;
}

}  // namespace obscura
