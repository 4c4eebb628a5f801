// scene/media.h - numbers the bodies that light travels through, by precedence.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// Gives every row of Scene::layers whose `medium` is not 0 its final number and fills
/// Scene::media.
///
/// Where bodies overlap, the one with the greater number fills the place: the optically denser one,
/// so that a liquid which reaches into its glass ends at the glass. Beyond most_media, bodies
/// share the last number.
void number_media(Scene& scene);

/// Number of the medium that a primitive bounds, 0: none.
int32_t medium_of(const Scene& scene, const Primitive& primitive);

}  // namespace obscura
