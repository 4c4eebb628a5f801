// session/library_request.cpp - checks a library caller's request by the rules of options.
// SPDX-License-Identifier: Apache-2.0
#include "session/library_request.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "camera/names.h"
#include "gltf/camera_json.h"
#include "math/warp.h"
#include "scene/camera_setting_table.h"
#include "session/framing.h"
#include "session/model_settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace obscura {

namespace {

/// The library's enumerations have the same order as ours.
static_assert(static_cast<int>(v0::Integrator::heat) == static_cast<int>(Integrator::heat) &&
              static_cast<int>(v0::Integrator::depth) == static_cast<int>(Integrator::depth) &&
              static_cast<int>(v0::CameraModel::thin_lens) ==
                  static_cast<int>(CameraModel::thin_lens) &&
              static_cast<int>(v0::CameraModel::environment) ==
                  static_cast<int>(CameraModel::environment) &&
              static_cast<int>(v0::PixelFilter::blackman_harris) ==
                  static_cast<int>(PixelFilter::blackman_harris) &&
              static_cast<int>(v0::Background::color) == static_cast<int>(BackgroundKind::color) &&
              static_cast<int>(v0::ExrLayout::separate) == static_cast<int>(ExrLayout::separate));
constexpr std::array<Named<Isa>, 4> isa_names = {{{"auto", Isa::automatic},
                                                  {"baseline", Isa::baseline},
                                                  {"avx2", Isa::avx2},
                                                  {"avx512", Isa::avx512}}};

/// Keeps the first fault.
class Checks {
public:
    void real(const char* field, double value, double low, double high) {
        if (value >= low && value <= high) return;
        refuse("E-USAGE-RANGE",
               field,
               shortest(value) + " is out of range; expected from " + shortest(low) + " to " +
                   shortest(high));
    }
    void real(const char* field, const std::optional<double>& value, double low, double high) {
        if (value) real(field, *value, low, high);
    }
    template <typename List>
    void reals(const char* field, const List& values, double low, double high) {
        if (!values) return;
        for (const double value : *values)
            real(field, value, low, high);
    }
    template <typename Names, typename Target>
    void name(const char* field, const std::string& text, const Names& names, Target& target) {
        std::string list;
        for (const auto& known : names) {
            if (text == known.name) {
                target = known.value;
                return;
            }
            list += (list.empty() ? "" : ", ") + std::string(known.name);
        }
        refuse(
            "E-USAGE-CHOICE", field, in_quotes(text) + " is no choice; expected one of: " + list);
    }
    /// An enumeration whose last value is `last`: hosts may cast numbers to it.
    template <typename E>
    void choice(const char* field, E value, E last) {
        const auto number = static_cast<int>(value);
        if (number >= 0 && number <= static_cast<int>(last)) return;
        refuse("E-USAGE-CHOICE",
               field,
               std::to_string(number) + " is no choice; expected from 0 to " +
                   std::to_string(static_cast<int>(last)));
    }
    void conflict(bool condition, const char* field, const std::string& message) {
        if (condition) refuse("E-USAGE-CONFLICT", field, message);
    }
    /// Both are given, and only one may be.
    void excludes(bool condition, const char* field, const char* other) {
        conflict(condition,
                 field,
                 "it cannot go together with " + setting(other) + "; give one or the other");
    }
    void take(const Result<void>& check) {
        if (!check && !error_) error_ = check.error();
    }
    const std::optional<Error>& error() const { return error_; }

private:
    void refuse(const char* id, const char* field, const std::string& message) {
        if (!error_) error_ = Error{ExitCode::usage, id, setting(field), message};
    }
    std::optional<Error> error_;
};

std::optional<Vec3d> point_of(const std::optional<v0::Vector3>& point) {
    if (!point) return std::nullopt;
    return Vec3d{(*point)[0], (*point)[1], (*point)[2]};
}

void read_image(const v0::View& view, RenderOptions& out, Checks& checks) {
    checks.real("width", view.width, 1, 65536);
    checks.real("height", view.height, 1, 65536);
    checks.real("width", double{1} * view.width * view.height, 1, 1 << 29);
    out.width = view.width;
    out.height = view.height;
    if (!view.crop) return;
    checks.real("crop", view.crop->x, 0, 65536);
    checks.real("crop", view.crop->y, 0, 65536);
    checks.real("crop", view.crop->width, 1, 65536);
    checks.real("crop", view.crop->height, 1, 65536);
    out.crop = PixelRect{view.crop->x, view.crop->y, view.crop->width, view.crop->height};
}

/// Copies a setting, by the range of scene/camera_setting_table.h.
template <auto member, typename T>
void take(const std::optional<T>& value, CameraSettings& to, Checks& checks) {
    if (!value) return;
    constexpr CameraSettingInfo info = camera_setting_of<member>().info;
    if constexpr (std::is_arithmetic_v<T>) {
        checks.real(info.name, static_cast<double>(*value), info.range.low, info.range.high);
    } else {
        checks.reals(info.name, value, info.range.low, info.range.high);
    }
    to.*member = *value;
}

/// Copies a setting that is one of several names.
template <auto member>
void take(const std::string& value, CameraSettings& to, Checks& checks) {
    if (value.empty()) return;
    constexpr auto entry = camera_setting_of<member>();
    checks.name(entry.info.name, value, entry.choices, to.*member);
}

void read_lens(const v0::View& view, CameraSettings& s, Checks& checks) {
    using S = CameraSettings;
    take<&S::near_m>(view.near_m, s, checks);
    take<&S::far_m>(view.far_m, s, checks);
    take<&S::magnification_m>(view.magnification_m, s, checks);
    take<&S::focal_length_m>(view.focal_length_m, s, checks);
    take<&S::sensor_m>(view.sensor_m, s, checks);
    take<&S::shift>(view.shift, s, checks);
    take<&S::distortion>(view.distortion, s, checks);
    take<&S::fstop>(view.fstop, s, checks);
    take<&S::lens_radius_m>(view.lens_radius_m, s, checks);
    take<&S::focus_distance_m>(view.focus_distance_m, s, checks);
    take<&S::blades>(view.blades, s, checks);
    checks.real("blade-rotation", view.blade_rotation_deg, -36000, 36000);
    if (view.blade_rotation_deg)
        s.blade_rotation_rad = *view.blade_rotation_deg * radians_per_degree;
    take<&S::anamorphic>(view.anamorphic, s, checks);
    if (!view.aperture.empty()) s.aperture_file = view.aperture;
    take<&S::fisheye>(view.fisheye, s, checks);
    take<&S::fisheye_fit>(view.fisheye_fit, s, checks);
    take<&S::fisheye_k>(view.fisheye_coefficients, s, checks);
    if (!view.projection.empty()) {
        checks.name("projection", view.projection, environment_projection_names, s.environment);
    }
    take<&S::align>(view.align, s, checks);
    take<&S::stereo_m>(view.stereo_m, s, checks);
    take<&S::ev100>(view.ev100, s, checks);
    constexpr auto time_range = camera_setting_of<&S::shutter_s>().info.range;
    checks.real("exposure-time", view.exposure_s, time_range.low, time_range.high);
    if (view.exposure_s) s.shutter_s = view.exposure_s;
    take<&S::iso>(view.iso, s, checks);
    checks.excludes(view.fstop && view.lens_radius_m, "lens-radius", "fstop");
    checks.excludes(view.focus_on_px && view.focus_distance_m, "focus-on", "focus-distance");
    checks.excludes(view.blades && s.aperture_file, "aperture", "blades");
    // Only a lens can be focused.
    if (view.focus_on_px && !implied_model(s)) s.model = CameraModel::thin_lens;
}

/// A camera of the caller's own in place of the file's.
SceneCamera placed_camera(const std::array<double, 16>& m, const v0::View& view, Checks& checks) {
    SceneCamera camera;
    camera.name = "world_from_camera";
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 4; ++column)
            camera.world_from_camera.m[row][column] = m[4 * row + column];
    }
    const bool is_affine = m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
    checks.conflict(!is_affine || !gltf::is_rotation(camera.world_from_camera),
                    "world-from-camera",
                    "expected a rotation and a place: its last row is 0 0 0 1, and its 3x3 part "
                    "neither scales, shears nor mirrors");
    camera.yfov_rad = view.fov_deg ? *view.fov_deg * radians_per_degree : default_yfov_rad;
    return camera;
}

void read_camera(const v0::View& view, CameraRequest& out, Checks& checks) {
    for (const auto* point : {&view.eye, &view.target, &view.up})
        checks.reals("eye, target, up", *point, -1e18, 1e18);
    checks.reals("world-from-camera", view.world_from_camera, -1e18, 1e18);
    const bool by_hand = view.eye || view.target || view.up;
    checks.conflict(!view.camera.empty() && by_hand,
                    "camera",
                    "it cannot go together with " + setting("eye") + ", " + setting("target") +
                        " or " + setting("up") + "; give one or the other");
    for (const auto& [placing, given] : {std::pair{"world-from-camera", !!view.world_from_camera},
                                         std::pair{"camera-json", !view.camera_json.empty()},
                                         std::pair{"opencv", !!view.opencv}}) {
        checks.conflict(given && (by_hand || !view.camera.empty()),
                        placing,
                        "it places the camera; it cannot go together with " + setting("camera") +
                            ", " + setting("eye") + ", " + setting("target") + " or " +
                            setting("up"));
    }
    checks.excludes(
        view.world_from_camera && !view.camera_json.empty(), "camera-json", "world-from-camera");
    checks.excludes(view.opencv && view.world_from_camera, "opencv", "world-from-camera");
    checks.excludes(view.opencv && !view.camera_json.empty(), "opencv", "camera-json");
    out.choice = view.camera;
    out.eye_m = point_of(view.eye);
    out.target_m = point_of(view.target);
    out.up = point_of(view.up);
    if (view.camera_model)
        checks.choice("camera-model", *view.camera_model, v0::CameraModel::environment);
    if (view.camera_model) out.model = static_cast<CameraModel>(*view.camera_model);
    read_lens(view, out.settings, checks);
    checks.take(check_settings_agree(out.settings));
    checks.real("fov", view.fov_deg, 0.01, max_fov_deg(out.model, out.settings));
    if (view.fov_deg) out.yfov_rad = *view.fov_deg * radians_per_degree;
    if (view.world_from_camera) out.loaded = placed_camera(*view.world_from_camera, view, checks);
    if (view.focus_on_px) {
        checks.reals("focus-on", view.focus_on_px, 0, 65535);
        out.focus_on_px = view.focus_on_px;
    }
}

void read_look(const v0::Look& look, RenderRequest& out, Checks& checks) {
    checks.real("environment-intensity", look.environment_intensity, 0, 1e9);
    checks.real("environment-rotation", look.environment_rotation_deg, -36000, 36000);
    checks.real("point-size", look.point_size_px, 0.01, 1000);
    checks.real("line-width", look.line_width_px, 0.01, 1000);
    for (const float channel : look.background_color)
        checks.real("background-color", static_cast<double>(channel), 0, 1e9);
    checks.choice("background", look.background, v0::Background::color);
    if (!look.environment.empty()) out.environment = look.environment;
    out.environment_intensity = look.environment_intensity;
    out.environment_rotation_deg = look.environment_rotation_deg;
    out.points_lines.points = {look.point_size_px, LengthUnit::pixels};
    out.points_lines.lines = {look.line_width_px, LengthUnit::pixels};
    out.options.background = static_cast<BackgroundKind>(look.background);
    std::copy(
        look.background_color.begin(), look.background_color.end(), out.options.background_color);
}

void read_sampling(const v0::Sampling& sampling, RenderOptions& out, Checks& checks) {
    checks.real("samples-per-pixel", sampling.samples_per_pixel, 1, 1 << 20);
    checks.real("noise-target", sampling.noise_target, 1e-4, 1);
    checks.real("spp-min", sampling.spp_min, 2, 1 << 20);
    checks.conflict(
        sampling.spp_min && !sampling.noise_target,
        "spp-min",
        "it is the least of what " + setting("noise-target") + " takes; give that, too");
    checks.real("max-bounces", sampling.max_bounces, 0, 1000);
    checks.real("ao-distance", sampling.ao_distance_m, 1e-9, 1e12);
    checks.real("wire-width", sampling.wire_width_px, 0.01, 1000);
    checks.real("clamp-direct", sampling.clamp_direct, 0, 1e12);
    checks.real("clamp-indirect", sampling.clamp_indirect, 0, 1e12);
    checks.real("crypto-levels", sampling.crypto_levels, 1, 64);
    checks.choice("integrator", sampling.integrator, v0::Integrator::heat);
    checks.choice("filter", sampling.filter, v0::PixelFilter::blackman_harris);
    out.integrator = static_cast<Integrator>(sampling.integrator);
    out.samples_per_pixel = sampling.samples_per_pixel;
    if (sampling.noise_target) {
        const int usual = std::clamp(sampling.samples_per_pixel, 2, AdaptiveOptions{}.min_samples);
        out.adaptive = {*sampling.noise_target, sampling.spp_min.value_or(usual)};
    }
    out.max_bounces = sampling.max_bounces;
    out.seed = sampling.seed;
    out.filter = static_cast<PixelFilter>(sampling.filter);
    out.ao_distance_m = sampling.ao_distance_m.value_or(0);
    out.wire_width_px = sampling.wire_width_px;
    out.clamp_direct = sampling.clamp_direct;
    out.clamp_indirect = sampling.clamp_indirect;
    out.caustics = sampling.caustics;
    out.regularize = sampling.regularize;
}

}  // namespace

gltf::LoadOptions load_options_of(const v0::AssetOptions& options) {
    gltf::LoadOptions out;
    const char* const end = options.scene.data() + options.scene.size();
    const bool is_number = is_index(options.scene) &&
                           std::from_chars(options.scene.data(), end, out.scene).ec == std::errc();
    if (!is_number) out.scene_name = options.scene;
    out.variant = options.variant;
    out.animation = options.animation;
    out.occlusion = options.ambient_occlusion;
    out.lenient = options.lenient;
    if (options.fps) out.frame_step_s = 1 / *options.fps;
    return out;
}

Result<void> check_asset_options(const v0::AssetOptions& options) {
    Checks checks;
    checks.real("threads", options.threads, 0, 1024);
    checks.real("fps", options.fps, 0.001, 1e6);
    if (checks.error()) return fail(*checks.error());
    return {};
}

Result<RenderRequest> request_of(const v0::View& view,
                                 const v0::Look& look,
                                 const v0::Sampling& sampling,
                                 const v0::Control& control) {
    RenderRequest out;
    Checks checks;
    read_image(view, out.options, checks);
    read_camera(view, out.camera, checks);
    out.size_is_given = true;
    if (!view.camera_json.empty()) out.camera_json = view.camera_json;
    read_look(look, out, checks);
    read_sampling(sampling, out.options, checks);
    checks.real("threads", control.threads, 0, 1024);
    checks.real("tile-size", control.tile_size, 1, 256);
    checks.name("isa", control.isa, isa_names, out.isa);
    checks.real("time", view.time_s, -1e6, 1e6);
    checks.reals("shutter", view.shutter_s, -1e6, 1e6);
    checks.conflict(view.shutter_s && !((*view.shutter_s)[0] < (*view.shutter_s)[1]),
                    "shutter",
                    "it closes before it opens");
    if (view.shutter_s) {  // for the file's header: poses have it in seconds
        out.shutter =
            ShutterFractions{(*view.shutter_s)[0] * out.fps, (*view.shutter_s)[1] * out.fps};
    }
    out.threads = control.threads;
    out.options.tile_size = control.tile_size;
    if (checks.error()) return fail(*checks.error());
    if (const Result<void> fits = check_crop(out.options); !fits) return fail(fits.error());
    if (const Result<void> fits = check_adaptive(out.options); !fits) return fail(fits.error());
    out.crypto_levels = sampling.crypto_levels;
    if (auto chosen = choose_layers(sampling.aov, out); !chosen) return fail(chosen.error());
    return out;
}

Result<DisplayEncoding> encoding_of(const v0::WriteOptions& options) {
    DisplayEncoding out;
    Checks checks;
    checks.conflict(options.bits != 8 && options.bits != 16, "bits", "8 and 16 are accepted");
    checks.choice("exr-layout", options.exr_layout, v0::ExrLayout::separate);
    if (options.quality) checks.real("quality", *options.quality, 1, 100);
    checks.real("exposure", options.exposure_ev, -50, 50);
    for (const float code : options.page.value_or(std::array<float, 3>{}))
        checks.real("page", static_cast<double>(code), 0, 1);
    if (checks.error()) return fail(*checks.error());
    out.bits = options.bits;
    out.quality = options.quality;
    out.dither = options.dither;
    out.page = options.page;
    return out;
}

}  // namespace obscura
