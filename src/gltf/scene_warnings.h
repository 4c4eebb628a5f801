// gltf/scene_warnings.h - warnings about a scene as a whole: empty, far away, very small or large.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "gltf/parse/document.h"
#include "scene/scene.h"

namespace obscura::gltf {

/// Says where single precision or emptiness will surprise.
void warn_about_whole(const Document& document, const Scene& scene, Log& log);

}  // namespace obscura::gltf
