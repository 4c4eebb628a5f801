// render/raycast_lights.h - draws every light with an extent together into what raycast can use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/raycast_light.h"
#include "render/prepared_scene.h"

#include <optional>
#include <vector>

namespace obscura {

/// Owns what RaycastView points to.
struct RaycastLights {
    std::vector<CentreLight> centres;
    std::optional<AmbientLight> ambient;
    bool headlight = false;

    RaycastView view() const;
};

/// One point for every placing of an emissive primitive; the environment as irradiance by normal;
/// a headlight when there is neither of these nor a punctual light.
RaycastLights make_raycast_lights(const PreparedScene::Impl& scene);

/// The integral over all directions, pixel by pixel, onto the nine terms of AmbientLight.
AmbientLight project_environment(const EnvironmentView& environment);

}  // namespace obscura
