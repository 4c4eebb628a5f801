// stages/3_motion.h - where moving things are at the time of a hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_tables.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// How an instance is placed at the time of each hit. Lanes in world space get any placing.
struct InstanceMaps {
    Affine<Lanes> world_from_object, object_from_world;
};

/// Corners of triangles, or normals at them.
struct CornerVectors {
    Vec3<Lanes> at[3];
};

/// Apart from the shading functions: they are long enough without what most scenes have no use for.
InstanceMaps moved_instance(const SceneView& scene,
                            LanesI row,
                            Lanes time,
                            const InstanceMaps& still);

/// The corners of the triangles that were hit.
struct HitCorners {
    const TableRow<Lanes, Primitive>& primitive;
    const LanesI (&number)[3];
    Lanes time;
};

/// In  table: MotionView::positions or normals; still: of lanes whose primitive does not move
CornerVectors moved_corners(const SceneView& scene,
                            const float* table,
                            const HitCorners& corners,
                            const CornerVectors& still);

/// In  instance: rows; lanes in world space may have any
OBSCURA_INLINE InstanceMaps instance_maps(const SceneView& scene, LanesI instance, Lanes time) {
    const TableRow<Lanes, Instance> row(scene.instances, max(instance, LanesI(0)));
    InstanceMaps maps{read_affine<&Instance::world_from_object>(row),
                      read_affine<&Instance::object_from_world>(row)};
    if (scene.motion.instances != nullptr) {
        const InstanceMaps still = maps;
        maps = moved_instance(scene, row.integer<&Instance::motion>(), time, still);
    }
    return maps;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
