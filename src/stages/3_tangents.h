// stages/3_tangents.h - tangent frames at hits, and normal mapping.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_textures.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The directions in which texture coordinates grow, orthogonal to the smooth normal.
struct TangentLanes {
    Mask known;
    Vec3<Lanes> tangent, bitangent;
};

/// In  wanted: lanes that need tangents; for the others `known` is false
OBSCURA_INLINE TangentLanes read_tangents(const SceneView& scene,
                                          const HitLanes& hit,
                                          const HitGeometry& g,
                                          Mask wanted) {
    const LanesI base = g.primitive.integer<&Primitive::tangent_base>();
    TangentLanes out{wanted & (base != LanesI(no_attribute)), g.normal, g.normal};
    if (none(out.known)) return out;
    Vec3<Lanes> corners[3];
    Lanes handedness = Lanes(1.0f);
    for (int k = 0; k < 3; ++k) {
        const LanesI word = select(out.known, base + g.corner[k] * LanesI(4), LanesI(0));
        const Four<Lanes> words = read_corner(scene.attributes, word, g.one_triangle);
        corners[k] = {words.x, words.y, words.z};
        if (k == 0) handedness = words.w;
    }
    Vec3<Lanes> t = weighted(g, corners);
    const Mask instanced = out.known & (hit.instance >= LanesI(0));
    if (any(instanced)) {
        const TableRecord<Lanes, Instance> instance = instance_record(scene, hit);
        const InstanceMaps maps = instance_maps(scene, hit.instance, hit.time);
        Vec3<Lanes> moved = transform_vector(maps.world_from_object, t);
        if (scene.stretches) {  // as those of a mesh without an instance
            for (Vec3<Lanes>& corner : corners)
                corner = normalize(transform_vector(maps.world_from_object, corner));
            moved = weighted(g, corners);
        }
        t = select(instanced, moved, t);
        const Mask mirrored = instanced & (instance.integer<&Instance::mirrored>() != LanesI(0));
        handedness = select(mirrored, -handedness, handedness);
    }
    if (g.has_shapes) {
        t = select(g.shapes, g.dpdu, t);
        const Mask turned = dot(cross(g.normal, g.dpdu), g.dpdv) > Lanes(0.0f);
        handedness = select(g.shapes, select(turned, Lanes(-1.0f), Lanes(1.0f)), handedness);
    }
    out.tangent = normalize(t - g.normal * dot(t, g.normal));
    out.bitangent = cross(g.normal, out.tangent) * handedness;
    return out;
}

/// Applies a tangent-space texel to a normal; unusable texels leave it as it is.
OBSCURA_INLINE Vec3<Lanes> tilt_normal(const TangentLanes& tangents,
                                       Mask used,
                                       const Vec3<Lanes>& normal,
                                       const Vec3<Lanes>& texel,
                                       Lanes scale) {
    const Lanes x = (texel.x * Lanes(2.0f) - Lanes(1.0f)) * scale;
    const Lanes y = (texel.y * Lanes(2.0f) - Lanes(1.0f)) * scale;
    const Lanes z = texel.z * Lanes(2.0f) - Lanes(1.0f);
    const Vec3<Lanes> n = normalize(tangents.tangent * x + tangents.bitangent * y + normal * z);
    return select(used & tangents.known & (dot(n, n) > Lanes(0.5f)), n, normal);
}

/// Bends a normal until the mirror image of `wo` lies above the surface: no black fringes. However
/// far the normal is tilted away from the viewer, the image stays on the side that it is tilted to.
OBSCURA_INLINE Vec3<Lanes> bend_towards_viewer(const Vec3<Lanes>& n,
                                               const Vec3<Lanes>& ng,
                                               const Vec3<Lanes>& wo) {
    const Lanes facing = dot(n, wo);
    const Lanes height = Lanes(2.0f) * facing * dot(n, ng) - dot(wo, ng);
    const Lanes needed = min(Lanes(0.01f), dot(wo, ng) * Lanes(0.9f));
    const Mask bends = (height < needed) | (facing < Lanes(0.0f));
    const Vec3<Lanes> image = n * (Lanes(2.0f) * abs(facing)) - wo;
    const Vec3<Lanes> along = image - ng * dot(image, ng);
    const Lanes scale =
        sqrt((Lanes(1.0f) - needed * needed) / max(dot(along, along), Lanes(1e-12f)));
    return select(bends, normalize(wo + along * scale + ng * needed), n);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
