// scene/media.h - numbers the media inside meshes by their priority, for nested dielectrics.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// Gives every record of Scene::layers whose `medium` is not 0 its final number and fills
/// Scene::media.
///
/// Where media overlap, the one with the greater number dominates: the optically denser one, so
/// that a liquid which reaches into its glass ends at the glass. Beyond max_media, media share the
/// last number.
void number_media(Scene& scene);

/// Number of the medium that a primitive bounds, 0: none.
int32_t medium_of(const Scene& scene, const Primitive& primitive);

}  // namespace obscura
