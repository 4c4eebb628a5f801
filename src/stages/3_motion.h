// stages/3_motion.h - instances and vertices at the time of the hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_tables.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Transforms of the hit instance at the time of each hit; arbitrary for lanes in world space.
struct InstanceMaps {
    Affine<Lanes> world_from_object, object_from_world;
};

/// Corners of triangles, or normals at them.
struct CornerVectors {
    Vec3<Lanes> at[3];
};

/// Not inlined into the shading functions, because most scenes have no motion.
InstanceMaps moved_instance(const SceneView& scene,
                            LanesI first,
                            Lanes time,
                            const InstanceMaps& still);

/// The corners of the triangles that were hit.
struct HitCorners {
    const TableRecord<Lanes, Primitive>& primitive;
    const LanesI (&number)[3];
    Lanes time;
};

/// In  table: MotionView::positions or normals; still: of lanes whose primitive does not move
CornerVectors moved_corners(const SceneView& scene,
                            const float* table,
                            const HitCorners& corners,
                            const CornerVectors& still);

/// Normals at the corners, scaled so that in world space they have the lengths that they have
/// here: they weigh there as in a mesh without an instance. Not inlined: few scenes stretch.
CornerVectors keep_lengths_in_world(const SceneView& scene,
                                    LanesI instance,
                                    Lanes time,
                                    const CornerVectors& normals);

/// In  instance: records; lanes in world space may have any
OBSCURA_INLINE InstanceMaps instance_maps(const SceneView& scene, LanesI instance, Lanes time) {
    const TableRecord<Lanes, Instance> record(scene.instances, max(instance, LanesI(0)));
    InstanceMaps maps{read_affine<&Instance::world_from_object>(record),
                      read_affine<&Instance::object_from_world>(record)};
    if (scene.motion.instances != nullptr) {
        const InstanceMaps still = maps;
        maps = moved_instance(scene, record.integer<&Instance::motion>(), time, still);
    }
    return maps;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
