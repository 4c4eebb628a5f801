// render/raycast_lights.h - for raycast: area lights as points, the environment as irradiance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/raycast_light.h"
#include "render/prepared_scene.h"

#include <optional>
#include <vector>

namespace obscura {

/// Owns the arrays of RaycastView.
struct RaycastLights {
    std::vector<CentreLight> centres;
    std::optional<AmbientLight> ambient;
    bool headlight = false;

    RaycastView view() const;
};

/// One point light for every instance of an emissive primitive; the environment as irradiance by
/// normal; a headlight if there is neither of these nor a punctual light.
RaycastLights make_raycast_lights(const PreparedScene::Impl& scene);

/// Projects the environment onto the nine terms of AmbientLight, pixel by pixel.
AmbientLight project_environment(const EnvironmentView& environment);

}  // namespace obscura
