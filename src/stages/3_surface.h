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
    LanesI light;     ///< row in the triangle light table, -1: none
    Lanes time;       ///< of the hit, 0 when the shutter opens
    Lanes occlusion;  ///< where SceneView::occludes
    bool any_layers = false;
    LayeredPoint layers;       ///< where any_layers
    Vec3<Lanes> start_beyond;  ///< of rays that leave on the other side; where any_layers
};

/// The textures that every hit reads.
struct FoundSlots {
    FoundSlot normal, metallic_roughness, base_color;
};

OBSCURA_INLINE FoundSlots find_slots(const SceneView& scene,
                                     const HitGeometry& g,
                                     const LookUp& look) {
    const CommonTexel common = find_common_texel(scene, g, look);
    return {
        find_slot<&Material::normal_texture, Detail::single>(scene, g, g.material, look, common),
        find_slot<&Material::metallic_roughness_texture>(scene, g, g.material, look, common),
        find_slot<&Material::base_color_texture>(scene, g, g.material, look, common)};
}

/// A surface where a ray met it, and how the ray looks at it.
struct SeenSurface {
    HitGeometry g;
    Vec3<Lanes> wo;  ///< to the viewer
    Lanes cos_front;
    Vec3<Lanes> ng;  ///< on the viewer's side
    LookUp look;
};

template <HitUse use>
OBSCURA_INLINE SeenSurface see_surface(const SceneView& scene,
                                       const HitLanes& hit,
                                       const PathLanes& path,
                                       const Reading& reading) {
    SeenSurface seen;
    HitGeometry& g = seen.g;
    find_geometry<use>(scene, hit, g);
    instance_to_world(scene, hit, g);
    read_first_uv_set(scene, g);
    shapes_to_world(scene, hit, path, g);
    read_stroke_uv(scene, g);
    seen.wo = -path.direction;
    seen.cos_front = dot(g.ng, seen.wo);
    seen.ng = select(seen.cos_front >= Lanes(0.0f), g.ng, -g.ng);
    const Lanes width = path.cone_width + path.cone_spread * hit.t;
    // The cone's cross section on the slanted surface: geometric mean of its two widths.
    const Lanes area = width * width / max(abs(seen.cos_front), Lanes(0.05f));
    seen.look = {area * Lanes(reading.share), reading.random, reading.filtering};
    return seen;
}

/// The normal that the asset says, texture included, on the viewer's side.
OBSCURA_INLINE Vec3<Lanes> shading_normal(const SceneView& scene,
                                          const SeenSurface& seen,
                                          const TangentLanes& tangents,
                                          const FoundSlot& slot) {
    const HitGeometry& g = seen.g;
    Vec3<Lanes> n = g.normal;
    if (any(slot.used)) {
        const Rgba<Lanes> texel = read_slot(scene, g, slot, seen.look);
        const Lanes scale = g.material.number<&Material::normal_scale>();
        n = tilt_normal(tangents, slot.used, g.normal, texel.rgb, scale);
    }
    return select(dot(n, seen.ng) < Lanes(0.0f), -n, n);
}

OBSCURA_INLINE Vec3<Lanes> base_color(const SceneView& scene,
                                      const HitGeometry& g,
                                      const LookUp& look,
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
        color = select(slot.used, color * read_slot(scene, g, slot, look).rgb, color);
    }
    return color;
}

OBSCURA_INLINE BsdfParams<Lanes> bsdf_params(const SceneView& scene,
                                             const HitGeometry& g,
                                             const LookUp& look,
                                             const FoundSlots& slots) {
    Lanes metallic = g.material.number<&Material::metallic>();
    Lanes roughness = g.material.number<&Material::roughness>();
    const FoundSlot& slot = slots.metallic_roughness;
    if (any(slot.used)) {
        const Rgba<Lanes> texel = read_slot(scene, g, slot, look);
        roughness = select(slot.used, roughness * texel.rgb.y, roughness);
        metallic = select(slot.used, metallic * texel.rgb.z, metallic);
    }
    return {base_color(scene, g, look, slots.base_color),
            metallic,
            max(roughness * roughness, Lanes(min_ggx_alpha))};
}

/// How a ray looks at an emitter.
struct EmissionLook {
    const LookUp& look;
    Mask front;    ///< from its front
    Mask by_bsdf;  ///< with a direction that light sampling could have chosen too
};

/// What the surface sends out by itself, and which light that is.
///
/// In   s.unlit; front: lanes that are seen from their front
OBSCURA_INLINE void read_emission(const SceneView& scene,
                                  const HitLanes& hit,
                                  const HitGeometry& g,
                                  const EmissionLook& seen,
                                  ShadingPoint& s) {
    s.emission = g.material.vector<&Material::emission>();
    const LanesI flags = g.material.integer<&Material::flags>();
    const Mask emits = (max_component(s.emission) > Lanes(0.0f)) &
                       (seen.front | s.unlit | has_bits<Lanes>(flags, material_double_sided));
    s.emission = select(emits, s.emission, splat3(Lanes(0.0f)));
    s.light = LanesI(-1);
    if (any(emits)) {
        // Where light sampling may find the same light, both must see the same texels.
        LookUp sharp = seen.look;
        sharp.footprint = select(seen.by_bsdf, Lanes(0.0f), seen.look.footprint);
        const FoundSlot slot =
            find_slot<&Material::emissive_texture>(scene, g, g.material, sharp, {});
        if (any(slot.used & emits)) {
            s.emission =
                select(slot.used, s.emission * read_slot(scene, g, slot, sharp).rgb, s.emission);
        }
        const LanesI base = g.primitive.integer<&Primitive::light_base>();
        LanesI light = base + hit.triangle;
        const Mask instanced = hit.instance >= LanesI(0);
        if (any(instanced)) {
            const LanesI own = instance_row(scene, hit).integer<&Instance::light_base>();
            light = light + select(instanced, own, LanesI(0));
        }
        s.light = select(emits & (base >= LanesI(0)), light, LanesI(-1));
        if (s.any_layers) {
            // Where light sampling may find the same light, both take its view of the coat.
            const Mask coated = s.layers.layered & !(seen.by_bsdf & (s.light >= LanesI(0)));
            s.emission = select(coated, s.emission * s.layers.weights.below_coat, s.emission);
        }
    }
}

/// Rays start clear of all faces that lie where the hit is.
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
    const Vec3<Lanes> back = s.ng * more(shared.before);
    s.start = s.start + back;
    s.light_start = s.light_start + back;
    s.start_beyond = s.start_beyond - s.ng * more(shared.beyond);
}

/// Everything about the hits of one group. `wo` points to the viewer.
OBSCURA_INLINE ShadingPoint shading_point(const SceneView& scene,
                                          const HitLanes& hit,
                                          const PathLanes& path,
                                          const Reading& reading) {
    const SeenSurface seen = see_surface<HitUse::start_rays>(scene, hit, path, reading);
    const HitGeometry& g = seen.g;
    const LookUp& look = seen.look;
    const FoundSlots slots = find_slots(scene, g, look);

    ShadingPoint s;
    s.time = hit.time;
    const LanesI flags = g.material.integer<&Material::flags>();
    const Mask front = seen.cos_front >= Lanes(0.0f);
    s.ng = seen.ng;
    s.start = g.position + s.ng * g.offset;
    s.light_start = s.start + select(front, g.smooth_shift, splat3(Lanes(0.0f)));
    const LanesI layers_row = g.material.integer<&Material::layers>();
    const Mask layered = layers_row >= LanesI(0);
    const TangentLanes tangents = read_tangents(scene, hit, g, slots.normal.used | layered);
    s.normal = shading_normal(scene, seen, tangents, slots.normal);
    s.frame = frame_around(bend_towards_viewer(s.normal, s.ng, seen.wo));
    s.bsdf = bsdf_params(scene, g, look, slots);
    const Vec3<Lanes> black = splat3(Lanes(0.0f));
    s.lobes = {Lanes(0.0f), Lanes(0.0f), black, black};
    if (!all(layered)) s.lobes = lobe_weights(s.bsdf, dot(s.frame.normal, seen.wo));
    s.any_layers = any(layered);
    if (s.any_layers) {
        const Vec3<Lanes> smooth = select(dot(g.normal, s.ng) < Lanes(0.0f), -g.normal, g.normal);
        LayerPlace place{tangents, s.frame, smooth, s.ng, seen.wo, front, layered};
        read_layered_point({scene, g, look, path, hit.shared}, s.bsdf, place, s.layers);
        s.frame.tangent = select(layered, place.frame.tangent, s.frame.tangent);
        s.frame.bitangent = select(layered, place.frame.bitangent, s.frame.bitangent);
        s.start_beyond = g.position - s.ng * g.offset;
        if (hit.shared != nullptr) start_clear_of_all(hit.shared, g, path, s);
    }
    if (scene.occludes) s.occlusion = read_occlusion(scene, g, look);
    s.unlit = has_bits<Lanes>(flags, material_unlit);

    read_emission(scene, hit, g, {look, front, path.pdf > Lanes(0.0f)}, s);
    return s;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
