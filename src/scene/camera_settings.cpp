// scene/camera_settings.cpp - merges camera settings and prints them.
// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_settings.h"

#include "scene/camera_setting_table.h"

#include <charconv>
#include <string_view>

namespace obscura {

namespace {

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

using Texts = std::vector<std::pair<std::string, std::string>>;

void add_intrinsics(const Intrinsics& i, Texts& texts) {
    texts.emplace_back("fx_px", text_of(i.fx_px));
    texts.emplace_back("fy_px", text_of(i.fy_px));
    texts.emplace_back("cx_px", text_of(i.cx_px));
    texts.emplace_back("cy_px", text_of(i.cy_px));
    texts.emplace_back("for_size", text_of(i.width_px) + "x" + text_of(i.height_px));
}

template <typename T>
void add_text(const CameraSetting<T>& entry, const T& value, Texts& texts) {
    if constexpr (std::is_same_v<T, Intrinsics>) {
        add_intrinsics(value, texts);
    } else if constexpr (std::is_enum_v<T>) {
        for (const Named<T>& choice : entry.choices)
            if (choice.value == value) texts.emplace_back(entry.info.report, choice.name);
    } else if constexpr (std::is_arithmetic_v<T>) {
        texts.emplace_back(entry.info.report, text_of(value * entry.info.shown));
    } else if constexpr (!std::is_same_v<T, std::string>) {
        texts.emplace_back(entry.info.report, text_of(value, entry.info.shown));
    }
}

}  // namespace

CameraSettings merge_settings(const CameraSettings& base, const CameraSettings& over) {
    CameraSettings out = base;
    if (over.model) out.model = over.model;
    if (over.fstop || over.lens_radius_m) {
        out.fstop.reset();
        out.lens_radius_m.reset();
    }
    if (over.shutter_s || over.iso) out.ev100.reset();
    for_each_camera_setting([&](const auto& entry) {
        if (over.*entry.member) out.*entry.member = over.*entry.member;
    });
    return out;
}

std::optional<CameraModel> implied_model(const CameraSettings& s) {
    if (s.model) return s.model;
    if (s.fisheye || s.fisheye_k || s.fisheye_fit || s.fisheye_fov_rad) return CameraModel::fisheye;
    if (s.environment || s.stereo_m || s.align) return CameraModel::environment;
    // An f-number given with a shutter or ISO may be meant for the exposure only.
    const bool exposure_only = s.fstop && (s.shutter_s || s.iso) && !s.focus_distance_m;
    const bool lens = s.lens_radius_m || s.focus_distance_m || s.blades || s.aperture_file ||
                      (s.fstop && !exposure_only);
    if (lens) return CameraModel::thin_lens;
    if (s.magnification_m) return CameraModel::orthographic;
    return std::nullopt;
}

const CameraSettingInfo* setting_without(const CameraSettings& settings, CameraModel model) {
    const CameraSettingInfo* found = nullptr;
    for_each_camera_setting([&](const auto& entry) {
        // Together with a shutter, an f-number is part of the exposure.
        const bool exposes = std::string_view(entry.info.name) == "fstop" && settings.shutter_s;
        const bool has_it = (entry.info.models & model_bit(model)) != 0 || exposes;
        if (settings.*entry.member && !has_it && !found) found = &entry.info;
    });
    return found;
}

std::vector<std::pair<std::string, std::string>> settings_texts(const CameraSettings& s) {
    Texts texts;
    for_each_camera_setting([&](const auto& entry) {
        if (s.*entry.member) add_text(entry, *(s.*entry.member), texts);
    });
    return texts;
}

}  // namespace obscura
