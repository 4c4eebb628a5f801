// base/setting_names.cpp - spells the names of settings in messages, for whom they are meant.
// SPDX-License-Identifier: Apache-2.0
#include "base/setting_names.h"

#include <algorithm>
#include <array>
#include <utility>

namespace obscura {

namespace {

/// Marks a name: the unit separator, which occurs in no sentence.
constexpr char mark = '\x1f';

/// Settings whose fields in the library have other names than options.
constexpr std::array<std::pair<std::string_view, std::string_view>, 27> other_fields = {
    {{"ao-distance", "ao_distance_m"},
     {"blade-rotation", "blade_rotation_deg"},
     {"env", "environment"},
     {"environment", "projection"},
     {"environment-rotation", "environment_rotation_deg"},
     {"exposure", "exposure_ev"},
     {"exposure-time", "exposure_s"},
     {"far", "far_m"},
     {"float", "float32"},
     {"focal-length", "focal_length_m"},
     {"focus-distance", "focus_distance_m"},
     {"focus-on", "focus_on_px"},
     {"fov", "fov_deg"},
     {"lens-radius", "lens_radius_m"},
     {"line-width", "line_width_px"},
     {"mag", "magnification_m"},
     {"near", "near_m"},
     {"ocio", "ocio_config"},
     {"occlusion", "ambient_occlusion"},
     {"point-size", "point_size_px"},
     {"sensor", "sensor_m"},
     {"shutter", "shutter_s"},
     {"size", "width"},
     {"spp", "samples_per_pixel"},
     {"stereo", "stereo_m"},
     {"time", "time_s"},
     {"wire-width", "wire_width_px"}}};

std::string spelled(std::string name, SettingNames names) {
    if (names == SettingNames::fields) {
        for (const auto& [setting, field] : other_fields) {
            if (setting == name) return std::string(field);
        }
    } else if (name == "exposure-time") {  // a field of its own in the library alone
        name = "shutter";
    }
    if (names == SettingNames::options) return "--" + name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

bool is_of_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

std::string setting(std::string_view name) {
    return std::string(1, mark).append(name);
}

std::string spell_settings(std::string_view text, SettingNames names) {
    std::string out;
    for (size_t i = 0; i < text.size();) {
        if (text[i] != mark) {
            out += text[i++];
            continue;
        }
        const size_t begin = ++i;
        while (i < text.size() && is_of_name(text[i]))
            ++i;
        out += spelled(std::string(text.substr(begin, i - begin)), names);
    }
    return out;
}

}  // namespace obscura
