// stages/3_motion.cpp - instances and vertices interpolated to the time of the hit.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_motion.h"

#include "stages/moment.h"

namespace obscura {
inline namespace OBSCURA_ISA {

InstanceMaps moved_instance(const SceneView& scene,
                            LanesI first,
                            Lanes time,
                            const InstanceMaps& still) {
    const Mask moves = first >= LanesI(0);
    if (none(moves)) return still;
    const Moment moment = moment_of(scene.motion.steps, time);
    const LanesI before = select(moves, first + moment.step, LanesI(0));
    const LanesI after = select(moves, before + LanesI(1), LanesI(0));
    const Affine<Lanes> world =
        blend(read_affine(TableRecord<Lanes, Affinef>(scene.motion.instances, before)),
              read_affine(TableRecord<Lanes, Affinef>(scene.motion.instances, after)),
              moment.fraction);
    const Affine<Lanes> object = inverse(world);
    InstanceMaps out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            out.world_from_object.m[r][c] =
                select(moves, world.m[r][c], still.world_from_object.m[r][c]);
            out.object_from_world.m[r][c] =
                select(moves, object.m[r][c], still.object_from_world.m[r][c]);
        }
    }
    return out;
}

CornerVectors moved_corners(const SceneView& scene,
                            const float* table,
                            const HitCorners& corners,
                            const CornerVectors& still) {
    const TableRecord<Lanes, Primitive>& primitive = corners.primitive;
    const LanesI base = primitive.integer<&Primitive::motion_base>();
    const Mask moves = base != LanesI(no_attribute);
    if (none(moves)) return still;
    const LanesI stride = primitive.integer<&Primitive::motion_stride>();
    const Moment moment = moment_of(scene.motion.steps, corners.time);
    CornerVectors out;
    for (int k = 0; k < 3; ++k) {
        const LanesI word = base + moment.step * stride + corners.number[k] * LanesI(3);
        const Vec3<Lanes> before = gather3(table, select(moves, word, LanesI(0)));
        const Vec3<Lanes> after = gather3(table, select(moves, word + stride, LanesI(0)));
        out.at[k] = select(moves, before + (after - before) * moment.fraction, still.at[k]);
    }
    return out;
}

CornerVectors keep_lengths_in_world(const SceneView& scene,
                                    LanesI instance,
                                    Lanes time,
                                    const CornerVectors& normals) {
    const Mask instanced = instance >= LanesI(0);
    if (none(instanced)) return normals;
    const Affine<Lanes> object = instance_maps(scene, instance, time).object_from_world;
    CornerVectors out;
    for (int k = 0; k < 3; ++k) {
        const Vec3<Lanes>& normal = normals.at[k];
        const Lanes in_world = max(length(transform_normal(object, normal)), Lanes(1e-30f));
        out.at[k] = select(instanced, normal * (length(normal) / in_world), normal);
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
