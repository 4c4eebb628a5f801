// stages/3_quantity.cpp - stage 3 for integrators named after a quantity: no light, no randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Between the ray and the axis along which depth and near are measured: 1 where the camera has no
/// flat picture.
OBSCURA_INLINE Lanes cosine_to_axis(const Camera& camera, const PathLanes& path) {
    if (measures_from_eye(camera)) return Lanes(1.0f);
    const auto& m = camera.world_from_camera.m;
    const Vec3<Lanes> forward{Lanes(-m[0][2]), Lanes(-m[1][2]), Lanes(-m[2][2])};
    return dot(path.direction, forward);
}

/// Distance along the camera's view axis. Rays begin at the near distance.
OBSCURA_INLINE Lanes axial_depth(const Camera& camera, const PathLanes& path, Lanes t) {
    return t * cosine_to_axis(camera, path) + Lanes(camera.near_m);
}

/// From the eye, or from the camera's plane where rays are parallel.
OBSCURA_INLINE Lanes distance_along_ray(const Camera& camera, const PathLanes& path, Lanes t) {
    return t + Lanes(camera.near_m) / max(cosine_to_axis(camera, path), Lanes(1e-6f));
}

/// UV set 0 as the mesh has it, or a shape's own parametrisation; 0 where there is none.
OBSCURA_INLINE Vec3<Lanes> surface_uv(const SceneView& scene,
                                      const PathLanes& path,
                                      const HitLanes& hit) {
    HitGeometry g;
    find_geometry<HitUse::look>(scene, hit, g);
    instance_to_world(scene, hit, g);
    const LanesI base = g.primitive.integer<&Primitive::uv_base>();
    const Mask present = base != LanesI(no_attribute);
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    if (none(present)) return zero;
    g.first_uv = read_mesh_uv(scene, g, mesh_uv_base(g, base));
    shapes_to_world(scene, hit, path, g);
    read_stroke_uv(scene, g);
    return select(present, Vec3<Lanes>{g.first_uv.at.x, g.first_uv.at.y, Lanes(0.0f)}, zero);
}

/// Numbers of glTF node, glTF material and triangle, from 1; material 0 is the default one.
OBSCURA_INLINE Vec3<Lanes> identity(const SceneView& scene, const HitLanes& hit) {
    const TableRow<Lanes, Primitive> primitive(scene.primitives, hit.primitive);
    LanesI node = primitive.integer<&Primitive::node>();
    const LanesI material =
        gather<Lanes>(scene.material_numbers, primitive.integer<&Primitive::material>());
    const Mask instanced = hit.instance >= LanesI(0);
    if (any(instanced)) {
        const LanesI own = instance_row(scene, hit).integer<&Instance::node>();
        node = select(instanced, max(own, node), node);
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
    const Lanes zero(0.0f);
    if constexpr (quantity == Quantity::depth) {
        return {axial_depth(camera, path, hit.t), zero, zero};
    } else if constexpr (quantity == Quantity::distance) {
        return {distance_along_ray(camera, path, hit.t), zero, zero};
    } else if constexpr (quantity == Quantity::uv) {
        return surface_uv(scene, path, hit);
    } else if constexpr (quantity == Quantity::id) {
        return identity(scene, hit);
    } else {
        const SeenSurface seen =
            see_surface<HitUse::look>(scene, hit, path, {Filtering::bilinear, splat3(Lanes(0.5f))});
        constexpr auto texture = quantity == Quantity::albedo ? &Material::base_color_texture
                                                              : &Material::normal_texture;
        const FoundSlot slot = find_slot<texture>(scene, seen.g, seen.g.material, seen.look, {});
        if constexpr (quantity == Quantity::albedo) {
            return base_color(scene, seen.g, seen.look, slot);
        } else {
            const TangentLanes tangents = read_tangents(scene, hit, seen.g, slot.used);
            const Vec3<Lanes> normal = shading_normal(scene, seen, tangents, slot);
            if constexpr (quantity == Quantity::normal) return normal;
            return {abs(dot(normal, path.direction)), zero, zero};
        }
    }
}

/// A loop of its own for each quantity, so that the compiler drops what the quantity does not need.
/// Row i is pixel i.
template <Quantity quantity>
void write_all(const SceneView& scene, const Camera& camera, int count, const AovColumns& rows) {
    const SampleRows& out = rows.samples;
    for (int i = 0; i < count; i += lane_count) {
        const Mask hits = rows_in_range(i, count) & (load(rows.hits.primitive + i) >= LanesI(0));
        if (none(hits)) {
            store3(out.r, out.g, out.b, i, splat3(Lanes(0.0f)));
            store(out.a + i, Lanes(0.0f));
            continue;
        }
        HitLanes hit = hits_or_first(rows.hits, i, hits);
        if (rows.time != nullptr) hit.time = load(rows.time + i);  // row i is pixel i
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
                    const AovColumns& rows) {
    switch (quantity) {
        case Quantity::normal:
            return write_all<Quantity::normal>(scene, batch.camera, count, rows);
        case Quantity::facing:
            return write_all<Quantity::facing>(scene, batch.camera, count, rows);
        case Quantity::depth:
            return write_all<Quantity::depth>(scene, batch.camera, count, rows);
        case Quantity::distance:
            return write_all<Quantity::distance>(scene, batch.camera, count, rows);
        case Quantity::uv:
            return write_all<Quantity::uv>(scene, batch.camera, count, rows);
        case Quantity::albedo:
            return write_all<Quantity::albedo>(scene, batch.camera, count, rows);
        case Quantity::id:
            return write_all<Quantity::id>(scene, batch.camera, count, rows);
        case Quantity::wireframe:
            return write_wireframe(scene, batch, count, rows);
        case Quantity::heat:
            break;
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
