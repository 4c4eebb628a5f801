// stages/3_quantity.cpp - stage 3 for integrators named after a quantity: no light, no randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Distance along the camera's view axis; from the eye where the camera has no flat picture. Rays
/// begin at the near distance.
OBSCURA_INLINE Lanes axial_depth(const Camera& camera, const PathLanes& path, Lanes distance) {
    if (measures_from_eye(camera)) return distance + Lanes(camera.near_m);
    const auto& m = camera.world_from_camera.m;
    const Vec3<Lanes> forward{Lanes(-m[0][2]), Lanes(-m[1][2]), Lanes(-m[2][2])};
    return distance * dot(path.direction, forward) + Lanes(camera.near_m);
}

/// Numbers of glTF node, glTF material and triangle, from 1; material 0 is the default one.
OBSCURA_INLINE Vec3<Lanes> identity(const SceneView& scene, const HitLanes& hit) {
    const TableRow<Lanes> primitive(scene.primitives, hit.primitive, primitive_words);
    LanesI node = primitive.integer(14);
    const LanesI material = gather<Lanes>(scene.material_numbers, primitive.integer(2));
    const Mask instanced = hit.instance >= LanesI(0);
    if (any(instanced)) {
        node = select(instanced, instance_row(scene, hit).integer(25), node);
    }
    return {from_int<Lanes>(node + LanesI(1)),
            from_int<Lanes>(material + LanesI(1)),
            from_int<Lanes>(hit.triangle + LanesI(1))};
}

template <Quantity quantity>
OBSCURA_INLINE Vec3<Lanes> quantity_of(const SceneView& scene,
                                       const Camera& camera,
                                       const PathLanes& path,
                                       const HitLanes& hit) {
    if constexpr (quantity == Quantity::depth) {
        return {axial_depth(camera, path, hit.t), Lanes(0.0f), Lanes(0.0f)};
    } else if constexpr (quantity == Quantity::id) {
        return identity(scene, hit);
    } else {
        const ShadingPoint s =
            shading_point(scene, hit, path, splat3(Lanes(0.5f)), Filtering::bilinear);
        return quantity == Quantity::normal ? s.normal : s.bsdf.base_color;
    }
}

/// A loop of its own for each quantity, so that the compiler drops what the quantity does not need.
/// Row i is pixel i.
template <Quantity quantity>
void write_all(const SceneView& scene, const Camera& camera, int count, const ShadeRows& rows) {
    const SampleRows& out = rows.samples;
    for (int i = 0; i < count; i += lane_count) {
        const Mask hits = rows_in_range(i, count) & (load(rows.hits.primitive + i) >= LanesI(0));
        if (none(hits)) {
            store3(out.r, out.g, out.b, i, splat3(Lanes(0.0f)));
            store(out.a + i, Lanes(0.0f));
            continue;
        }
        const HitLanes hit = hits_or_first(rows.hits, i, hits);
        const PathLanes path = load_paths(rows.paths, i);
        const Vec3<Lanes> value = quantity_of<quantity>(scene, camera, path, hit);
        store3(out.r, out.g, out.b, i, select(hits, value, splat3(Lanes(0.0f))));
        store(out.a + i, select(hits, Lanes(1.0f), Lanes(0.0f)));
    }
}

}  // namespace

void write_quantity(const SceneView& scene,
                    const BatchSettings& batch,
                    Quantity quantity,
                    int count,
                    const ShadeRows& rows) {
    switch (quantity) {
        case Quantity::normal:
            return write_all<Quantity::normal>(scene, batch.camera, count, rows);
        case Quantity::depth:
            return write_all<Quantity::depth>(scene, batch.camera, count, rows);
        case Quantity::albedo:
            return write_all<Quantity::albedo>(scene, batch.camera, count, rows);
        case Quantity::id:
            return write_all<Quantity::id>(scene, batch.camera, count, rows);
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
