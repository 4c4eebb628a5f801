// stages/3_wireframe.cpp - stage 3 for --integrator wireframe: how close a ray passes to an edge.
// SPDX-License-Identifier: Apache-2.0
#include "stages/1_camera.h"
#include "stages/3_shade.h"
#include "stages/3_textures.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

struct FilmRay {
    Vec3<Lanes> origin, direction;
};

/// The rays half a pixel to the left, right, above and below of a group's own.
struct RaysAround {
    FilmRay left, right, above, below;
};

/// The neighbouring rays use the same cube face and the same eye as the pixel.
template <typename Maker>
void find_rays_around(const BatchSettings& batch, int i, RaysAround& out) {
    const FilmScale scale(batch);
    const LanesI x = load(batch.pixel_x + i);
    const LanesI y = load(batch.pixel_y + i);
    const Lanes offset_x(batch.film_offset_px[0]);
    const Lanes offset_y(batch.film_offset_px[1]);
    const Lanes half(0.5f);
    const Vec2<Lanes> own = scale(x, y, {offset_x, offset_y});
    const auto at = [&](Lanes step_x, Lanes step_y) -> FilmRay {
        const Vec2<Lanes> film = scale(x, y, {offset_x + step_x, offset_y + step_y});
        const CameraRay<Lanes> ray =
            world_ray<Maker>(batch.camera, FilmPoint<Lanes>{film, own, {half, half}}).ray;
        return {ray.origin, ray.direction};
    };
    const Lanes none(0.0f);
    out.left = at(-half, none);
    out.right = at(half, none);
    out.above = at(none, -half);
    out.below = at(none, half);
}

/// Gradient magnitude per pixel from the values half a pixel away on all sides.
OBSCURA_INLINE Lanes slope(Lanes left, Lanes right, Lanes above, Lanes below) {
    const Lanes x = right - left;
    const Lanes y = below - above;
    return max(sqrt(x * x + y * y), Lanes(1e-30f));
}

/// Volume spanned by a ray and an edge: 0 where they meet, and linear across the image to first
/// order, whatever the camera.
/// Source  Pluecker's side product, as in Shoemake, "Pluecker Coordinate Tutorial", Ray Tracing
///         News 11(1), 1998
OBSCURA_INLINE Lanes side_product(const FilmRay& ray,
                                  const Vec3<Lanes>& from,
                                  const Vec3<Lanes>& edge) {
    return dot(ray.direction, cross(edge, ray.origin - from));
}

/// Distance on the film from the ray to the nearest edge of its triangle, in pixels. Inside a
/// triangle the nearest line through two corners is met between them.
OBSCURA_INLINE Lanes edge_distance_px(const SceneView& scene,
                                      const HitLanes& hit,
                                      const HitGeometry& g,
                                      const FilmRay& ray,
                                      const RaysAround& around) {
    Vec3<Lanes> p[3];
    for (int k = 0; k < 3; ++k)
        p[k] = gather3(scene.positions, g.corner[k] * LanesI(3));
    if (scene.motion.positions != nullptr) {
        const CornerVectors moved = moved_corners(
            scene, scene.motion.positions, {g.primitive, g.corner, hit.time}, {{p[0], p[1], p[2]}});
        for (int k = 0; k < 3; ++k)
            p[k] = moved.at[k];
    }
    const Mask instanced = hit.instance >= LanesI(0);
    if (any(instanced)) {
        const Affine<Lanes> world = instance_maps(scene, hit.instance, hit.time).world_from_object;
        for (Vec3<Lanes>& corner : p)
            corner = select(instanced, transform_point(world, corner), corner);
    }
    Lanes nearest(1e30f);
    for (int k = 0; k < 3; ++k) {
        const Vec3<Lanes>& from = p[k];
        const Vec3<Lanes> edge = p[(k + 1) % 3] - from;
        const Lanes change = slope(side_product(around.left, from, edge),
                                   side_product(around.right, from, edge),
                                   side_product(around.above, from, edge),
                                   side_product(around.below, from, edge));
        nearest = min(nearest, abs(side_product(ray, from, edge)) / change);
    }
    return nearest;
}

/// The unit range of u and of v is divided into this many parts by lines.
constexpr float parts = 8.0f;

/// Distance on the film to the nearest line of constant u or v, in pixels.
OBSCURA_INLINE Lanes iso_line_distance_px(const HitGeometry& g, const RaysAround& around) {
    const Vec3<Lanes> across_u = cross(g.dpdv, g.normal);
    const Vec3<Lanes> across_v = cross(g.normal, g.dpdu);
    const Lanes area = dot(g.dpdu, across_u);
    const Lanes inverse = Lanes(1.0f) / select(abs(area) > Lanes(1e-30f), area, Lanes(1e-30f));
    // Intersection of a ray with the tangent plane, relative to the hit point.
    const auto on_plane = [&](const FilmRay& ray) {
        const Vec3<Lanes> to_point = g.position - ray.origin;
        const Lanes along = dot(ray.direction, g.normal);
        const Lanes safe = select(abs(along) > Lanes(1e-6f), along, Lanes(1e-6f));
        return ray.direction * (dot(to_point, g.normal) / safe) - to_point;
    };
    const Vec3<Lanes> left = on_plane(around.left);
    const Vec3<Lanes> right = on_plane(around.right);
    const Vec3<Lanes> above = on_plane(around.above);
    const Vec3<Lanes> below = on_plane(around.below);
    const auto distance = [&](Lanes value, const Vec3<Lanes>& gradient) {
        const Lanes change = slope(
            dot(gradient, left), dot(gradient, right), dot(gradient, above), dot(gradient, below));
        const Lanes scaled = value * Lanes(parts);
        return abs(scaled - floor(scaled + Lanes(0.5f))) / (change * Lanes(parts));
    };
    return min(distance(g.first_uv.at.x, across_u * inverse),
               distance(g.first_uv.at.y, across_v * inverse));
}

/// Each ray stands for a square with a side of a quarter pixel: see wireframe_side in wavefront.h.
OBSCURA_INLINE Lanes coverage(const BatchSettings& batch, Lanes distance_px) {
    const Lanes inside = Lanes(0.5f * batch.wire_width_px) - distance_px;
    return clamp(inside * Lanes(4.0f) + Lanes(0.5f), Lanes(0.0f), Lanes(1.0f));
}

template <typename Maker>
void write_all_wires(const SceneView& scene,
                     const BatchSettings& batch,
                     int count,
                     const WireframeColumns& columns) {
    const Lanes zero(0.0f);
    for (int i = 0; i < count; i += lane_count) {
        const SampleColumns& out = columns.samples;
        const Mask hits =
            lanes_in_range(i, count) & (load(columns.hits.primitive + i) >= LanesI(0));
        store3(out.r, out.g, out.b, i, splat3(zero));
        store(out.a + i, select(hits, Lanes(1.0f), zero));
        if (none(hits)) continue;
        HitLanes hit = hits_or_first(columns.hits, i, hits);
        if (columns.time != nullptr) hit.time = load(columns.time + i);  // path i is pixel i
        const PathLanes path = load_paths(columns.paths, i);
        HitGeometry g;
        find_geometry<HitUse::attributes>(scene, hit, g);
        instance_to_world(scene, hit, g);
        RaysAround around;
        find_rays_around<Maker>(batch, i, around);
        Lanes nearest = edge_distance_px(scene, hit, g, {path.origin, path.direction}, around);
        g.first_uv = {};
        shapes_to_world(scene, hit, path, g);
        if (g.has_shapes) nearest = select(g.shapes, iso_line_distance_px(g, around), nearest);
        const Lanes line = select(hits, coverage(batch, nearest), zero);
        store3(out.r, out.g, out.b, i, splat3(line));
    }
}

}  // namespace

void write_wireframe(const SceneView& scene,
                     const BatchSettings& batch,
                     int count,
                     const WireframeColumns& columns) {
    visit_model(batch.camera, false, [&](auto maker) {
        write_all_wires<decltype(maker)>(scene, batch, count, columns);
    });
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
