// scene/motion.h - merges several poses of a scene into one scene with motion blur.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <span>

namespace obscura {

/// Interpolates the matrix entries between two poses, as Embree does; `time` in [0, 1].
Affinef world_from_object_at(const Scene& scene, const Instance& instance, float time);

/// The inverse of world_from_object_at; the stored one for static instances.
inline Affinef object_from_world_at(const Scene& scene, const Instance& instance, float time) {
    if (instance.motion < 0) return instance.object_from_world;
    return inverse(world_from_object_at(scene, instance, time));
}

/// Sizes of the static parts at the start of a scene's arrays, in numbers, not vertices.
struct StaticSizes {
    size_t positions = 0;
    size_t indices = 0;
    size_t attributes = 0;
};

/// The parts of a scene that may change with time.
struct ScenePose {
    StaticSizes static_sizes;
    LargeArray<float> positions;  ///< those after the static ones; likewise the others
    LargeArray<uint32_t> indices;
    LargeArray<float> attributes;
    std::vector<Primitive> primitives;
    std::vector<Instance> instances;
    std::vector<SceneCamera> cameras;
    std::vector<PunctualLight> lights;
    Bounds bounds;
};

/// True when a pose has the same parts as a scene: triangles, instances, cameras and lights.
bool have_same_structure(const Scene& scene, const ScenePose& pose);

/// The vertices of a primitive, which are contiguous.
struct VertexRange {
    size_t first = 0;
    size_t count = 0;
};

/// In   primitive: a mesh
VertexRange vertices_of(const Scene& scene, const Primitive& primitive);

/// Moves the pose out of a scene; only the scene's static parts stay valid.
ScenePose take_pose(Scene& scene, const StaticSizes& static_sizes);

/// Adds to the first pose the motion towards the later ones: vertices, normals, instances, cameras
/// and punctual lights. Textures and tangents stay those of the first pose; bounds hold all poses.
///
/// In      first: without motion; later: the same scene at evenly spaced later times
/// Out     false, with `first` unchanged, when the poses have different parts (a node appears or a
///         triangle collapses meanwhile)
bool join_motion(Scene& first, std::span<const ScenePose> later);

}  // namespace obscura
