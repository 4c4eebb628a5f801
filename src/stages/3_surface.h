// stages/3_surface.h - from a hit to a shading point: position, normals, material with textures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_shape.h"
#include "surface/bsdf.h"
#include "surface/texture.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// How textures are read: one random texel, or exact bilinear for noise-free quantities.
enum class Filtering { stochastic, bilinear };

/// One UV set at the hits.
struct MeshUv {
    LanesI base;  ///< as Primitive::uv_base
    Vec2<Lanes> at;
    Lanes area2;  ///< twice the triangle's signed area in UV space
};

/// A hit's geometry in world space.
struct HitGeometry {
    TableRow<Lanes> primitive, material;
    LanesI corner[3];      ///< absolute vertex numbers
    Lanes weight[3];       ///< barycentric
    Vec3<Lanes> position;  ///< from the corners, not from the ray: error is bounded
    Vec3<Lanes> ng;        ///< geometric normal, unit, to the front
    Vec3<Lanes> normal;    ///< interpolated, unit, to the front
    Lanes offset;  ///< distance along ng at which rays start without hitting their own triangle
    Vec3<Lanes>
        smooth_shift;  ///< from position to the smooth surface, for shadow rays (toward the front)
    Lanes area2;       ///< twice the triangle's area
    MeshUv first_uv;   ///< of UV set 0, read where a texture may need it
    bool has_shapes = false;  ///< some lanes hit analytic shapes: their tangents are below
    Mask shapes;
    Vec3<Lanes> dpdu, dpdv;  ///< world space
};

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
    LanesI light;  ///< row in the triangle light table, -1: none
};

OBSCURA_INLINE Vec3<Lanes> weighted(const HitGeometry& g, const Vec3<Lanes> (&v)[3]) {
    return v[0] * g.weight[0] + v[1] * g.weight[1] + v[2] * g.weight[2];
}

/// Where the surface through the corners with their normals would be, relative to the flat
/// triangle: shadow rays that start there do not graze the facets. Source  Hanika, "Hacking the
/// Shadow Terminator", Ray Tracing Gems II, 2021, ch. 4
OBSCURA_INLINE Vec3<Lanes> smooth_surface_shift(const HitGeometry& g,
                                                const Vec3<Lanes> (&p)[3],
                                                const Vec3<Lanes> (&n)[3],
                                                const Vec3<Lanes>& position) {
    Vec3<Lanes> shift = splat3(Lanes(0.0f));
    for (int k = 0; k < 3; ++k) {
        const Vec3<Lanes> up = select(dot(n[k], g.ng) < Lanes(0.0f), -n[k], n[k]);
        // Only outwards: a corner whose tangent plane lies above the point.
        const Lanes below = min(dot(position - p[k], up), Lanes(0.0f));
        shift = shift - up * (below * g.weight[k]);
    }
    // A box with averaged normals is no sphere: never far from the triangle.
    const Lanes most = Lanes(0.05f) * sqrt(g.area2);
    return shift * min(Lanes(1.0f), most / max(length(shift), Lanes(1e-30f)));
}

OBSCURA_INLINE HitGeometry hit_geometry(const SceneView& scene, const HitLanes& hit) {
    HitGeometry g;
    g.primitive = {scene.primitives, hit.primitive, primitive_words};
    g.material = {scene.materials, g.primitive.integer(2), material_words};
    LanesI index_word = (g.primitive.integer(0) + hit.triangle) * LanesI(3);
    if (scene.shapes != nullptr) {
        g.shapes = g.primitive.integer(16) != LanesI(0);
        g.has_shapes = any(g.shapes);
        index_word = select(g.shapes, LanesI(0), index_word);  // any triangle: it is not looked at
    }
    Vec3<Lanes> p[3];
    for (int k = 0; k < 3; ++k) {
        g.corner[k] = gather<Lanes>(scene.indices + k, index_word);
        if (g.has_shapes) g.corner[k] = select(g.shapes, LanesI(0), g.corner[k]);
        p[k] = gather3(scene.positions, g.corner[k] * LanesI(3));
    }
    g.weight[0] = Lanes(1.0f) - hit.u - hit.v;
    g.weight[1] = hit.u;
    g.weight[2] = hit.v;
    g.position = weighted(g, p);
    const Vec3<Lanes> face = cross(p[1] - p[0], p[2] - p[0]);
    g.ng = normalize(face);
    g.normal = g.ng;
    g.smooth_shift = splat3(Lanes(0.0f));
    g.area2 = length(face);
    const LanesI normal_base = g.primitive.integer(3);
    const Mask smooth = normal_base != LanesI(no_attribute);
    if (any(smooth)) {
        Vec3<Lanes> n[3];
        for (int k = 0; k < 3; ++k) {
            const LanesI word = normal_base + g.corner[k] * LanesI(3);
            n[k] = gather3(scene.attributes, select(smooth, word, LanesI(0)));
        }
        g.normal = select(smooth, normalize(weighted(g, n)), g.ng);
        g.smooth_shift =
            select(smooth, smooth_surface_shift(g, p, n, g.position), splat3(Lanes(0.0f)));
    }
    // Rounding of the barycentric sum and of Embree's own arithmetic, 2^-24 each step.
    const Vec3<Lanes> size =
        abs(p[0]) * g.weight[0] + abs(p[1]) * g.weight[1] + abs(p[2]) * g.weight[2];
    const Lanes extent = max_component(max3(abs(p[1] - p[0]), abs(p[2] - p[0])));
    g.offset = Lanes(32.0f / 16777216.0f) * (dot(abs(g.ng), size) + extent * Lanes(0.25f));
    return g;
}

/// Moves the lanes that hit an instance from object space to world space.
OBSCURA_INLINE void instance_to_world(const SceneView& scene, const HitLanes& hit, HitGeometry& g) {
    const Mask instanced = hit.instance >= LanesI(0);
    if (none(instanced)) return;
    const TableRow<Lanes> instance = instance_row(scene, hit);
    const Affine<Lanes> world = read_affine(instance, 0);
    const Affine<Lanes> object = read_affine(instance, 12);
    const Vec3<Lanes> position = transform_point(world, g.position);
    const Vec3<Lanes> normal_scaled = transform_normal(object, g.ng);
    const Vec3<Lanes> ng = normalize(normal_scaled);
    // area' = area * |det| * |M^-T n|
    const Lanes area_scale = abs(determinant(world)) * length(normal_scaled);
    Vec3<Lanes> magnitude;  // |M| |p| + |translation|: what the sums below round against
    const Vec3<Lanes> p = abs(g.position);
    const auto row_size = [&](int r) {
        return abs(world.m[r][0]) * p.x + abs(world.m[r][1]) * p.y + abs(world.m[r][2]) * p.z +
               abs(world.m[r][3]);
    };
    magnitude = {row_size(0), row_size(1), row_size(2)};
    const auto column_length = [&](int c) {
        return length(Vec3<Lanes>{world.m[0][c], world.m[1][c], world.m[2][c]});
    };
    const Lanes stretch = column_length(0) + column_length(1) + column_length(2);
    const Lanes offset = g.offset * stretch + Lanes(32.0f / 16777216.0f) * dot(abs(ng), magnitude);
    g.normal = select(instanced, normalize(transform_normal(object, g.normal)), g.normal);
    g.smooth_shift = select(instanced, transform_vector(world, g.smooth_shift), g.smooth_shift);
    g.position = select(instanced, position, g.position);
    g.ng = select(instanced, ng, g.ng);
    g.offset = select(instanced, offset, g.offset);
    g.area2 = select(instanced, g.area2 * area_scale, g.area2);
}

/// A texture slot of the hit materials, with the coordinates of its UV set.
struct SlotLanes {
    Mask used;
    LanesI texture;
    Vec2<Lanes> uv;
    Lanes uv_area2;  ///< twice the triangle's area in the texture's UV space
};

/// `base`: as Primitive::uv_base; lanes without the attribute get anything.
OBSCURA_INLINE MeshUv read_mesh_uv(const SceneView& scene, const HitGeometry& g, LanesI base) {
    const Mask present = base != LanesI(no_attribute);
    Vec2<Lanes> uv[3];
    for (int k = 0; k < 3; ++k) {
        const LanesI word = select(present, base + g.corner[k] * LanesI(2), LanesI(0));
        uv[k] = {gather<Lanes>(scene.attributes, word), gather<Lanes>(scene.attributes + 1, word)};
    }
    const Vec2<Lanes> e1 = uv[1] - uv[0];
    const Vec2<Lanes> e2 = uv[2] - uv[0];
    return {base, uv[0] + e1 * g.weight[1] + e2 * g.weight[2], e1.x * e2.y - e1.y * e2.x};
}

/// Reads UV set 0, which most textures use, once for all of them.
OBSCURA_INLINE void read_first_uv_set(const SceneView& scene, HitGeometry& g) {
    const LanesI base = g.primitive.integer(6);
    const Mask textured =
        (max(g.material.integer(base_color_slot), g.material.integer(metallic_roughness_slot)) >=
         LanesI(0)) |
        (max(g.material.integer(normal_slot), g.material.integer(emissive_slot)) >= LanesI(0));
    g.first_uv = {LanesI(no_attribute), {Lanes(0.0f), Lanes(0.0f)}, Lanes(0.0f)};
    if (any(textured & (base != LanesI(no_attribute)))) g.first_uv = read_mesh_uv(scene, g, base);
}

OBSCURA_INLINE SlotLanes slot_lanes(const SceneView& scene, const HitGeometry& g, int slot) {
    SlotLanes s;
    s.texture = g.material.integer(slot);
    s.used = s.texture >= LanesI(0);
    if (none(s.used)) return s;
    const LanesI base = g.primitive.shared()
                            ? g.primitive.integer(6 + g.material.one_integer(slot + 1))
                            : g.primitive.varying_integer(g.material.integer(slot + 1) + LanesI(6));
    s.used = s.used & (base != LanesI(no_attribute));
    if (none(s.used)) return s;
    s.texture = select(s.used, s.texture, LanesI(0));
    const bool first = none(s.used & (base != g.first_uv.base));
    MeshUv mesh = first ? g.first_uv : read_mesh_uv(scene, g, base);
    if (g.has_shapes && !first) {
        mesh.at = {select(g.shapes, g.first_uv.at.x, mesh.at.x),
                   select(g.shapes, g.first_uv.at.y, mesh.at.y)};
        mesh.area2 = select(g.shapes, g.first_uv.area2, mesh.area2);
    }
    Lanes m[6];
    for (int k = 0; k < 6; ++k)
        m[k] = g.material.number(slot + 2 + k);
    const Vec2<Lanes>& at = mesh.at;
    s.uv = {m[0] * at.x + m[1] * at.y + m[2], m[3] * at.x + m[4] * at.y + m[5]};
    s.uv_area2 = abs(mesh.area2 * (m[0] * m[4] - m[1] * m[3]));
    return s;
}

/// What all look-ups at one hit share.
struct LookUp {
    Lanes footprint;  ///< world area of the ray's cone on the surface
    Vec3<Lanes> random;
    Filtering filtering;
};

OBSCURA_INLINE Rgba<Lanes> read_slot(const SceneView& scene,
                                     const HitGeometry& g,
                                     const SlotLanes& s,
                                     const LookUp& look) {
    const Lanes footprint = look.footprint * s.uv_area2 / max(g.area2, Lanes(1e-30f));
    if (look.filtering == Filtering::bilinear) {
        return sample_texture_bilinear<Lanes>(scene.textures, s.texture, s.uv, footprint);
    }
    return sample_texture_stochastic<Lanes>(
        scene.textures, s.texture, s.uv, footprint, look.random);
}

/// Bends a normal until the mirror image of `wo` lies above the surface: no black fringes.
OBSCURA_INLINE Vec3<Lanes> bend_towards_viewer(const Vec3<Lanes>& n,
                                               const Vec3<Lanes>& ng,
                                               const Vec3<Lanes>& wo) {
    const Vec3<Lanes> mirrored = n * (Lanes(2.0f) * dot(n, wo)) - wo;
    const Lanes height = dot(mirrored, ng);
    const Lanes needed = min(Lanes(0.01f), dot(wo, ng) * Lanes(0.9f));
    const Vec3<Lanes> raised = normalize(mirrored + ng * (needed - height));
    return select(height < needed, normalize(wo + raised), n);
}

OBSCURA_INLINE Vec3<Lanes> apply_normal_map(const SceneView& scene,
                                            const HitLanes& hit,
                                            const HitGeometry& g,
                                            const LookUp& look) {
    const SlotLanes slot = slot_lanes(scene, g, normal_slot);
    if (none(slot.used)) return g.normal;
    const LanesI tangent_base = g.primitive.integer(4);
    const Mask mapped = slot.used & (tangent_base != LanesI(no_attribute));
    Vec3<Lanes> tangent[3];
    Lanes handedness = Lanes(1.0f);
    for (int k = 0; k < 3; ++k) {
        const LanesI word = select(mapped, tangent_base + g.corner[k] * LanesI(4), LanesI(0));
        tangent[k] = gather3(scene.attributes, word);
        if (k == 0) handedness = gather<Lanes>(scene.attributes + 3, word);
    }
    Vec3<Lanes> t = weighted(g, tangent);
    const Mask instanced = mapped & (hit.instance >= LanesI(0));
    if (any(instanced)) {
        const TableRow<Lanes> instance = instance_row(scene, hit);
        t = select(instanced, transform_vector(read_affine(instance, 0), t), t);
        const Mask mirrored = instanced & (instance.integer(26) != LanesI(0));
        handedness = select(mirrored, -handedness, handedness);
    }
    if (g.has_shapes) {
        t = select(g.shapes, g.dpdu, t);
        const Mask turned = dot(cross(g.normal, g.dpdu), g.dpdv) > Lanes(0.0f);
        handedness = select(g.shapes, select(turned, Lanes(-1.0f), Lanes(1.0f)), handedness);
    }
    t = normalize(t - g.normal * dot(t, g.normal));
    const Vec3<Lanes> b = cross(g.normal, t) * handedness;
    const Rgba<Lanes> texel = read_slot(scene, g, slot, look);
    const Lanes scale = g.material.number(6);
    const Lanes x = (texel.rgb.x * Lanes(2.0f) - Lanes(1.0f)) * scale;
    const Lanes y = (texel.rgb.y * Lanes(2.0f) - Lanes(1.0f)) * scale;
    const Lanes z = texel.rgb.z * Lanes(2.0f) - Lanes(1.0f);
    const Vec3<Lanes> n = normalize(t * x + b * y + g.normal * z);
    return select(mapped & (dot(n, n) > Lanes(0.5f)), n, g.normal);
}

OBSCURA_INLINE Vec3<Lanes> base_color(const SceneView& scene,
                                      const HitGeometry& g,
                                      const LookUp& look) {
    Vec3<Lanes> color = read3(g.material, 0);
    const LanesI color_base = g.primitive.integer(5);
    const Mask colored = color_base != LanesI(no_attribute);
    if (any(colored)) {
        Vec3<Lanes> c[3];
        for (int k = 0; k < 3; ++k) {
            const LanesI word = select(colored, color_base + g.corner[k] * LanesI(4), LanesI(0));
            c[k] = gather3(scene.attributes, word);
        }
        color = select(colored, color * weighted(g, c), color);
    }
    const SlotLanes slot = slot_lanes(scene, g, base_color_slot);
    if (any(slot.used)) {
        color = select(slot.used, color * read_slot(scene, g, slot, look).rgb, color);
    }
    return color;
}

OBSCURA_INLINE BsdfParams<Lanes> bsdf_params(const SceneView& scene,
                                             const HitGeometry& g,
                                             const LookUp& look) {
    Lanes metallic = g.material.number(4);
    Lanes roughness = g.material.number(5);
    const SlotLanes slot = slot_lanes(scene, g, metallic_roughness_slot);
    if (any(slot.used)) {
        const Rgba<Lanes> texel = read_slot(scene, g, slot, look);
        roughness = select(slot.used, roughness * texel.rgb.y, roughness);
        metallic = select(slot.used, metallic * texel.rgb.z, metallic);
    }
    return {base_color(scene, g, look), metallic, max(roughness * roughness, Lanes(min_ggx_alpha))};
}

/// Everything about the hits of one group. `wo` points to the viewer.
OBSCURA_INLINE ShadingPoint shading_point(const SceneView& scene,
                                          const HitLanes& hit,
                                          const PathLanes& path,
                                          const Vec3<Lanes>& random,
                                          Filtering filtering) {
    HitGeometry g = hit_geometry(scene, hit);
    instance_to_world(scene, hit, g);
    read_first_uv_set(scene, g);
    shapes_to_world(scene, hit, path, g);
    const Vec3<Lanes> wo = -path.direction;
    const Lanes cos_front = dot(g.ng, wo);
    const Lanes width = path.cone_width + path.cone_spread * hit.t;
    // The cone's cross section on the slanted surface: geometric mean of its two widths.
    const LookUp look{width * width / max(abs(cos_front), Lanes(0.05f)), random, filtering};

    ShadingPoint s;
    const LanesI flags = g.material.integer(11);
    const Mask front = cos_front >= Lanes(0.0f);
    s.ng = select(front, g.ng, -g.ng);
    s.start = g.position + s.ng * g.offset;
    s.light_start = s.start + select(front, g.smooth_shift, splat3(Lanes(0.0f)));
    const Vec3<Lanes> n = apply_normal_map(scene, hit, g, look);
    s.normal = select(dot(n, s.ng) < Lanes(0.0f), -n, n);
    s.frame = frame_around(bend_towards_viewer(s.normal, s.ng, wo));
    s.bsdf = bsdf_params(scene, g, look);
    s.lobes = lobe_weights(s.bsdf, dot(s.frame.normal, wo));
    s.unlit = has_bits<Lanes>(flags, material_unlit);

    s.emission = read3(g.material, 8);
    const Mask emits = (max_component(s.emission) > Lanes(0.0f)) &
                       (front | has_bits<Lanes>(flags, material_double_sided)) & (!s.unlit);
    s.emission = select(emits, s.emission, splat3(Lanes(0.0f)));
    s.light = LanesI(-1);
    if (any(emits)) {
        const SlotLanes slot = slot_lanes(scene, g, emissive_slot);
        if (any(slot.used & emits)) {
            // Where light sampling may find the same light, both must see the same texels.
            LookUp sharp = look;
            sharp.footprint = select(path.pdf > Lanes(0.0f), Lanes(0.0f), look.footprint);
            s.emission =
                select(slot.used, s.emission * read_slot(scene, g, slot, sharp).rgb, s.emission);
        }
        const LanesI base = g.primitive.integer(15);
        LanesI light = base + hit.triangle;
        const Mask instanced = hit.instance >= LanesI(0);
        if (any(instanced)) {
            light = light + select(instanced, instance_row(scene, hit).integer(27), LanesI(0));
        }
        s.light = select(emits & (base >= LanesI(0)), light, LanesI(-1));
    }
    return s;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
