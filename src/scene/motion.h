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

/// How much of a scene's arrays, from their start, no time changes: numbers, not vertices.
struct StillSizes {
    size_t positions = 0;
    size_t indices = 0;
    size_t attributes = 0;
};

/// What of a scene a time may change.
struct ScenePose {
    StillSizes still;
    LargeArray<float> positions;  ///< those behind the still ones, and so on
    LargeArray<uint32_t> indices;
    LargeArray<float> attributes;
    std::vector<Primitive> primitives;
    std::vector<Instance> instances;
    std::vector<SceneCamera> cameras;
    std::vector<PunctualLight> lights;
    Bounds bounds;
};

/// Takes it out of a scene of which the still parts alone will be wanted again.
ScenePose take_pose(Scene& scene, const StillSizes& still);

/// Keeps of later poses what differs from the first one: vertices, normals, instances, cameras and
/// punctual lights. Textures and tangents stay those of the first pose; bounds grow to hold all.
///
/// In      first: not yet moving; later: the same scene at evenly spaced later times
/// Returns false, and leaves `first` as it was, when the poses are not made of the same parts (a
///         node appears or a triangle collapses meanwhile).
bool join_motion(Scene& first, std::span<const ScenePose> later);

}  // namespace obscura
