// stages/3_surface.h - from a hit to a shading point: position, normals, material with textures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_layers.h"
#include "stages/3_occlusion.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A point ready for shading. Normals face the viewer.
struct ShadingPoint {
    Vec3<Lanes> start;  ///< of rays that leave on the viewer's side: clear of the surface itself
    Vec3<Lanes> light_start;  ///< of rays to lights: on the smooth surface that normals describe
    Vec3<Lanes> ng;
    Vec3<Lanes> normal;  ///< shading normal as the asset says
    Frame<Lanes> frame;  ///< around the shading normal, bent where it must be
    BsdfParams<Lanes> bsdf;
    LobeWeights<Lanes> lobes;
    Vec3<Lanes> emission;
    Mask unlit;
    LanesI light;     ///< index in the triangle light table, -1: none
    Lanes time;       ///< of the hit, 0 when the shutter opens
    Lanes occlusion;  ///< where SceneView::occludes
    bool any_layers = false;
    LayeredPoint layers;            ///< if any_layers
    Vec3<Lanes> transmitted_start;  ///< on the transmitted side; where any_layers
};

/// The textures that every hit reads.
struct FoundSlots {
    FoundSlot normal, metallic_roughness, base_color;
};

OBSCURA_INLINE FoundSlots find_slots(const SceneView& scene,
                                     const HitGeometry& g,
                                     const TextureFilter& filter,
                                     const CommonTexel& common) {
    return {
        find_slot<&Material::normal_texture, Detail::single>(scene, g, g.material, filter, common),
        find_slot<&Material::metallic_roughness_texture>(scene, g, g.material, filter, common),
        find_slot<&Material::base_color_texture>(scene, g, g.material, filter, common)};
}

/// The surface interaction of a ray: geometry, direction to the viewer, texture filter context.
struct SurfaceInteraction {
    HitGeometry g;
    Vec3<Lanes> wo;  ///< to the viewer
    Lanes cos_front;
    Vec3<Lanes> ng;  ///< on the viewer's side
    TextureFilter filter;
};

template <HitUse use>
OBSCURA_INLINE SurfaceInteraction find_surface_interaction(const SceneView& scene,
                                                           const HitLanes& hit,
                                                           const PathLanes& path,
                                                           const Reading& reading) {
    SurfaceInteraction interaction;
    HitGeometry& g = interaction.g;
    find_geometry<use>(scene, hit, g);
    instance_to_world(scene, hit, g);
    read_first_uv_set(scene, g);
    shapes_to_world(scene, hit, path, g);
    read_points_lines_uv(scene, g);
    interaction.wo = -path.direction;
    interaction.cos_front = dot(g.ng, interaction.wo);
    interaction.ng = select(interaction.cos_front >= Lanes(0.0f), g.ng, -g.ng);
    const Lanes width = path.cone_width + path.cone_spread * hit.t;
    // The cone's cross section on the slanted surface: geometric mean of its two widths.
    const Lanes area = width * width / max(abs(interaction.cos_front), Lanes(0.05f));
    interaction.filter = {area * Lanes(reading.fraction), reading.random, reading.filtering};
    return interaction;
}

/// The shading normal that the asset defines, normal map included, on the viewer's side.
OBSCURA_INLINE Vec3<Lanes> shading_normal(const SceneView& scene,
                                          const SurfaceInteraction& interaction,
                                          const TangentLanes& tangents,
                                          const FoundSlot& slot) {
    const HitGeometry& g = interaction.g;
    Vec3<Lanes> n = g.normal;
    if (any(slot.used)) {
        const Rgba<Lanes> texel = read_slot(scene, g, slot, interaction.filter);
        const Lanes scale = g.material.number<&Material::normal_scale>();
        n = tilt_normal(tangents, slot.used, g.normal, texel.rgb, scale);
    }
    return select(dot(n, interaction.ng) < Lanes(0.0f), -n, n);
}

OBSCURA_INLINE Vec3<Lanes> base_color(const SceneView& scene,
                                      const HitGeometry& g,
                                      const TextureFilter& filter,
                                      const FoundSlot& slot) {
    Vec3<Lanes> color = g.material.vector<&Material::base_color>();
    const LanesI color_base = g.primitive.integer<&Primitive::color_base>();
    const Mask colored = color_base != LanesI(no_attribute);
    if (any(colored)) {
        Vec3<Lanes> c[3];
        for (int k = 0; k < 3; ++k) {
            const LanesI word = select(colored, color_base + g.corner[k] * LanesI(4), LanesI(0));
            c[k] = read_corner3(scene.attributes, word, g.one_triangle);
        }
        color = select(colored, color * weighted(g, c), color);
    }
    if (any(slot.used)) {
        color = select(slot.used, color * read_slot(scene, g, slot, filter).rgb, color);
    }
    return color;
}

OBSCURA_INLINE BsdfParams<Lanes> bsdf_params(const SceneView& scene,
                                             const HitGeometry& g,
                                             const TextureFilter& filter,
                                             const FoundSlots& slots) {
    Lanes metallic = g.material.number<&Material::metallic>();
    Lanes roughness = g.material.number<&Material::roughness>();
    const FoundSlot& slot = slots.metallic_roughness;
    if (any(slot.used)) {
        const Rgba<Lanes> texel = read_slot(scene, g, slot, filter);
        roughness = select(slot.used, roughness * texel.rgb.y, roughness);
        metallic = select(slot.used, metallic * texel.rgb.z, metallic);
    }
    return {base_color(scene, g, filter, slots.base_color),
            metallic,
            max(roughness * roughness, Lanes(min_ggx_alpha))};
}

/// How a ray meets an emitter.
struct EmissionContext {
    const TextureFilter& filter;
    Mask front;    ///< from its front
    Mask by_bsdf;  ///< with a direction that light sampling could have chosen too
};

/// As glows_on_both_sides.
OBSCURA_INLINE Mask glow_on_both_sides(LanesI flags) {
    return has_bits<Lanes>(flags, material_double_sided) &
           (!has_bits<Lanes>(flags, material_glows_in_front));
}

/// The emission of a hit surface whose texture is found, but not read yet.
struct FoundEmission {
    Vec3<Lanes> factor;  ///< 0 where nothing glows
    Mask emits, by_bsdf;
    TextureFilter filter;
    FoundSlot slot;  ///< where any lane emits
};

/// Finds the surface's emission, and asks for the memory of its texture.
OBSCURA_INLINE FoundEmission find_emission(const SceneView& scene,
                                           const HitGeometry& g,
                                           const EmissionContext& context) {
    FoundEmission found;
    found.by_bsdf = context.by_bsdf;
    found.factor = g.material.vector<&Material::emission>();
    const LanesI flags = g.material.integer<&Material::flags>();
    found.emits =
        (max_component(found.factor) > Lanes(0.0f)) &
        (context.front | has_bits<Lanes>(flags, material_unlit) | glow_on_both_sides(flags));
    found.factor = select(found.emits, found.factor, splat3(Lanes(0.0f)));
    if (none(found.emits)) return found;
    // Where light sampling may find the same light, both strategies must read the same texels.
    found.filter = context.filter;
    found.filter.footprint = select(context.by_bsdf, Lanes(0.0f), context.filter.footprint);
    found.slot = find_slot<&Material::emissive_texture>(scene, g, g.material, found.filter, {});
    return found;
}

/// Reads the surface's emission, and its index in the light table.
///
/// In   s.any_layers, s.layers
OBSCURA_INLINE void read_emission(const SceneView& scene,
                                  const HitLanes& hit,
                                  const HitGeometry& g,
                                  const FoundEmission& found,
                                  ShadingPoint& s) {
    s.emission = found.factor;
    s.light = LanesI(-1);
    if (none(found.emits)) return;
    if (any(found.slot.used & found.emits)) {
        const Rgba<Lanes> texel = read_slot(scene, g, found.slot, found.filter);
        s.emission = select(found.slot.used, s.emission * texel.rgb, s.emission);
    }
    const LanesI base = g.primitive.integer<&Primitive::light_base>();
    LanesI light = base + hit.triangle;
    const Mask instanced = hit.instance >= LanesI(0);
    if (any(instanced)) {
        const LanesI own = instance_record(scene, hit).integer<&Instance::light_base>();
        light = light + select(instanced, own, LanesI(0));
    }
    s.light = select(found.emits & (base >= LanesI(0)), light, LanesI(-1));
    if (s.any_layers) {
        // Where light sampling may find the same light, both use sampled_coat_transmittance.
        const Mask coated = s.layers.layered & !(found.by_bsdf & (s.light >= LanesI(0)));
        s.emission = select(coated, s.emission * s.layers.weights.below_coat, s.emission);
    }
}

/// Moves the starts of rays clear of all faces that coincide with the hit.
OBSCURA_INLINE void start_clear_of_all(const SharedFaces* by_slot,
                                       const HitGeometry& g,
                                       const PathLanes& path,
                                       ShadingPoint& s) {
    const SharedLanes shared = read_shared_faces(by_slot, path.slot);
    if (none(shared.exist)) return;
    const Lanes none_more(0.0f);
    const auto more = [&](Lanes clear) {
        return select(shared.exist, max(clear - g.offset, none_more), none_more);
    };
    const Vec3<Lanes> back = s.ng * more(shared.reflected_clearance);
    s.start = s.start + back;
    s.light_start = s.light_start + back;
    s.transmitted_start = s.transmitted_start - s.ng * more(shared.transmitted_clearance);
}

/// Everything about the hits of one group. `wo` points to the viewer.
OBSCURA_INLINE ShadingPoint shading_point(const SceneView& scene,
                                          const HitLanes& hit,
                                          const PathLanes& path,
                                          const Reading& reading) {
    const SurfaceInteraction interaction =
        find_surface_interaction<HitUse::start_rays>(scene, hit, path, reading);
    const HitGeometry& g = interaction.g;
    const TextureFilter& filter = interaction.filter;
    const CommonTexel common = find_common_texel(scene, g, filter);
    const FoundSlots slots = find_slots(scene, g, filter, common);
    const Mask front = interaction.cos_front >= Lanes(0.0f);
    const FoundEmission emission = find_emission(scene, g, {filter, front, path.pdf > Lanes(0.0f)});

    ShadingPoint s;
    s.time = hit.time;
    const LanesI flags = g.material.integer<&Material::flags>();
    s.ng = interaction.ng;
    s.start = g.position + s.ng * g.offset;
    s.light_start = s.start + select(front, g.smooth_shift, splat3(Lanes(0.0f)));
    const LanesI layers_index = g.material.integer<&Material::layers>();
    const Mask layered = layers_index >= LanesI(0);
    const TangentLanes tangents = read_tangents(scene, hit, g, slots.normal.used | layered);
    s.normal = shading_normal(scene, interaction, tangents, slots.normal);
    s.frame = frame_around(bend_towards_viewer(s.normal, s.ng, interaction.wo));
    s.bsdf = bsdf_params(scene, g, filter, slots);
    const Vec3<Lanes> black = splat3(Lanes(0.0f));
    s.lobes = {Lanes(0.0f), Lanes(0.0f), black, black};
    if (!all(layered)) s.lobes = lobe_weights(s.bsdf, dot(s.frame.normal, interaction.wo));
    s.any_layers = any(layered);
    if (s.any_layers) {
        LayerContext context{tangents, s.frame, g.normal, s.ng, interaction.wo, front, layered};
        read_layered_point({scene, g, filter, path, hit.shared}, s.bsdf, context, s.layers);
        s.frame.tangent = select(layered, context.frame.tangent, s.frame.tangent);
        s.frame.bitangent = select(layered, context.frame.bitangent, s.frame.bitangent);
        s.transmitted_start = g.position - s.ng * g.offset;
        if (hit.shared != nullptr) start_clear_of_all(hit.shared, g, path, s);
    }
    if (scene.occludes) s.occlusion = read_occlusion(scene, g, filter);
    s.unlit = has_bits<Lanes>(flags, material_unlit);
    read_emission(scene, hit, g, emission, s);
    return s;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
