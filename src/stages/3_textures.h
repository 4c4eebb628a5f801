// stages/3_textures.h - texture look-ups at the hits: UV coordinates, texels, values.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_geometry.h"
#include "surface/texture.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// How textures are read: one random texel, or exact bilinear for noise-free AOVs.
enum class Filtering { stochastic, bilinear };

/// How the textures at hits are read.
struct Reading {
    Filtering filtering;
    Vec3<Lanes> random;  ///< for Filtering::stochastic
    float fraction = 1;  ///< fraction of the ray cone's area that one look-up stands for
};

/// A texture slot of the hit materials, with the coordinates of its UV set.
struct SlotLanes {
    Mask used;
    LanesI texture;
    Vec2<Lanes> uv;
    Lanes uv_area2;  ///< twice the triangle's area in the texture's UV space
};

/// The texture in a slot of the record, -1: none.
template <auto slot, typename Record>
OBSCURA_INLINE LanesI texture_of(const TableRecord<Lanes, Record>& record) {
    return record.template integer<slot, &TextureSlot::texture>();
}

/// `base`: as Primitive::uv_base; lanes without the attribute get anything.
OBSCURA_INLINE MeshUv read_mesh_uv(const SceneView& scene, const HitGeometry& g, LanesI base) {
    const Mask present = base != LanesI(no_attribute);
    Vec2<Lanes> uv[3];
    for (int k = 0; k < 3; ++k) {
        const LanesI word = select(present, base + g.corner[k] * LanesI(2), LanesI(0));
        const Four<Lanes> words = read_corner(scene.attributes, word, g.one_triangle);
        uv[k] = {words.x, words.y};
    }
    const Vec2<Lanes> e1 = uv[1] - uv[0];
    const Vec2<Lanes> e2 = uv[2] - uv[0];
    return {base, uv[0] + e1 * g.weight[1] + e2 * g.weight[2], e1.x * e2.y - e1.y * e2.x};
}

/// The UV set of lanes that hit triangles; others have no corners yet.
OBSCURA_INLINE LanesI mesh_uv_base(const HitGeometry& g, LanesI base) {
    return g.has_shapes ? select(g.shapes, LanesI(no_attribute), base) : base;
}

/// UV set 0 of points and lines, whose vertices are known after shapes_to_world.
OBSCURA_INLINE void read_points_lines_uv(const SceneView& scene, HitGeometry& g) {
    if (!g.has_shapes) return;
    const Mask points_lines =
        g.shapes & (g.primitive.integer<&Primitive::tangent_base>() == LanesI(no_attribute));
    if (none(points_lines)) return;
    const LanesI base = g.primitive.integer<&Primitive::uv_base>();
    const MeshUv uv = read_mesh_uv(scene, g, select(points_lines, base, LanesI(no_attribute)));
    g.first_uv.base = select(points_lines, uv.base, g.first_uv.base);
    g.first_uv.at = {select(points_lines, uv.at.x, g.first_uv.at.x),
                     select(points_lines, uv.at.y, g.first_uv.at.y)};
    g.first_uv.area2 = select(points_lines, uv.area2, g.first_uv.area2);
}

/// Reads UV set 0, which most textures use, once for all of them.
OBSCURA_INLINE void read_first_uv_set(const SceneView& scene, HitGeometry& g) {
    const LanesI base = mesh_uv_base(g, g.primitive.integer<&Primitive::uv_base>());
    const Mask textured =
        (max(texture_of<&Material::base_color_texture>(g.material),
             texture_of<&Material::metallic_roughness_texture>(g.material)) >= LanesI(0)) |
        (max(texture_of<&Material::normal_texture>(g.material),
             texture_of<&Material::emissive_texture>(g.material)) >= LanesI(0));
    g.first_uv = {LanesI(no_attribute), {Lanes(0.0f), Lanes(0.0f)}, Lanes(0.0f)};
    if (any(textured & (base != LanesI(no_attribute)))) g.first_uv = read_mesh_uv(scene, g, base);
}

/// The coordinates of a slot, for a texture that need not be the slot's own.
///
/// In  slot: a TextureSlot of the record
template <auto slot, typename Record>
OBSCURA_INLINE SlotLanes slot_lanes(const SceneView& scene,
                                    const HitGeometry& g,
                                    const TableRecord<Lanes, Record>& record,
                                    LanesI texture) {
    SlotLanes s;
    s.texture = texture;
    s.used = s.texture >= LanesI(0);
    if (none(s.used)) return s;
    constexpr auto set = &TextureSlot::uv_set;
    const LanesI base =
        g.primitive.shared()
            ? g.primitive.integer<&Primitive::uv_base>(record.template one_integer<slot, set>())
            : g.primitive.varying_integer<&Primitive::uv_base>(
                  record.template integer<slot, set>());
    s.used = s.used & (base != LanesI(no_attribute));
    if (none(s.used)) return s;
    s.texture = select(s.used, s.texture, LanesI(0));
    const bool first = none(s.used & (base != g.first_uv.base));
    MeshUv mesh = first ? g.first_uv : read_mesh_uv(scene, g, base);
    if (g.has_shapes && !first) {
        const Mask known = g.shapes & (base == g.first_uv.base);
        mesh.at = {select(known, g.first_uv.at.x, mesh.at.x),
                   select(known, g.first_uv.at.y, mesh.at.y)};
        mesh.area2 = select(known, g.first_uv.area2, mesh.area2);
    }
    // The transform's six words end the slot: two of them are read twice.
    constexpr auto matrix = &TextureSlot::uv_from_mesh;
    const Four<Lanes> first_four = record.template four_numbers<slot, matrix>(0);
    const Four<Lanes> last_four = record.template four_numbers<slot, matrix>(2);
    const Vec3<Lanes> u_row{first_four.x, first_four.y, first_four.z};
    const Vec3<Lanes> v_row{first_four.w, last_four.z, last_four.w};
    const Vec2<Lanes>& at = mesh.at;
    s.uv = {u_row.x * at.x + u_row.y * at.y + u_row.z, v_row.x * at.x + v_row.y * at.y + v_row.z};
    s.uv_area2 = abs(mesh.area2 * (u_row.x * v_row.y - u_row.y * v_row.x));
    return s;
}

/// The texture filter context that all look-ups at one hit share.
struct TextureFilter {
    Lanes footprint;  ///< world area of the ray's cone on the surface
    Vec3<Lanes> random;
    Filtering filtering;
};

OBSCURA_INLINE Lanes texture_footprint(const HitGeometry& g,
                                       const SlotLanes& s,
                                       const TextureFilter& filter) {
    return filter.footprint * s.uv_area2 / max(g.area2, Lanes(1e-30f));
}

/// A slot whose texel address is known and prefetched: all slots of a hit are found before any is
/// read.
struct FoundSlot {
    Mask used;
    SlotLanes lanes;   ///< for Filtering::bilinear, unless `common` is set
    LanesU texel;      ///< index in the arena; of the texture's first one if `common` is set
    LanesI low_plane;  ///< of its texture
    Mask srgb;
    const BilinearTexels<Lanes>* common = nullptr;  ///< of CommonTexel, for Filtering::bilinear
};

/// Which texel stands for a footprint. mean: a texel of the mip level that matches the footprint's
/// size. single: a texel of level 0 inside the footprint, for normal maps: averaged normals would
/// make minified surfaces smoother.
enum class Detail { mean, single };

/// The texels that all textures of a material with material_textures_alike share; found once, and
/// counted from the start of a texture.
struct CommonTexel {
    bool usable = false;             ///< all lanes have such a material
    Mask used;                       ///< and texture coordinates
    LanesI mean, single;             ///< for Filtering::stochastic, by Detail
    BilinearTexels<Lanes> bilinear;  ///< for Filtering::bilinear
};

OBSCURA_INLINE CommonTexel find_common_texel(const SceneView& scene,
                                             const HitGeometry& g,
                                             const TextureFilter& filter) {
    CommonTexel common;
    if (!all(has_bits<Lanes>(g.material.integer<&Material::flags>(), material_textures_alike)))
        return common;
    // Absent slots have texture -1, and the coordinates of the others.
    const LanesI normal = texture_of<&Material::normal_texture>(g.material);
    const LanesI texture = max(max(texture_of<&Material::base_color_texture>(g.material),
                                   texture_of<&Material::metallic_roughness_texture>(g.material)),
                               normal);
    const SlotLanes s = slot_lanes<&Material::base_color_texture>(scene, g, g.material, texture);
    if (none(s.used)) return common;
    const TextureInfo<Lanes> info = texture_info<Lanes>(scene.textures, s.texture);
    const Lanes footprint = texture_footprint(g, s, filter);
    const LanesI start = info.record.integer<&TextureRecord::level_offset>();
    common.usable = true;
    common.used = s.used;
    if (filter.filtering == Filtering::bilinear) {
        common.bilinear = bilinear_texels<Lanes>(info, s.uv, footprint);
        common.bilinear.upper = common.bilinear.upper - start;
        common.bilinear.lower = common.bilinear.lower - start;
        return common;
    }
    const LanesI mean = stochastic_texel<Lanes>(info, s.uv, footprint, filter.random);
    LanesI single = mean;
    if (any(normal >= LanesI(0))) {
        single = stochastic_single_texel<Lanes>(info, s.uv, footprint, filter.random);
    }
    common.mean = mean - start;
    common.single = single - start;
    return common;
}

/// Finds what a slot reads, and asks for its memory.
///
/// In  slot: a TextureSlot of the record; common: of the core material's record, or none. It must
///     outlive what is returned
template <auto slot, Detail detail = Detail::mean, typename Record>
OBSCURA_INLINE FoundSlot find_slot(const SceneView& scene,
                                   const HitGeometry& g,
                                   const TableRecord<Lanes, Record>& material,
                                   const TextureFilter& filter,
                                   const CommonTexel& common) {
    FoundSlot found;
    const LanesI texture = texture_of<slot>(material);
    if (common.usable) {
        found.used = common.used & (texture >= LanesI(0));
        if (none(found.used)) return found;
        const TableRecord<Lanes, TextureRecord> record(scene.textures.records,
                                                       select(found.used, texture, LanesI(0)));
        LanesI texel = record.integer<&TextureRecord::level_offset>();
        if (filter.filtering == Filtering::bilinear) {
            found.common = &common.bilinear;
        } else {
            texel = texel + (detail == Detail::mean ? common.mean : common.single);
        }
        found.texel = as_uint(select(found.used, texel, LanesI(0)));
        found.srgb = has_bits<Lanes>(record.integer<&TextureRecord::sampler>(), sampler_srgb);
        found.low_plane = low_plane_of(scene.textures, record);
        if (filter.filtering == Filtering::bilinear) return found;
    } else {
        found.lanes = slot_lanes<slot>(scene, g, material, texture);
        found.used = found.lanes.used;
        if (none(found.used) || filter.filtering == Filtering::bilinear) return found;
        const TextureInfo<Lanes> info = texture_info<Lanes>(scene.textures, found.lanes.texture);
        const Lanes footprint = texture_footprint(g, found.lanes, filter);
        found.texel = as_uint(
            detail == Detail::mean
                ? stochastic_texel<Lanes>(info, found.lanes.uv, footprint, filter.random)
                : stochastic_single_texel<Lanes>(info, found.lanes.uv, footprint, filter.random));
        found.srgb = has_bits<Lanes>(info.sampler, sampler_srgb);
        found.low_plane = low_plane_of(scene.textures, info.record);
    }
    prefetch<Lanes>(scene.textures.texels, as_int(found.texel));
    return found;
}

OBSCURA_INLINE Rgba<Lanes> read_slot(const SceneView& scene,
                                     const HitGeometry& g,
                                     const FoundSlot& found,
                                     const TextureFilter& filter) {
    if (filter.filtering == Filtering::bilinear) {
        if (found.common != nullptr) {
            return read_bilinear<Lanes>(
                scene.textures, *found.common, as_int(found.texel), found.low_plane, found.srgb);
        }
        return sample_texture_bilinear<Lanes>(scene.textures,
                                              found.lanes.texture,
                                              found.lanes.uv,
                                              texture_footprint(g, found.lanes, filter));
    }
    return read_texel<Lanes>(scene.textures, as_int(found.texel), found.low_plane, found.srgb);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
