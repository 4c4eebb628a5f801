// session/camera_choice.cpp - chooses the camera of an image: asked for, of the file, or framed.
// SPDX-License-Identifier: Apache-2.0
#include "session/camera_choice.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "scene/frame_motion.h"
#include "session/aperture_image.h"
#include "session/framing.h"
#include "session/model_settings.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace obscura {

namespace {

/// A camera before it becomes one of the models: a pinhole's half angle or a parallel view's half
/// height, and the distance at which one turns into the other.
struct Placed {
    Affined world_from_camera;
    std::vector<Affined> moving;  ///< the same while the shutter is open; empty: it stands still
    CameraModel model = CameraModel::pinhole;
    double tan_half_yfov = 0;
    double half_height_m = 0;
    double znear_m = 0;  ///< 0: from the scene's size
    double zfar_m = 0;
    CameraSettings settings;
    std::optional<double> target_m;  ///< distance of the point that was aimed at
    std::optional<size_t> of_file;   ///< index in Scene::cameras
    std::string description;
};

/// Distance from the camera to the scene's centre along the view; the radius when that is behind.
double distance_to_centre(const Affined& world_from_camera, const BoundingSphere& sphere) {
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
                    setting("camera"),
                    "several cameras are called '" + choice +
                        "'; give the index of one: " + list_cameras(cameras));
    }
    if (is_index(choice) && choice.size() < 10 && std::stoul(choice) < cameras.size()) {
        return std::stoul(choice);
    }
    return fail(ExitCode::usage,
                "E-CAM-UNKNOWN",
                setting("camera"),
                "there is no camera '" + choice + "'; " +
                    (cameras.empty()
                         ? "the scene has none: leave out " + setting("camera") + " to frame it all"
                         : "the scene has: " + list_cameras(cameras)));
}

/// Tangent of the half vertical angle that shows the camera's whole view in the image.
double uncropped_half_height(double half_height, double half_width, double image_aspect) {
    return std::max(half_height, half_width / image_aspect);
}

Result<Placed> place_as_given(const SceneCamera& source,
                              const std::string& where,
                              double image_aspect) {
    const Result<Affined> rigid = rigid_part(source.world_from_camera, where);
    if (!rigid) return fail(rigid.error());
    Placed placed;
    placed.world_from_camera = *rigid;
    for (const Affined& placing : source.moving) {
        const Result<Affined> moved = rigid_part(placing, where);
        if (!moved) return fail(moved.error());
        placed.moving.push_back(*moved);
    }
    placed.znear_m = source.znear_m;
    placed.zfar_m = source.zfar_m;
    placed.settings = source.settings;
    if (source.type == SceneCameraType::orthographic) {
        placed.model = CameraModel::orthographic;
        placed.half_height_m =
            uncropped_half_height(std::abs(source.ymag_m), std::abs(source.xmag_m), image_aspect);
        return placed;
    }
    const double half_height = std::tan(0.5 * source.yfov_rad);
    placed.tan_half_yfov =
        uncropped_half_height(half_height, half_height * source.aspect, image_aspect);
    return placed;
}

Result<Placed> place_from_file(const Scene& scene, size_t index, double image_aspect) {
    const SceneCamera& source = scene.cameras[index];
    Result<Placed> placed = place_as_given(
        source, scene.info.file_name + " camera '" + source.name + "'", image_aspect);
    if (!placed) return placed;
    placed->of_file = index;
    placed->description = "camera " + std::to_string(index) + " '" + source.name + "' of the file";
    return placed;
}

std::optional<CameraModel> wanted_model(const CameraRequest& request) {
    return request.model ? request.model : implied_model(request.settings);
}

/// The vertical angle of a flat image; those of a fisheye or cylinder do not apply.
double flat_yfov(const CameraRequest& request) {
    const double angle = request.yfov_rad.value_or(default_yfov_rad);
    return angle < pi_d ? angle : default_yfov_rad;
}

const Bounds& framed_bounds(const Scene& scene, const CameraRequest& request) {
    return request.framed ? *request.framed : scene.bounds;
}

/// The viewpoint of the options over the framing's. Where no up is given, a view straight up or
/// down takes the world's -Z as up.
Viewpoint viewpoint_by_hand(const CameraRequest& request, const Viewpoint& framed) {
    Viewpoint view;
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

Result<Placed> place_outside(const FramedScene& framed,
                             const CameraRequest& request,
                             double aspect) {
    const Framing framing = automatic_framing(framed, request, aspect);
    const bool by_hand = request.eye_m || request.target_m || request.up;
    const Viewpoint view = by_hand ? viewpoint_by_hand(request, framing.view) : framing.view;
    const Result<Affined> world_from_camera = look_at(view);
    if (!world_from_camera) return fail(world_from_camera.error());

    const double distance = length(view.eye_m - view.target_m);
    Placed placed;
    placed.world_from_camera = *world_from_camera;
    placed.model = wanted_model(request).value_or(CameraModel::pinhole);
    placed.tan_half_yfov = by_hand ? std::tan(0.5 * flat_yfov(request)) : framing.tan_half_yfov;
    placed.target_m = distance;
    placed.half_height_m = by_hand ? distance * placed.tan_half_yfov : framing.half_height_m;
    placed.description = by_hand                        ? "placed by eye, target and up"
                         : request.inside               ? "placed inside the scene's box"
                         : request.framed_nodes.empty() ? "automatic framing of the whole scene"
                                                        : "automatic framing of a part";
    return placed;
}

/// Applies the model and the angle to a camera of a file.
void override_lens(Placed& placed, const CameraRequest& request, const BoundingSphere& sphere) {
    const CameraModel in_file = implied_model(placed.settings).value_or(placed.model);
    const CameraModel wanted = wanted_model(request).value_or(in_file);
    const double distance = distance_to_centre(placed.world_from_camera, sphere);
    if (request.yfov_rad) {
        placed.tan_half_yfov = std::tan(0.5 * flat_yfov(request));
        placed.half_height_m = distance * placed.tan_half_yfov;
    } else if (wanted != placed.model) {
        if (placed.model == CameraModel::orthographic) {
            placed.tan_half_yfov = placed.half_height_m / distance;
        } else {
            placed.half_height_m = distance * placed.tan_half_yfov;
        }
    }
    placed.model = wanted;
}

/// Near and far planes around the whole scene where the camera names none.
void choose_planes(const Placed& placed, const BoundingSphere& sphere, ChosenCamera& out) {
    const double middle = distance_to_centre(placed.world_from_camera, sphere);
    const double far_side = middle + 2 * sphere.radius_m;
    const double clipped_near = static_cast<double>(out.camera.near_m);
    const double clipped_far = static_cast<double>(out.camera.far_m);
    out.zfar_m = clipped_far > 0 ? clipped_far : placed.zfar_m > 0 ? placed.zfar_m : far_side;
    out.znear_m = clipped_near > 0     ? clipped_near
                  : placed.znear_m > 0 ? placed.znear_m
                                       : std::max(middle - 2 * sphere.radius_m, 1e-4 * far_side);
    if (!(out.zfar_m > out.znear_m)) out.zfar_m = 1e4 * out.znear_m;
}

bool film_fits_float(const Camera& camera) {
    const auto positive = [](auto... numbers) {
        return ((numbers > 0 && std::isfinite(numbers)) && ...);
    };
    const OrthographicCamera& parallel = camera.orthographic;
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            return positive(camera.pinhole.tan_half_yfov, camera.pinhole.aspect);
        case CameraModel::orthographic:
            return positive(parallel.half_width_m, parallel.half_height_m, parallel.pixel_width_m);
        case CameraModel::fisheye:
            return positive(camera.fisheye.half_width, camera.fisheye.half_height);
        case CameraModel::environment:
            break;
    }
    return true;
}

bool fits_float(const Camera& camera) {
    const auto& m = camera.world_from_camera.m;
    return film_fits_float(camera) && std::isfinite(m[0][3]) && std::isfinite(m[1][3]) &&
           std::isfinite(m[2][3]);
}

/// The requested settings override those of the file; an angle counts where the model has an angle.
CameraSettings join_settings(const Placed& placed, const CameraRequest& request) {
    CameraSettings joined = merge_settings(placed.settings, request.settings);
    joined.model = placed.model;
    if (!request.yfov_rad) return joined;
    joined.fisheye_fov_rad = request.yfov_rad;
    joined.cylinder_fov_rad = request.yfov_rad;
    const bool flat = placed.model != CameraModel::fisheye;
    if (flat && !request.settings.intrinsics) joined.intrinsics.reset();
    return joined;
}

/// Asks each source in turn; the first that applies decides.
Result<Placed> place(const FramedScene& framed, const CameraRequest& request, double aspect) {
    const Scene& scene = framed.scene;
    const BoundingSphere sphere = bounding_sphere(framed_bounds(scene, request));
    const bool by_hand = request.eye_m || request.target_m || request.up;
    Result<Placed> placed = Placed{};
    if (request.loaded) {
        placed = place_as_given(*request.loaded, request.loaded->name, aspect);
        if (placed) placed->description = "camera of " + request.loaded->name;
    } else if (!by_hand && !request.frames &&
               (request.index || !request.choice.empty() || !scene.cameras.empty())) {
        const Result<size_t> index = request.index ? Result<size_t>(*request.index)
                                     : request.choice.empty()
                                         ? Result<size_t>(0)
                                         : find_camera(scene.cameras, request.choice);
        if (!index) return fail(index.error());
        placed = place_from_file(scene, *index, aspect);
    } else {
        return place_outside(framed, request, aspect);
    }
    if (placed) override_lens(*placed, request, sphere);
    return placed;
}

/// Makes the camera record from all that is known about the camera.
Result<void> build(CameraModel model, const std::string& file, ChosenCamera& out) {
    const Result<Camera> camera = make_camera(out.basis, model, out.settings, out.size);
    if (!camera) return fail(camera.error());
    out.camera = *camera;
    if (out.aperture) out.camera.thin_lens.aperture.image = out.aperture->view();
    if (fits_float(out.camera)) return {};
    return fail(ExitCode::bad_data,
                "E-CAM-RANGE",
                file,
                "the camera's position or size is zero or beyond what 32-bit floats hold");
}

/// Gives the camera the image of its opening, which `out` then owns.
Result<void> add_aperture(ChosenCamera& out, Log& log) {
    if (!out.settings.aperture_file || out.camera.model != CameraModel::thin_lens) return {};
    Result<ApertureTable> table = read_aperture(*out.settings.aperture_file, log);
    if (!table) return fail(table.error());
    out.aperture = std::make_shared<const ApertureTable>(std::move(*table));
    out.camera.thin_lens.aperture.image = out.aperture->view();
    return {};
}

/// Whether two poses of one camera of a file show what stands still at the same pixels.
bool shows_the_same(const SceneCamera& a, const SceneCamera& b) {
    const auto lens = [](const SceneCamera& camera) {
        return std::tuple(camera.yfov_rad, camera.aspect, camera.xmag_m, camera.ymag_m);
    };
    const auto& p = a.world_from_camera.m;
    const auto& q = b.world_from_camera.m;
    return std::equal(&p[0][0], &p[0][0] + 12, &q[0][0]) && lens(a) == lens(b) &&
           settings_texts(a.settings) == settings_texts(b.settings);
}

}  // namespace

Framing automatic_framing(const FramedScene& framed, const CameraRequest& request, double aspect) {
    const Scene& scene = framed.scene;
    if (request.kept) return *request.kept;
    FrameLens lens{flat_yfov(request), aspect};
    if (request.inside)
        return view_inside(framed_bounds(scene, request), sample_inside(*request.inside), lens);
    lens.orthographic = wanted_model(request) == CameraModel::orthographic && !request.yfov_rad;
    KeptGeometry of_this_view;
    KeptGeometry& kept = framed.kept != nullptr ? *framed.kept : of_this_view;
    const FramedGeometry& geometry = kept.of(scene, request.framed_nodes);
    const FramedGeometry box(framed_bounds(scene, request));  // where there is nothing but a size
    return frame_view(geometry.empty() ? box : geometry, request.framing, lens);
}

Result<ChosenCamera> choose_camera(const FramedScene& framed,
                                   const CameraRequest& request,
                                   int width_px,
                                   int height_px,
                                   Log& log) {
    const Scene& scene = framed.scene;
    const double aspect = static_cast<double>(width_px) / height_px;
    const BoundingSphere sphere = bounding_sphere(framed_bounds(scene, request));
    const Result<Placed> placed = place(framed, request, aspect);
    if (!placed) return fail(placed.error());
    if (const Result<void> fits = check_model_has(request.settings, placed->model); !fits) {
        return fail(fits.error());
    }

    ChosenCamera out;
    out.settings = join_settings(*placed, request);
    if (placed->settings.intrinsics && out.settings.intrinsics) {
        const Result<void> fits = check_beside_intrinsics(request.settings, out.settings);
        if (!fits) return fail(fits.error());
    }
    out.size = {width_px, height_px};
    CameraBasis& basis = out.basis;
    basis.world_from_camera = placed->world_from_camera;
    basis.tan_half_yfov = placed->tan_half_yfov;
    basis.half_height_m = placed->half_height_m;
    basis.focus_m =
        placed->target_m.value_or(distance_to_centre(placed->world_from_camera, sphere));
    basis.keeps_angle = request.yfov_rad.has_value();
    if (const Result<void> built = build(placed->model, scene.info.file_name, out); !built) {
        return fail(built.error());
    }
    for (const Affined& placing : placed->moving)
        out.moving.push_back(camera_place(placing, placed->model, out.settings));
    const Result<std::optional<double>> ev100 = chosen_exposure(out.settings);
    if (!ev100) return fail(ev100.error());
    out.ev100 = *ev100;
    if (const Result<void> added = add_aperture(out, log); !added) return fail(added.error());
    choose_planes(*placed, sphere, out);
    out.of_file = placed->of_file;
    out.description = placed->description;
    log.detail("camera: " + out.description);
    return out;
}

Result<std::vector<Camera>> choose_frame_cameras(const Scene& scene,
                                                 const CameraRequest& request,
                                                 const ChosenCamera& chosen) {
    std::vector<Camera> out;
    if (!chosen.of_file || scene.frame_motion == nullptr) return out;
    const auto& frames = scene.frame_motion->cameras;
    const auto at = [&](size_t s) -> const SceneCamera& { return frames[s][*chosen.of_file]; };
    if (shows_the_same(at(0), at(1)) && shows_the_same(at(1), at(2))) return out;
    Log quiet(Verbosity::quiet);
    for (const std::vector<SceneCamera>& cameras : frames) {
        CameraRequest posed = request;
        posed.loaded = cameras[*chosen.of_file];
        const Result<ChosenCamera> camera =
            choose_camera(scene, posed, chosen.size.width_px, chosen.size.height_px, quiet);
        if (!camera) return fail(camera.error());
        out.push_back(camera->camera);
        out.back().thin_lens.aperture.image = {};  // its table goes with `camera`
    }
    return out;
}

Result<void> refocus(ChosenCamera& chosen, double distance_m, const std::string& file) {
    chosen.settings.focus_distance_m = distance_m;
    return build(chosen.camera.model, file, chosen);
}

}  // namespace obscura
