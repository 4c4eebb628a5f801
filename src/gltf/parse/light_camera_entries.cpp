// gltf/parse/light_camera_entries.cpp - tables and checks of the numbers of lights and cameras.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/light_camera_entries.h"

#include "math/warp.h"

#include <cmath>

namespace obscura::gltf {

namespace {

constexpr NumberLimits factor = {0, 1e9};
constexpr NumberLimits power = {0, brightest};
constexpr double narrowest_rad = 1e-4;

constexpr NumberEntry<GltfLight> lights[] = {
    {"spot/outerConeAngle", numbers_of<&GltfLight::outer_cone_rad>, {narrowest_rad, pi_d / 2}},
    {"spot/innerConeAngle", numbers_of<&GltfLight::inner_cone_rad>, {0, pi_d / 2}},
    {"color", numbers_of<&GltfLight::color>, power},
    {"intensity", numbers_of<&GltfLight::intensity>, power},
    {"range", numbers_of<&GltfLight::range>},
};

constexpr NumberEntry<GltfProfileUse> profiles[] = {
    {"multiplier", numbers_of<&GltfProfileUse::multiplier>, factor},
    {"color", numbers_of<&GltfProfileUse::color>, {0, 1}},
};

constexpr NumberEntry<GltfEnvironment> environments[] = {
    {"intensity", numbers_of<&GltfEnvironment::intensity>, factor},
};

constexpr NumberEntry<GltfCamera> perspective[] = {
    {"perspective/yfov", numbers_of<&GltfCamera::yfov_rad>},
    {"perspective/aspectRatio", numbers_of<&GltfCamera::aspect>},
    {"perspective/znear", numbers_of<&GltfCamera::znear_m>},
    {"perspective/zfar", numbers_of<&GltfCamera::zfar_m>},
};

constexpr NumberEntry<GltfCamera> orthographic[] = {
    {"orthographic/xmag", numbers_of<&GltfCamera::xmag_m>},
    {"orthographic/ymag", numbers_of<&GltfCamera::ymag_m>},
    {"orthographic/znear", numbers_of<&GltfCamera::znear_m>},
    {"orthographic/zfar", numbers_of<&GltfCamera::zfar_m>},
};

std::optional<NumberFault> finish_perspective(const GltfCamera& camera, const CameraGiven& given) {
    if (!(camera.yfov_rad > 0 && camera.yfov_rad < pi_d)) {
        return NumberFault{"yfov", "E-CAM-FOV", "the vertical angle must lie between 0 and pi"};
    }
    if (given.aspect && !(camera.aspect > 0)) {
        return NumberFault{"aspectRatio", "E-CAM-ASPECT", "the aspect ratio must be above 0"};
    }
    if (!(camera.znear_m > 0)) {
        return NumberFault{"znear", "E-CAM-CLIP", "znear must be above 0"};
    }
    if (given.zfar && !(camera.zfar_m > camera.znear_m)) {
        return NumberFault{"zfar", "E-CAM-CLIP", "zfar must be larger than znear"};
    }
    return std::nullopt;
}

std::optional<NumberFault> finish_orthographic(GltfCamera& camera) {
    constexpr const char* no_size = "the magnification must not be 0";
    if (camera.xmag_m == 0) return NumberFault{"xmag", "E-CAM-MAG", no_size};
    if (camera.ymag_m == 0) return NumberFault{"ymag", "E-CAM-MAG", no_size};
    camera.xmag_m = std::abs(camera.xmag_m);
    camera.ymag_m = std::abs(camera.ymag_m);
    if (!(camera.znear_m >= 0)) {
        return NumberFault{"znear", "E-CAM-CLIP", "znear must be 0 or more"};
    }
    if (!(camera.zfar_m > camera.znear_m)) {
        return NumberFault{"zfar", "E-CAM-CLIP", "zfar must be larger than znear"};
    }
    return std::nullopt;
}

}  // namespace

const std::span<const NumberEntry<GltfLight>> light_entries = lights;
const std::span<const NumberEntry<GltfProfileUse>> profile_entries = profiles;
const std::span<const NumberEntry<GltfEnvironment>> environment_entries = environments;
const std::span<const NumberEntry<GltfCamera>> perspective_entries = perspective;
const std::span<const NumberEntry<GltfCamera>> orthographic_entries = orthographic;

bool finish_range(GltfLight& light) {
    constexpr double largest = 1e30;
    const bool good = light.range > 0 && light.range <= largest;
    if (!good) light.range = 0;
    return good;
}

std::optional<NumberFault> finish_camera(GltfCamera& camera, const CameraGiven& given) {
    return camera.orthographic ? finish_orthographic(camera) : finish_perspective(camera, given);
}

}  // namespace obscura::gltf
