// stages/3_quantity.cpp - stage 3 for integrators named after a quantity: no light, no randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Distance along the camera's view axis.
OBSCURA_INLINE Lanes axial_depth(const Camera& camera, const PathLanes& path, Lanes distance) {
    const auto& m = camera.world_from_camera.m;
    const Vec3<Lanes> forward{Lanes(-m[0][2]), Lanes(-m[1][2]), Lanes(-m[2][2])};
    return distance * dot(path.direction, forward);
}

OBSCURA_INLINE Vec3<Lanes> quantity_of(const SceneView& scene,
                                       const Camera& camera,
                                       Quantity quantity,
                                       const PathLanes& path,
                                       const HitLanes& hit) {
    const ShadingPoint s =
        shading_point(scene, hit, path, splat3(Lanes(0.5f)), Filtering::bilinear);
    switch (quantity) {
        case Quantity::normal:
            return s.normal;
        case Quantity::depth:
            return {axial_depth(camera, path, hit.t), Lanes(0.0f), Lanes(0.0f)};
        case Quantity::albedo:
            return s.bsdf.base_color;
        case Quantity::id:
            break;
    }
    const TableRow<Lanes> primitive(scene.primitives, hit.primitive, primitive_words);
    LanesI node = primitive.integer(14);
    const Mask instanced = hit.instance >= LanesI(0);
    if (any(instanced)) {
        node = select(instanced, instance_row(scene, hit).integer(25), node);
    }
    const LanesI material = primitive.integer(2);
    return {from_int<Lanes>(node + LanesI(1)),
            from_int<Lanes>(material + LanesI(1)),
            from_int<Lanes>(hit.triangle + LanesI(1))};
}

}  // namespace

void write_quantity(const SceneView& scene,
                    const BatchSettings& batch,
                    Quantity quantity,
                    int count_in,
                    const ShadeRows& rows) {
    const SortedCounts sorted = sort_hits_from_misses(count_in, rows);
    for (int i = 0; i < sorted.hits; i += lane_count) {
        const Mask exists = rows_in_range(i, sorted.hits);
        const PathLanes path = load_paths(rows.paths, i);
        const HitLanes hit = hits_or_first(rows.hits, i, exists);
        const Vec3<Lanes> value = quantity_of(scene, batch.camera, quantity, path, hit);
        add_radiance(rows.samples, exists, path.slot, value);
    }
    for (int i = 0; i < sorted.hits; ++i)
        rows.samples.a[rows.paths.slot[i]] = 1.0f;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
