// stages/3_lights.h - next-event estimation: one light per shading point, by MIS with the BSDF.
// SPDX-License-Identifier: Apache-2.0
//
// Light selection: a light is drawn by its power from a CDF (render/light_table.h,
// light/cdf_table.h), wherever the shading point lies. Among many lights, the CDF draws the light
// tree as one (light/light_tree.h), which then chooses by where the point is.
#pragma once

#include "light/cdf_table.h"
#include "light/environment.h"
#include "light/punctual_sample.h"
#include "light/record_words.h"
#include "light/triangle_light.h"
#include "stages/3_light_alpha.h"
#include "stages/3_light_tree.h"
#include "stages/3_moving_lights.h"
#include "stages/3_shape_lights.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Weight of a strategy of density `own` against one of density `other`; 1 where `other` is 0.
/// Source  Veach, PhD thesis, 1997, section 9.2.4: the power heuristic, exponent 2
OBSCURA_INLINE Lanes mis_weight(Lanes own, Lanes other) {
    const Lanes ratio = other / max(own, Lanes(1e-30f));
    return Lanes(1.0f) / (Lanes(1.0f) + ratio * ratio);
}

/// Light from one chosen direction.
struct LightLanes {
    Vec3<Lanes> direction;
    Lanes distance;
    Vec3<Lanes> radiance_over_pdf;  ///< estimate before BSDF, cosine and MIS
    Lanes pdf;                      ///< 1/sr, choice included; 0: the light has no extent
    Mask valid;
};

/// True for the environment, the only light at infinity with an extent.
OBSCURA_INLINE Mask is_environment(const LightLanes& light) {
    return (light.pdf > Lanes(0.0f)) & (light.distance >= Lanes(directional_distance_m));
}

OBSCURA_INLINE void choose(LightLanes& out, Mask m, const LightLanes& in) {
    out.direction = select(m, in.direction, out.direction);
    out.distance = select(m, in.distance, out.distance);
    out.radiance_over_pdf = select(m, in.radiance_over_pdf, out.radiance_over_pdf);
    out.pdf = select(m, in.pdf, out.pdf);
    out.valid = (m & in.valid) | ((!m) & out.valid);
}

OBSCURA_INLINE LightLanes sample_triangle_lights(const SceneView& scene,
                                                 LanesI index,
                                                 const Vec2<Lanes>& u,
                                                 const ShadingPoint& point,
                                                 const Vec3<Lanes>& random) {
    const TriangleLight* lights = scene.lights.triangles;
    TriangleCorners<Lanes> corners = read_corners<Lanes>(lights, index);
    if (scene.lights.moving_triangles != nullptr) {
        corners = moved_light_corners(scene, index, point.time, corners);
    }
    const TriangleLightSample<Lanes> s =
        sample_triangle_light<Lanes>(lights, index, corners, u, point.light_start);
    Vec3<Lanes> emission = s.emission;
    const Mask textured = s.texture >= LanesI(0);
    if (any(textured)) {
        const LanesI texture = select(textured, s.texture, LanesI(0));
        const Rgba<Lanes> texel =
            sample_texture_stochastic<Lanes>(scene.textures, texture, s.uv, Lanes(0.0f), random);
        emission = select(textured, emission * texel.rgb, emission);
    }
    if (scene.lights.alphas != nullptr) {
        const TableRecord<Lanes, TriangleLight> record(lights, index);
        const Vec2<Lanes> weight = s.weight;  // only a copy has an address
        emission =
            emission * sampled_light_alpha(scene, record.integer<&TriangleLight::alpha>(), weight);
    }
    // End before the light's own triangle by the rounding error and no more: geometry that covers
    // the light closely must still be hit.
    const Lanes size = dot(abs(s.normal), abs(s.point) + abs(point.light_start));
    const Lanes clear = Lanes(32.0f / 16777216.0f) * (size + s.distance * Lanes(0.25f));
    const Lanes distance = max(s.distance - clear / max(abs(s.cosine), Lanes(0.02f)), Lanes(0.0f));
    return {s.direction,
            distance,
            emission * (Lanes(1.0f) / max(s.pdf, Lanes(1e-30f))),
            s.pdf,
            s.pdf > Lanes(0.0f)};
}

OBSCURA_INLINE LightLanes sample_shapes(const SceneView& scene,
                                        LanesI index,
                                        const Vec2<Lanes>& u,
                                        const ShadingPoint& point) {
    ShapeLightLanes s;
    sample_shape_lights(scene, index, u, point.light_start, s);
    return {s.direction,
            s.distance,
            s.emission * (Lanes(1.0f) / max(s.pdf, Lanes(1e-30f))),
            s.pdf,
            s.pdf > Lanes(0.0f)};
}

/// A light for each lane, drawn ahead of the point that it lights, and where on it to sample.
struct LightDraw {
    LanesI light;                  ///< number, see LightView; that after all lights: the tree
    Vec2<Lanes> place;             ///< in [0, 1)^2; for lights other than the environment
    Lanes probability;             ///< of the choice by the tree; where there is one
    LanesU random;                 ///< that chose the light; likewise
    PixelDraw<Lanes> environment;  ///< in lanes whose light is the environment
};

OBSCURA_INLINE Mask is_environment(const SceneView& scene, LanesI light) {
    return Mask(scene.lights.environment_select > 0) & (light == LanesI(scene.lights.count - 1));
}

/// Chooses the lights, by their power, and the environment's block. One pair of random numbers
/// chooses the light and the place on it: what the choice leaves of the first number is as well
/// stratified as the number was, so that a few lights, or the triangles of one, are sampled as
/// evenly as a single light. Where there is a tree, draw_light_of_tree must follow.
///
/// In      lights: at least one
OBSCURA_INLINE LightDraw draw_light(const SceneView& scene, const Vec2<LanesU>& random) {
    const LightView& lights = scene.lights;
    const bool has_tree = lights.tree.nodes != nullptr;
    const bool is_choice = lights.count > 1;
    LightDraw draw;
    draw.random = random.x;
    draw.place = unit_pair<Lanes>(random);
    draw.light = LanesI(lights.count - 1);
    if (is_choice) {
        const int choices = has_tree ? lights.count + 1 : lights.count;
        const CdfDraw<Lanes> drawn = draw_cdf<Lanes>(lights.choice, choices, random.x);
        draw.light = drawn.index;
        draw.place.x = drawn.place;
    }
    if (none(is_environment(scene, draw.light))) return draw;
    Vec2<LanesU> left = random;
    if (is_choice) left.x = spread_random(lights.environment_spread, random.x, random.y);
    draw.environment = draw_block<Lanes>(scene.environment.choice, left);
    return draw;
}

/// Chooses a light for the lanes that have drawn the tree.
///
/// In      needed: lanes that sample a light; elsewhere the light is any
OBSCURA_INLINE void draw_light_of_tree(const SceneView& scene,
                                       const LitPoint<Lanes>& at,
                                       Mask needed,
                                       LightDraw& draw) {
    const LightView& lights = scene.lights;
    const Mask by_tree = draw.light == LanesI(lights.count);
    const Mask descends = by_tree & needed;
    const LitPoint<Lanes> here = at;  // only copies have an address
    const LanesU random = draw.random;
    LightTreeDraw<Lanes> found;
    choose_from_tree(lights.tree, here, random, descends, found);
    draw.light = select(by_tree, found.light, draw.light);
    draw.place.x = select(by_tree, found.place, draw.place.x);
    draw.probability = select(by_tree, found.probability, Lanes(1.0f));
}

/// Chooses the environment's pixel, and prefetches it.
OBSCURA_INLINE void draw_light_pixel(const SceneView& scene, LightDraw& draw) {
    if (none(is_environment(scene, draw.light))) return;
    draw_environment_pixel(scene.environment, draw.environment);
}

/// Divides by the probability of the tree's choice.
OBSCURA_INLINE void weigh_by_tree(const LightDraw& draw, LightLanes& light) {
    const Lanes likely = max(draw.probability, Lanes(1e-30f));
    light.radiance_over_pdf = light.radiance_over_pdf * (Lanes(1.0f) / likely);
    light.pdf = light.pdf * draw.probability;
    light.valid = light.valid & (draw.probability > Lanes(0.0f));
}

/// The light that every lane has drawn, at a point on it.
///
/// In      texture: uniform random numbers that choose a texel
OBSCURA_INLINE LightLanes sample_light(const SceneView& scene,
                                       const ShadingPoint& point,
                                       const LightDraw& draw,
                                       const Vec3<Lanes>& texture) {
    const LightView& lights = scene.lights;
    LightLanes out{splat3(Lanes(0.0f)), Lanes(0.0f), splat3(Lanes(0.0f)), Lanes(0.0f), Mask(false)};
    const LanesI index = draw.light;
    const Mask punctual = index < LanesI(lights.punctual_count);
    const LanesI triangle_index = index - LanesI(lights.punctual_count);
    const Mask triangle = (!punctual) & (triangle_index < LanesI(lights.triangle_count));
    const LanesI shape_index = triangle_index - LanesI(lights.triangle_count);
    const Mask shape = (shape_index >= LanesI(0)) & (shape_index < LanesI(lights.shape_count));
    const Mask environment = !(punctual | triangle | shape);
    if (scene.has_environment && any(environment)) {
        const EnvironmentSample<Lanes> s =
            finish_environment_draw(scene.environment, draw.environment);
        const Lanes pdf = s.pdf * Lanes(lights.environment_select);
        choose(out,
               environment,
               {s.direction,
                Lanes(directional_distance_m),
                s.radiance * (Lanes(1.0f) / max(pdf, Lanes(1e-30f))),
                pdf,
                pdf > Lanes(0.0f)});
    }
    if (any(triangle)) {
        choose(out,
               triangle,
               sample_triangle_lights(
                   scene, select(triangle, triangle_index, LanesI(0)), draw.place, point, texture));
    }
    if (any(shape)) {
        const LanesI in_range = select(shape, shape_index, LanesI(0));
        choose(out, shape, sample_shapes(scene, in_range, draw.place, point));
    }
    if (any(punctual)) {
        const LanesI in_range = select(punctual, index, LanesI(0));
        PunctualSample<Lanes> s;
        if (lights.moving_punctual != nullptr) {
            sample_moving_punctual(scene, in_range, point.time, point.light_start, s);
        } else {
            s = sample_punctual<Lanes>(
                lights.punctual, in_range, point.light_start, lights.profiles);
        }
        const Lanes select_pdf = gather<Lanes>(lights.select_pdf, in_range);
        choose(out,
               punctual,
               {s.direction,
                s.distance,
                s.irradiance * (Lanes(1.0f) / select_pdf),
                Lanes(0.0f),
                max_component(s.irradiance) > Lanes(0.0f)});
    }
    if (lights.tree.nodes != nullptr) weigh_by_tree(draw, out);
    return out;
}

struct PlaceAndTime {
    Vec3<Lanes> place;
    Lanes time;
};

/// As sample_light, from another place. Apart from it, for few paths need both.
inline __attribute__((noinline)) LightLanes sample_light_from(const SceneView& scene,
                                                              const PlaceAndTime& from,
                                                              const LightDraw& draw,
                                                              const Vec3<Lanes>& texture) {
    ShadingPoint point;
    point.light_start = from.place;
    point.time = from.time;
    return sample_light(scene, point, draw, texture);
}

/// Transmittance of an emitter's coat as light sampling computes it: without the coat's texture and
/// normal map. Lanes whose `light` is -1 get 1.
OBSCURA_INLINE Lanes sampled_coat_transmittance(const SceneView& scene,
                                                LanesI light,
                                                Lanes cosine) {
    const LanesI shape = light - LanesI(scene.lights.triangle_count);
    const Mask is_triangle = (light >= LanesI(0)) & (shape < LanesI(0));
    const Mask is_shape = shape >= LanesI(0);
    Lanes coat(0.0f);
    if (any(is_triangle)) {
        const auto* words =
            member_words<float>(scene.lights.triangles, offsetof(TriangleLight, coat));
        const LanesI in_range = select(is_triangle, light, LanesI(0));
        const Lanes read = gather<Lanes>(words, in_range * LanesI(words_per_record<TriangleLight>));
        coat = select(is_triangle, read, coat);
    }
    if (any(is_shape)) {
        const auto* words = member_words<float>(scene.lights.shapes, offsetof(ShapeLight, coat));
        const LanesI in_range = select(is_shape, shape, LanesI(0));
        const Lanes read = gather<Lanes>(words, in_range * LanesI(words_per_record<ShapeLight>));
        coat = select(is_shape, read, coat);
    }
    return coat_transmittance<Lanes>(coat, cosine);
}

/// Density with which sample_light would have chosen the emitter that a BSDF ray hit: `point`.
OBSCURA_INLINE Lanes light_pdf(const SceneView& scene,
                               const ShadingPoint& point,
                               const Vec3<Lanes>& direction,
                               Lanes distance) {
    const LanesI light = point.light;
    const Mask known = (light >= LanesI(0)) & (light < LanesI(scene.lights.triangle_count));
    if (none(known) || scene.lights.triangle_count == 0) return Lanes(0.0f);
    const LanesI in_range = select(known, light, LanesI(0));
    Lanes pdf_area = gather<Lanes>(
        member_words<float>(scene.lights.triangles, offsetof(TriangleLight, pdf_area)),
        in_range * LanesI(words_per_record<TriangleLight>));
    if (scene.lights.moving_triangles != nullptr) {
        const auto still = read_corners<Lanes>(scene.lights.triangles, in_range);
        pdf_area = moved_light_corners(scene, in_range, point.time, still).pdf_area;
    }
    const Lanes pdf = solid_angle_pdf<Lanes>(pdf_area, distance, abs(dot(point.ng, direction)));
    return select(known, pdf, Lanes(0.0f));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
