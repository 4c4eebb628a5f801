// gltf/geometry/left_out_nodes.h - leaves out or stops instances that rays cannot enter.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"
#include "scene/scene.h"

namespace obscura::gltf {

/// Removes instances in whose space rays would exceed single precision (scene/ray_reach.h), stops
/// those whose motion rays could not follow while the shutter is open, removes copies that crowd on
/// one spot (scene/coincident_instances.h), and warns of each. The motion from frame to frame loses
/// them, too.
void leave_out_nodes(const Document& document, Scene& scene, Log& log);

}  // namespace obscura::gltf
