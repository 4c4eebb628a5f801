// bench/standard_scenes.h - the scenes of `bench --standard`, made by the program.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include <array>
#include <string>

namespace obscura::bench {

/// Changes with whatever changes a scene, a view, a setting or the arithmetic of the score: scores
/// of different standards are never compared.
inline constexpr int standard_version = 1;

/// How the standard renders.
inline constexpr int standard_width = 640;
inline constexpr int standard_height = 360;
inline constexpr int standard_samples = 16;  ///< a pixel
inline constexpr int standard_depth = 8;

struct StandardScene {
    const char* name;
    const char* what;  ///< in a few words
    /// The relative error of one picture that samples a second are stated at.
    double noise;
    /// Mean of R, G and B over the picture, in nits: what differs by more than 1 % is another
    /// picture.
    double mean;
    Scene (*make)();
    LightingOptions (*light)();
    Vec3f eye, target;
    float yfov_deg;
};

/// Three scenes that stress different parts: geometry, materials and textures, lights.
const std::array<StandardScene, 3>& standard_scenes();

Camera camera_of(const StandardScene& scene, int width, int height);

}  // namespace obscura::bench
