// session/lighting.cpp - reads the environment map of the command line.
// SPDX-License-Identifier: Apache-2.0
#include "session/lighting.h"

#include "image/decode.h"

namespace obscura {

Result<LightingOptions> load_lighting(const RenderRequest& request, Log& log) {
    LightingOptions lighting;
    lighting.environment_intensity = request.environment_intensity;
    lighting.environment_rotation_deg = request.environment_rotation_deg;
    if (request.environment) {
        Result<ImageRgb32f> environment = read_environment(*request.environment, log);
        if (!environment) return fail(environment.error());
        lighting.environment = std::move(*environment);
    }
    return lighting;
}

}  // namespace obscura
