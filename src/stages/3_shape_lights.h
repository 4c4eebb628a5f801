// stages/3_shape_lights.h - next-event estimation towards emissive shapes, and its density.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_view.h"
#include "light/shape_light.h"
#include "stages/3_light_alpha.h"
#include "stages/column_lanes.h"
#include "surface/texture.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A point on one chosen light.
struct ShapeLightLanes {
    Vec3<Lanes> direction;
    Lanes distance;  ///< ends before the light itself
    Vec3<Lanes> emission;
    Lanes pdf;  ///< 1/sr, choice included
};

OBSCURA_INLINE TableRecord<Lanes, ShapeLight> shape_light_record(const SceneView& scene,
                                                                 LanesI index) {
    return {scene.lights.shapes, index};
}

/// In      index: into the shape light table; from: where rays to lights start
inline __attribute__((noinline)) void sample_shape_lights(const SceneView& scene,
                                                          const LanesI& index,
                                                          const Vec2<Lanes>& u,
                                                          const Vec3<Lanes>& from,
                                                          ShapeLightLanes& out) {
    const TableRecord<Lanes, ShapeLight> record = shape_light_record(scene, index);
    const ShapeLightSample<Lanes> s = sample_shape_light(read_shape_light(record), u, from);
    out.emission = light_vector<&ShapeLight::emission>(record);
    const LanesI texture = record.integer<&ShapeLight::texture>();
    const Mask textured = texture >= LanesI(0);
    if (any(textured)) {
        const auto m = [&](int k) { return record.number<&ShapeLight::uv_from_shape>(k); };
        const Vec2<Lanes> uv{m(0) * s.uv.x + m(1) * s.uv.y + m(2),
                             m(3) * s.uv.x + m(4) * s.uv.y + m(5)};
        const Rgba<Lanes> texel = sample_texture_bilinear<Lanes>(
            scene.textures, select(textured, texture, LanesI(0)), uv, Lanes(0.0f));
        out.emission = select(textured, out.emission * texel.rgb, out.emission);
    }
    if (scene.lights.alphas != nullptr) {
        const LanesI alpha = record.integer<&ShapeLight::alpha>();
        const Vec2<Lanes> uv = s.uv;  // only a copy has an address
        out.emission = out.emission * sampled_light_alpha(scene, alpha, uv);
    }
    const Lanes size = dot(abs(s.normal), abs(s.point) + abs(from));
    const Lanes clear = Lanes(32.0f / 16777216.0f) * (size + s.distance * Lanes(0.25f));
    const Lanes cosine = abs(dot(s.normal, s.direction));
    const Lanes coat = record.number<&ShapeLight::coat>();
    out.emission = out.emission * coat_transmittance<Lanes>(coat, cosine);
    out.direction = s.direction;
    out.distance = max(s.distance - clear / max(cosine, Lanes(0.02f)), Lanes(0.0f));
    out.pdf = s.pdf * record.number<&ShapeLight::select>();
}

/// Density with which light sampling would have chosen a direction that hit a shape light; `other`
/// where it hit none.
///
/// In      light: as ShadingPoint::light; path, distance_and_other.x: the ray that hit it, and its
///         length; ng: faces the ray; distance_and_other.y: `other'
inline __attribute__((noinline)) Lanes shape_light_pdf(const SceneView& scene,
                                                       const LanesI& light,
                                                       const PathLanes& path,
                                                       const Vec3<Lanes>& ng,
                                                       const Vec2<Lanes>& distance_and_other) {
    const LanesI index = light - LanesI(scene.lights.triangle_count);
    const Mask known = index >= LanesI(0);
    const Lanes other = distance_and_other.y;
    if (none(known)) return other;
    const TableRecord<Lanes, ShapeLight> record =
        shape_light_record(scene, select(known, index, LanesI(0)));
    ShapeLightValues<Lanes> read = read_shape_light(record);
    read.two_sided = Mask(true);  // the caller has tested the side: the normal faces the ray
    const Lanes cosine = abs(dot(ng, path.direction));
    const Lanes pdf = shape_light_density(read, path.origin, distance_and_other.x, cosine);
    return select(known, pdf * record.number<&ShapeLight::select>(), other);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
