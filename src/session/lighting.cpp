// session/lighting.cpp - reads or makes the environment that is asked for.
// SPDX-License-Identifier: Apache-2.0
#include "session/lighting.h"

#include "image/decode.h"
#include "session/built_in_environment.h"

#include <cmath>

namespace obscura {

Result<LightingOptions> load_lighting(const RenderRequest& request, Log& log) {
    LightingOptions lighting;
    lighting.environment_intensity = request.environment_intensity;
    lighting.environment_rotation_deg = request.environment_rotation_deg;
    lighting.catcher_ground = request.catcher_ground;
    if (request.environment) {
        const Result<std::optional<BuiltInEnvironment>> built_in =
            parse_built_in_environment(request.environment->string());
        if (!built_in) return fail(built_in.error());
        Result<ImageRgb32f> environment = *built_in ? make_built_in_environment(**built_in)
                                                    : read_environment(*request.environment, log);
        if (!environment) return fail(environment.error());
        if (request.space.from_rec709)
            convert_colors(*request.space.from_rec709, environment->pixels);
        lighting.environment = std::move(*environment);
        lighting.environment_name = request.environment->string();
    }
    return lighting;
}

double camera_azimuth_deg(const Affined& world_from_camera) {
    const auto& m = world_from_camera.m;
    constexpr double least = 1e-6;  // of the view axis that is horizontal
    const bool is_level = std::hypot(m[0][2], m[2][2]) > least;
    const double azimuth_rad =
        is_level ? std::atan2(m[0][2], m[2][2]) : std::atan2(-m[2][0], m[0][0]);
    return azimuth_rad * 180 / pi_d;
}

}  // namespace obscura
