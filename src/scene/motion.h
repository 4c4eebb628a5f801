// scene/motion.h - the same scene at several times becomes one scene with motion.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <span>

namespace obscura {

/// Entry by entry between two poses, as Embree does; `time` in [0, 1].
Affinef world_from_object_at(const Scene& scene, const Instance& instance, float time);

/// Its inverse; for what stands still the stored one.
inline Affinef object_from_world_at(const Scene& scene, const Instance& instance, float time) {
    if (instance.motion < 0) return instance.object_from_world;
    return inverse(world_from_object_at(scene, instance, time));
}

/// Keeps of later poses what differs from the first one: vertices, normals, instances and cameras.
/// Textures and tangents stay those of the first pose; bounds grow to hold all.
///
/// In      first: not yet moving; later: the same scene at evenly spaced later times
/// Returns false, and leaves `first` as it was, when the poses are not made of the same parts (a
///         node appears or a triangle collapses meanwhile).
bool join_motion(Scene& first, std::span<const Scene> later);

}  // namespace obscura
