// stages/3_aov.cpp - stage 3 for AOVs: what the first hits tell, without light or randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_aov_beyond.h"
#include "stages/3_shade.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Cosine between the ray and the axis along which depth and near are measured: 1 where the camera
/// has no image plane.
OBSCURA_INLINE Lanes cosine_to_axis(const Camera& camera, const PathLanes& path) {
    if (measures_from_eye(camera.model)) return Lanes(1.0f);
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

/// Index of the glTF node.
OBSCURA_INLINE LanesI node_of(const SceneView& scene, const HitLanes& hit) {
    const TableRecord<Lanes, Primitive> primitive(scene.primitives, hit.primitive);
    const LanesI node = primitive.integer<&Primitive::node>();
    const Mask instanced = hit.instance >= LanesI(0);
    if (none(instanced)) return node;
    const LanesI own = instance_record(scene, hit).integer<&Instance::node>();
    return select(instanced, max(own, node), node);
}

/// Index of the glTF material; -1: the default one.
OBSCURA_INLINE LanesI material_of(const SceneView& scene, const HitLanes& hit) {
    const TableRecord<Lanes, Primitive> primitive(scene.primitives, hit.primitive);
    return gather<Lanes>(scene.material_numbers, primitive.integer<&Primitive::material>());
}

/// The texture slot of a material at the hits, found by bilinear filtering.
template <auto slot>
OBSCURA_INLINE FoundSlot bilinear_slot(const SceneView& scene,
                                       const SurfaceInteraction& interaction,
                                       const CommonTexel& common) {
    return find_slot<slot>(
        scene, interaction.g, interaction.g.material, interaction.filter, common);
}

/// A number of the material times a channel of its texture.
OBSCURA_INLINE Lanes textured(const SceneView& scene,
                              const SurfaceInteraction& interaction,
                              const CommonTexel& common,
                              Lanes factor,
                              int channel) {
    const auto slot =
        bilinear_slot<&Material::metallic_roughness_texture>(scene, interaction, common);
    if (none(slot.used)) return factor;
    const Vec3<Lanes> texel = read_slot(scene, interaction.g, slot, interaction.filter).rgb;
    return select(slot.used, factor * (channel == 1 ? texel.y : texel.z), factor);
}

/// The emission towards the viewer: none from the back of a single-sided surface.
OBSCURA_INLINE Vec3<Lanes> emission_color(const SceneView& scene,
                                          const SurfaceInteraction& interaction) {
    const HitGeometry& g = interaction.g;
    Vec3<Lanes> emission = g.material.vector<&Material::emission>();
    const LanesI flags = g.material.integer<&Material::flags>();
    const Mask seen = (interaction.cos_front >= Lanes(0.0f)) | glow_on_both_sides(flags) |
                      has_bits<Lanes>(flags, material_unlit);
    const auto slot = bilinear_slot<&Material::emissive_texture>(scene, interaction, {});
    if (any(slot.used)) {
        const Vec3<Lanes> texel = read_slot(scene, g, slot, interaction.filter).rgb;
        emission = select(slot.used, emission * texel, emission);
    }
    return select(seen, emission, splat3(Lanes(0.0f)));
}

OBSCURA_INLINE Vec3<Lanes> normal_with_map(const SceneView& scene,
                                           const HitLanes& hit,
                                           const SurfaceInteraction& interaction,
                                           const CommonTexel& common) {
    const auto slot = bilinear_slot<&Material::normal_texture>(scene, interaction, common);
    const TangentLanes tangents = read_tangents(scene, hit, interaction.g, slot.used);
    return shading_normal(scene, interaction, tangents, slot);
}

/// AOVs that only the ray, its hit and the tables of primitives and instances tell.
constexpr bool needs_surface(Aov aov) {
    switch (aov) {
        case Aov::depth:
        case Aov::distance:
        case Aov::uv:
        case Aov::opacity:
        case Aov::id_node:
        case Aov::id_material:
        case Aov::id_triangle:
        case Aov::instance:
            return false;
        default:
            return true;
    }
}

/// AOVs that read textures which a material may have laid alike.
constexpr bool reads_alike_textures(Aov aov) {
    switch (aov) {
        case Aov::normal:
        case Aov::facing:
        case Aov::base_color:
        case Aov::albedo:
        case Aov::roughness:
        case Aov::metallic:
            return true;
        default:
            return false;
    }
}

OBSCURA_INLINE Vec3<Lanes> aov_of_hit(const AovGroup& at, Aov aov) {
    const Lanes zero(0.0f);
    const auto one = [&](Lanes value) { return Vec3<Lanes>{value, zero, zero}; };
    const auto number = [&](LanesI index) { return one(from_int<Lanes>(index + LanesI(1))); };
    switch (aov) {
        case Aov::depth:
            return one(axial_depth(at.batch.camera, at.path, at.hit.t));
        case Aov::distance:
            return one(distance_along_ray(at.batch.camera, at.path, at.hit.t));
        case Aov::uv:
            return surface_uv(at.scene, at.path, at.hit);
        case Aov::id_node:
            return number(node_of(at.scene, at.hit));
        case Aov::id_material:
            return number(material_of(at.scene, at.hit));
        case Aov::id_triangle:
            return number(at.hit.triangle);
        case Aov::instance:
            return number(at.hit.instance);
        default:
            return one(Lanes(1.0f));
    }
}

OBSCURA_INLINE Vec3<Lanes> aov_of_surface(const AovGroup& at,
                                          const SurfaceInteraction& interaction,
                                          const CommonTexel& common,
                                          Aov aov) {
    const Lanes zero(0.0f);
    const SceneView& scene = at.scene;
    const HitGeometry& g = interaction.g;
    switch (aov) {
        case Aov::position:
            return g.position;
        case Aov::normal_geometric:
            return interaction.ng;
        case Aov::tangent: {
            const TangentLanes tangents = read_tangents(scene, at.hit, g, Mask(true));
            return select(tangents.known, tangents.tangent, splat3(zero));
        }
        case Aov::facing: {
            const Vec3<Lanes> normal = normal_with_map(scene, at.hit, interaction, common);
            return {abs(dot(normal, at.path.direction)), zero, zero};
        }
        case Aov::base_color: {
            const auto slot =
                bilinear_slot<&Material::base_color_texture>(scene, interaction, common);
            return base_color(scene, g, interaction.filter, slot);
        }
        case Aov::roughness:
            return {
                textured(scene, interaction, common, g.material.number<&Material::roughness>(), 1),
                zero,
                zero};
        case Aov::metallic:
            return {
                textured(scene, interaction, common, g.material.number<&Material::metallic>(), 2),
                zero,
                zero};
        case Aov::emission_color:
            return emission_color(scene, interaction);
        default:
            return normal_with_map(scene, at.hit, interaction, common);
    }
}

/// Writes 0 for a group without hits.
OBSCURA_INLINE void store_nothing(const AovColumns& columns, int first) {
    for (const AovOutput& out : columns.outputs) {
        for (int c = 0; c < channel_count(out.aov); ++c)
            store(out.columns[c] + first, Lanes(0.0f));
    }
    if (columns.passed_on != nullptr) store(columns.passed_on + first, Lanes(0.0f));
}

}  // namespace

void write_aovs(const SceneView& scene,
                const BatchSettings& batch,
                int count,
                const AovColumns& columns) {
    bool any_surface = false;
    bool any_alike = false;
    for (const AovOutput& out : columns.outputs) {
        any_surface |= needs_surface(out.aov);
        any_alike |= reads_alike_textures(out.aov);
    }
    for (int i = 0; i < count; i += lane_count) {
        const Mask hits =
            lanes_in_range(i, count) & (load(columns.hits.primitive + i) >= LanesI(0));
        if (none(hits)) {
            store_nothing(columns, i);
            continue;
        }
        HitLanes hit = hits_or_first(columns.hits, i, hits);
        if (columns.time != nullptr) hit.time = load(columns.time + i);  // path i is sample i
        const PathLanes path = load_paths(columns.paths, i);
        const AovGroup group{scene, batch, path, hit, i, hits};
        for (const AovOutput& out : columns.outputs) {
            if (!needs_surface(out.aov)) store_aov(out, group, aov_of_hit(group, out.aov));
        }
        if (!any_surface) continue;
        const SurfaceInteraction interaction = find_surface_interaction<HitUse::attributes>(
            scene, hit, path, {Filtering::bilinear, splat3(Lanes(0.5f)), batch.footprint_fraction});
        CommonTexel common;
        if (any_alike) common = find_common_texel(scene, interaction.g, interaction.filter);
        for (const AovOutput& out : columns.outputs) {
            if (looks_beyond(out.aov)) {
                write_aov_beyond(group, interaction, common, columns, out);
            } else if (needs_surface(out.aov)) {
                store_aov(out, group, aov_of_surface(group, interaction, common, out.aov));
            }
        }
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
