// session/lighting.cpp - reads or makes the environment that is asked for.
// SPDX-License-Identifier: Apache-2.0
#include "session/lighting.h"

#include "image/decode.h"
#include "session/built_in_environment.h"

namespace obscura {

Result<LightingOptions> load_lighting(const RenderRequest& request, Log& log) {
    LightingOptions lighting;
    lighting.environment_intensity = request.environment_intensity;
    lighting.environment_rotation_deg = request.environment_rotation_deg;
    if (request.environment) {
        const Result<std::optional<BuiltInEnvironment>> built_in =
            parse_built_in_environment(request.environment->string());
        if (!built_in) return fail(built_in.error());
        if (*built_in) {
            lighting.environment = make_built_in_environment(**built_in);
            return lighting;
        }
        Result<ImageRgb32f> environment = read_environment(*request.environment, log);
        if (!environment) return fail(environment.error());
        lighting.environment = std::move(*environment);
    }
    return lighting;
}

}  // namespace obscura
