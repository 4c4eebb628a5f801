// stages/3_aov.cpp - stage 3 for AOVs: one value per pixel, without light or randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Cosine between the ray and the axis along which depth and near are measured: 1 where the camera
/// has no image plane.
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

/// Distance from the eye, or from the camera's plane where rays are parallel.
OBSCURA_INLINE Lanes distance_along_ray(const Camera& camera, const PathLanes& path, Lanes t) {
    return t + Lanes(camera.near_m) / max(cosine_to_axis(camera, path), Lanes(1e-6f));
}

/// UV set 0 as the mesh has it, or a shape's own parametrisation; 0 where there is none.
OBSCURA_INLINE Vec3<Lanes> surface_uv(const SceneView& scene,
                                      const PathLanes& path,
                                      const HitLanes& hit) {
    HitGeometry g;
    find_geometry<HitUse::attributes>(scene, hit, g);
    instance_to_world(scene, hit, g);
    const LanesI base = g.primitive.integer<&Primitive::uv_base>();
    const Mask present = base != LanesI(no_attribute);
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    if (none(present)) return zero;
    g.first_uv = read_mesh_uv(scene, g, mesh_uv_base(g, base));
    shapes_to_world(scene, hit, path, g);
    read_points_lines_uv(scene, g);
    return select(present, Vec3<Lanes>{g.first_uv.at.x, g.first_uv.at.y, Lanes(0.0f)}, zero);
}

/// Indices of glTF node, glTF material and triangle, plus 1; material 0 is the default one.
OBSCURA_INLINE Vec3<Lanes> identity(const SceneView& scene, const HitLanes& hit) {
    const TableRecord<Lanes, Primitive> primitive(scene.primitives, hit.primitive);
    LanesI node = primitive.integer<&Primitive::node>();
    const LanesI material =
        gather<Lanes>(scene.material_numbers, primitive.integer<&Primitive::material>());
    const Mask instanced = hit.instance >= LanesI(0);
    if (any(instanced)) {
        const LanesI own = instance_record(scene, hit).integer<&Instance::node>();
        node = select(instanced, max(own, node), node);
    }
    return {from_int<Lanes>(node + LanesI(1)),
            from_int<Lanes>(material + LanesI(1)),
            from_int<Lanes>(hit.triangle + LanesI(1))};
}

template <Aov aov>
OBSCURA_INLINE Vec3<Lanes> aov_of(const SceneView& scene,
                                  const Camera& camera,
                                  const PathLanes& path,
                                  const HitLanes& hit) {
    const Lanes zero(0.0f);
    if constexpr (aov == Aov::depth) {
        return {axial_depth(camera, path, hit.t), zero, zero};
    } else if constexpr (aov == Aov::distance) {
        return {distance_along_ray(camera, path, hit.t), zero, zero};
    } else if constexpr (aov == Aov::uv) {
        return surface_uv(scene, path, hit);
    } else if constexpr (aov == Aov::id) {
        return identity(scene, hit);
    } else {
        const SurfaceInteraction interaction = find_surface_interaction<HitUse::attributes>(
            scene, hit, path, {Filtering::bilinear, splat3(Lanes(0.5f))});
        constexpr auto texture =
            aov == Aov::albedo ? &Material::base_color_texture : &Material::normal_texture;
        const FoundSlot slot = find_slot<texture>(
            scene, interaction.g, interaction.g.material, interaction.filter, {});
        if constexpr (aov == Aov::albedo) {
            return base_color(scene, interaction.g, interaction.filter, slot);
        } else {
            const TangentLanes tangents = read_tangents(scene, hit, interaction.g, slot.used);
            const Vec3<Lanes> normal = shading_normal(scene, interaction, tangents, slot);
            if constexpr (aov == Aov::normal) return normal;
            return {abs(dot(normal, path.direction)), zero, zero};
        }
    }
}

/// Each AOV gets its own loop, so that the compiler drops the work it does not need. Index i is
/// pixel i.
template <Aov aov>
void write_all(const SceneView& scene, const Camera& camera, int count, const AovColumns& columns) {
    const SampleColumns& out = columns.samples;
    for (int i = 0; i < count; i += lane_count) {
        const Mask hits =
            lanes_in_range(i, count) & (load(columns.hits.primitive + i) >= LanesI(0));
        if (none(hits)) {
            store3(out.r, out.g, out.b, i, splat3(Lanes(0.0f)));
            store(out.a + i, Lanes(0.0f));
            continue;
        }
        HitLanes hit = hits_or_first(columns.hits, i, hits);
        if (columns.time != nullptr) hit.time = load(columns.time + i);  // path i is pixel i
        const PathLanes path = load_paths(columns.paths, i);
        const Vec3<Lanes> value = aov_of<aov>(scene, camera, path, hit);
        store3(out.r, out.g, out.b, i, select(hits, value, splat3(Lanes(0.0f))));
        store(out.a + i, select(hits, Lanes(1.0f), Lanes(0.0f)));
    }
}

}  // namespace

void write_aov(const SceneView& scene,
               const BatchSettings& batch,
               Aov aov,
               int count,
               const AovColumns& columns) {
    switch (aov) {
        case Aov::normal:
            return write_all<Aov::normal>(scene, batch.camera, count, columns);
        case Aov::facing:
            return write_all<Aov::facing>(scene, batch.camera, count, columns);
        case Aov::depth:
            return write_all<Aov::depth>(scene, batch.camera, count, columns);
        case Aov::distance:
            return write_all<Aov::distance>(scene, batch.camera, count, columns);
        case Aov::uv:
            return write_all<Aov::uv>(scene, batch.camera, count, columns);
        case Aov::albedo:
            return write_all<Aov::albedo>(scene, batch.camera, count, columns);
        case Aov::id:
            return write_all<Aov::id>(scene, batch.camera, count, columns);
        case Aov::wireframe:
            return write_wireframe(scene, batch, count, columns);
        case Aov::heat:
            break;
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
