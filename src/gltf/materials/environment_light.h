// gltf/materials/environment_light.h - an image-based light becomes the environment map.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/encoded_image.h"
#include "scene/scene.h"

#include <memory>

namespace obscura::gltf {

/// The map of an earlier pose, for poses whose light is the same.
struct EnvironmentStore {
    std::shared_ptr<const ImageRgb32f> map;  ///< null: not read yet, or there is none
    double intensity = 1;
    std::array<double, 4> rotation = {0, 0, 0, 1};
};

/// Fills Scene::environment and its name in Scene::info. The six faces of the finest level of
/// EXT_lights_image_based are resampled, rotated and scaled as the light says. The prefiltered
/// levels and the irradiance are ignored: a path tracer needs neither.
///
/// In      scene: in Document::scenes, -1: none; store: empty, or of an earlier pose
/// Errors  those of load_encoded and decode_image; 65 E-ENV-FACES, 77 E-ENV-LIMIT
Result<void> add_environment_light(
    const ImageSources& sources, int scene, EnvironmentStore& store, Scene& out, Log& log);

}  // namespace obscura::gltf
