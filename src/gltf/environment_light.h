// gltf/environment_light.h - an image-based light of the file becomes the scene's environment.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/encoded_image.h"
#include "scene/scene.h"

#include <memory>

namespace obscura {

/// Fills Scene::environment and its name in Scene::info. The six faces of the finest level of
/// EXT_lights_image_based are resampled, turned and multiplied as the light says. The prefiltered
/// levels and the irradiance are what a path tracer finds out by itself.
///
/// In      scene: in Document::scenes, -1: none; store: null, or what an earlier call has read
/// Errors  those of load_encoded and decode_image; 65 E-ENV-FACES, 77 E-ENV-LIMIT
Result<void> add_environment_light(const ImageSources& sources,
                                   int scene,
                                   std::shared_ptr<const ImageRgb32f>& store,
                                   Scene& out,
                                   Log& log);

}  // namespace obscura
