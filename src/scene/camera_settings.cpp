// scene/camera_settings.cpp - joins and names what is said of a camera.
// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_settings.h"

#include "camera/names.h"

#include <charconv>

namespace obscura {

namespace {

constexpr double degrees_per_radian = 180.0 / pi_d;

template <typename T>
void take(std::optional<T>& base, const std::optional<T>& over) {
    if (over) base = over;
}

std::string text_of(double number) {
    char buffer[32];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::general, 9).ptr;
    return {buffer, end};
}

template <size_t N>
std::string text_of(const std::array<double, N>& numbers, double scale = 1) {
    std::string text;
    for (const double number : numbers)
        text += (text.empty() ? "" : ",") + text_of(number * scale);
    return text;
}

/// Collects names and values.
struct Texts {
    std::vector<std::pair<std::string, std::string>> list;

    void number(const char* name, const std::optional<double>& value, double scale = 1) {
        if (value) list.emplace_back(name, text_of(*value * scale));
    }
    template <size_t N>
    void numbers(const char* name,
                 const std::optional<std::array<double, N>>& value,
                 double scale = 1) {
        if (value) list.emplace_back(name, text_of(*value, scale));
    }
    template <typename T, size_t N>
    void choice(const char* name,
                const std::optional<T>& value,
                const std::array<Named<T>, N>& names) {
        if (value) list.emplace_back(name, name_of(names, *value));
    }
};

void add_intrinsics(const Intrinsics& i, Texts& texts) {
    texts.list.emplace_back("fx_px", text_of(i.fx_px));
    texts.list.emplace_back("fy_px", text_of(i.fy_px));
    texts.list.emplace_back("cx_px", text_of(i.cx_px));
    texts.list.emplace_back("cy_px", text_of(i.cy_px));
    texts.list.emplace_back("for_size", text_of(i.width_px) + "x" + text_of(i.height_px));
}

}  // namespace

CameraSettings merge_settings(const CameraSettings& base, const CameraSettings& over) {
    CameraSettings out = base;
    if (over.fstop || over.lens_radius_m) {
        out.fstop = over.fstop;
        out.lens_radius_m = over.lens_radius_m;
    }
    if (over.ev100 || over.shutter_s || over.iso) out.ev100 = over.ev100;
    take(out.model, over.model);
    take(out.near_m, over.near_m);
    take(out.far_m, over.far_m);
    take(out.magnification_m, over.magnification_m);
    take(out.focal_length_m, over.focal_length_m);
    take(out.sensor_m, over.sensor_m);
    take(out.shift, over.shift);
    take(out.distortion, over.distortion);
    take(out.intrinsics, over.intrinsics);
    take(out.focus_distance_m, over.focus_distance_m);
    take(out.blades, over.blades);
    take(out.blade_rotation_rad, over.blade_rotation_rad);
    take(out.anamorphic, over.anamorphic);
    take(out.aperture_file, over.aperture_file);
    take(out.fisheye, over.fisheye);
    take(out.fisheye_fov_rad, over.fisheye_fov_rad);
    take(out.fisheye_fit, over.fisheye_fit);
    take(out.fisheye_k, over.fisheye_k);
    take(out.environment, over.environment);
    take(out.cylinder_fov_rad, over.cylinder_fov_rad);
    take(out.stereo_m, over.stereo_m);
    take(out.align, over.align);
    take(out.shutter_s, over.shutter_s);
    take(out.iso, over.iso);
    return out;
}

std::optional<CameraModel> implied_model(const CameraSettings& s) {
    if (s.model) return s.model;
    if (s.fisheye || s.fisheye_k || s.fisheye_fit || s.fisheye_fov_rad) return CameraModel::fisheye;
    if (s.environment || s.stereo_m || s.align) return CameraModel::environment;
    // An f-number beside a shutter may mean the exposure only.
    const bool exposure_only = s.fstop && (s.shutter_s || s.iso) && !s.focus_distance_m;
    const bool lens = s.lens_radius_m || s.focus_distance_m || s.blades || s.aperture_file ||
                      (s.fstop && !exposure_only);
    if (lens) return CameraModel::thin_lens;
    if (s.magnification_m) return CameraModel::orthographic;
    return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> settings_texts(const CameraSettings& s) {
    Texts texts;
    texts.number("near_m", s.near_m);
    texts.number("far_m", s.far_m);
    texts.numbers("mag_m", s.magnification_m);
    texts.number("focal_length_mm", s.focal_length_m, 1000);
    texts.numbers("sensor_mm", s.sensor_m, 1000);
    texts.numbers("shift", s.shift);
    texts.numbers("distortion", s.distortion);
    if (s.intrinsics) add_intrinsics(*s.intrinsics, texts);
    texts.number("fstop", s.fstop);
    texts.number("lens_radius_m", s.lens_radius_m);
    texts.number("focus_distance_m", s.focus_distance_m);
    if (s.blades) texts.list.emplace_back("blades", std::to_string(*s.blades));
    texts.number("blade_rotation_deg", s.blade_rotation_rad, degrees_per_radian);
    texts.number("anamorphic", s.anamorphic);
    texts.choice("fisheye", s.fisheye, fisheye_law_names);
    texts.number("fisheye_fov_deg", s.fisheye_fov_rad, degrees_per_radian);
    if (s.fisheye_fit) {
        texts.list.emplace_back("fisheye_fit",
                                *s.fisheye_fit == FisheyeFit::circle ? "circle" : "diagonal");
    }
    texts.numbers("fisheye_k", s.fisheye_k);
    texts.choice("environment", s.environment, environment_projection_names);
    texts.number("cylinder_fov_deg", s.cylinder_fov_rad, degrees_per_radian);
    texts.number("stereo_m", s.stereo_m);
    if (s.align) {
        texts.list.emplace_back("align", *s.align == EnvironmentAlign::world ? "world" : "view");
    }
    texts.number("shutter_s", s.shutter_s);
    texts.number("iso", s.iso);
    texts.number("ev100", s.ev100);
    return texts.list;
}

}  // namespace obscura
