// gltf/camera_extension.cpp - reads the extension OBSCURA_camera of a glTF camera.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/camera_extension.h"

#include "camera/names.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr const char* value_id = "E-CAM-VALUE";
constexpr double largest = 1e12;

constexpr std::array<Named<FisheyeFit>, 2> fits = {
    {{"circle", FisheyeFit::circle}, {"diagonal", FisheyeFit::diagonal}}};
constexpr std::array<Named<EnvironmentAlign>, 2> aligns = {
    {{"world", EnvironmentAlign::world}, {"view", EnvironmentAlign::view}}};

void refuse_other_keys(const JsonReader& object, const std::vector<std::string>& known) {
    object.each_key([&](const std::string& key) {
        const bool expected = std::find(known.begin(), known.end(), key) != known.end();
        if (expected || key == "extras" || key == "extensions") return;
        std::string names;
        for (const std::string& name : known)
            names += (names.empty() ? "" : ", ") + name;
        object.fault(key, "E-CAM-KEY", "there is no such key here; expected one of: " + names);
    });
}

struct Range {
    double low, high;
};

std::string text_of(const Range& range) {
    return "from " + nlohmann::json(range.low).dump() + " to " + nlohmann::json(range.high).dump();
}

void read_number(const JsonReader& object,
                 const char* key,
                 const Range& range,
                 std::optional<double>& out) {
    if (!object.has(key)) return;
    const double value = object.number(key, range.low);
    if (!(value >= range.low && value <= range.high)) {
        object.fault(key, value_id, "expected a number " + text_of(range));
    }
    out = value;
}

template <size_t N>
void read_numbers(const JsonReader& object,
                  const char* key,
                  const Range& range,
                  std::optional<std::array<double, N>>& out) {
    std::array<double, N> values = {};
    if (!object.numbers(key, values)) return;
    for (const double value : values) {
        if (!(value >= range.low && value <= range.high)) {
            object.fault(key, value_id, "expected numbers " + text_of(range));
        }
    }
    out = values;
}

template <typename T, size_t N>
void read_choice(const JsonReader& object,
                 const char* key,
                 const std::array<Named<T>, N>& names,
                 std::optional<T>& out) {
    if (!object.has(key)) return;
    const std::string text = object.text(key);
    std::string accepted;
    for (const Named<T>& entry : names) {
        if (text == entry.name) out = entry.value;
        accepted += (accepted.empty() ? "" : ", ") + std::string(entry.name);
    }
    if (!out) object.fault(key, value_id, "expected one of: " + accepted);
}

void read_lens(const JsonReader& lens, CameraSettings& out) {
    refuse_other_keys(
        lens, {"fstop", "radius", "focusDistance", "blades", "bladeRotation", "anamorphic"});
    read_number(lens, "fstop", {0.01, 1e6}, out.fstop);
    read_number(lens, "radius", {0, 1e9}, out.lens_radius_m);
    read_number(lens, "focusDistance", {1e-9, largest}, out.focus_distance_m);
    read_number(lens, "bladeRotation", {-1000, 1000}, out.blade_rotation_rad);
    read_number(lens, "anamorphic", {0.01, 100}, out.anamorphic);
    if (lens.has("blades")) {
        const uint64_t blades = lens.size("blades", 3);
        if (blades < 3 || blades > 64) lens.fault("blades", value_id, "expected 3 to 64");
        out.blades = static_cast<int>(blades);
    }
    if (out.fstop && out.lens_radius_m) {
        lens.fault("radius", value_id, "expected either this or fstop");
    }
}

void read_fisheye(const JsonReader& fisheye, CameraSettings& out) {
    refuse_other_keys(fisheye, {"projection", "fov", "fit", "coefficients"});
    read_choice(fisheye, "projection", fisheye_law_names, out.fisheye);
    read_number(fisheye, "fov", {1e-4, 2 * pi_d}, out.fisheye_fov_rad);
    read_choice(fisheye, "fit", fits, out.fisheye_fit);
    read_numbers(fisheye, "coefficients", {-1e6, 1e6}, out.fisheye_k);
    if (out.fisheye_k && out.fisheye.value_or(FisheyeLaw::opencv) != FisheyeLaw::opencv) {
        fisheye.fault("coefficients", value_id, "they are for the projection opencv only");
    }
}

void read_environment(const JsonReader& around, CameraSettings& out) {
    refuse_other_keys(around, {"projection", "fov", "stereo", "align"});
    read_choice(around, "projection", environment_projection_names, out.environment);
    read_number(around, "fov", {1e-4, 3.1241}, out.cylinder_fov_rad);
    read_number(around, "stereo", {0, 1e6}, out.stereo_m);
    read_choice(around, "align", aligns, out.align);
}

void read_exposure(const JsonReader& exposure, CameraSettings& out) {
    refuse_other_keys(exposure, {"shutter", "iso", "ev100"});
    read_number(exposure, "shutter", {1e-7, 1e7}, out.shutter_s);
    read_number(exposure, "iso", {1e-3, 1e9}, out.iso);
    read_number(exposure, "ev100", {-60, 60}, out.ev100);
    if (out.ev100 && (out.shutter_s || out.iso)) {
        exposure.fault("ev100", value_id, "expected either this or shutter and iso");
    }
}

}  // namespace

CameraSettings read_camera_extension(const JsonReader& object) {
    refuse_other_keys(object,
                      {"model",
                       "near",
                       "far",
                       "focalLength",
                       "sensor",
                       "shift",
                       "distortion",
                       "lens",
                       "fisheye",
                       "environment",
                       "exposure"});
    CameraSettings out;
    read_choice(object, "model", camera_model_names, out.model);
    read_number(object, "near", {0, largest}, out.near_m);
    read_number(object, "far", {1e-9, largest}, out.far_m);
    read_number(object, "focalLength", {1e-5, 100}, out.focal_length_m);
    read_numbers(object, "sensor", {1e-4, 10}, out.sensor_m);
    read_numbers(object, "shift", {-100, 100}, out.shift);
    read_numbers(object, "distortion", {-1e6, 1e6}, out.distortion);
    if (object.has("lens")) read_lens(object.child("lens"), out);
    if (object.has("fisheye")) read_fisheye(object.child("fisheye"), out);
    if (object.has("environment")) read_environment(object.child("environment"), out);
    if (object.has("exposure")) read_exposure(object.child("exposure"), out);
    if (out.far_m && !(*out.far_m > out.near_m.value_or(0))) {
        object.fault("far", value_id, "expected more than near");
    }
    out.model = implied_model(out);
    if (out.model == CameraModel::thin_lens && !out.fstop && !out.lens_radius_m) {
        object.fault("lens", value_id, "a thin lens needs fstop or radius");
    }
    return out;
}

}  // namespace obscura
