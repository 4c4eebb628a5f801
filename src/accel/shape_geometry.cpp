// accel/shape_geometry.cpp - parts of the shape callbacks that are compiled only once.
// SPDX-License-Identifier: Apache-2.0
#include "accel/shape_geometry.h"

#include "accel/alpha_filter.h"
#include "math/sampler.h"

namespace obscura {

namespace {

Vec2f texture_uv(const ShapeGeometry& geometry, const ShapeCandidate& candidate) {
    if (geometry.records != nullptr) {
        const ShapeRecord& record = geometry.records[candidate.index];
        return surface_of_shape<float>(record.kind, UniformShape<float>(record), candidate.position)
            .uv;
    }
    const float* at = geometry.spheres + sphere_word(static_cast<int64_t>(candidate.index));
    const Sphere<float> sphere{{at[0], at[sphere_block], at[2 * sphere_block]},
                               at[3 * sphere_block]};
    return surface_of_sphere(sphere, candidate.position - sphere.centre).uv;
}

}  // namespace

bool passes_shape(const ShapeGeometry& geometry, const QueryContext& context, unsigned instance) {
    return passes_surface(*geometry.visibility, context, instance);
}

bool is_opaque_there(const ShapeGeometry& geometry,
                     const QueryContext& context,
                     const ShapeCandidate& candidate) {
    const AlphaGeometry& open = *geometry.alpha;
    const Primitive& primitive = open.scene->primitives[static_cast<size_t>(open.primitive)];
    const Material& material = open.scene->materials[static_cast<size_t>(primitive.material)];
    const auto index = static_cast<unsigned>(candidate.index);
    if (is_point_or_line(primitive)) {
        return is_opaque_there(open, context, {candidate.ray, candidate.instance, index}, {0, 0});
    }
    const float alpha = material_alpha(open, material, texture_uv(geometry, candidate));
    // The two intersections with one shape are two decisions.
    const auto decision = index * 2U + static_cast<unsigned>(candidate.root);
    return alpha >= alpha_threshold(open, context, {candidate.ray, candidate.instance, decision});
}

NearHit<float> intersect_infinite_plane(const InfinitePlane& plane,
                                        const QueryContext& context,
                                        const ShapeRay<float>& ray,
                                        unsigned id,
                                        float tfar) {
    const bool moved = plane.instance >= 0;
    if (plane.geometry.visibility != nullptr) {
        const Scene& scene = *plane.geometry.visibility->scene;
        if ((scene.visibility.of(plane.primitive, plane.instance) & context.passes) != 0) return {};
    }
    const ShapeRay<float> own =
        moved ? ShapeRay<float>{transform_point(plane.object_from_world, ray.origin),
                                transform_vector(plane.object_from_world, ray.direction)}
              : ray;
    const Plane<float> shape = read_plane<float>(UniformShape<float>(plane.record));
    NearHit<float> hit = nearest(intersect_plane(shape, own), 0.0f, tfar);
    if (!hit.found) return hit;
    if (plane.geometry.single_sided && context.culls_back_faces) hit.found = own.direction.y < 0.0f;
    if (hit.found && plane.geometry.alpha != nullptr) {
        const auto instance = static_cast<unsigned>(plane.instance);
        const Vec3f position = own.origin + own.direction * hit.t;
        hit.found = is_opaque_there(plane.geometry, context, {id, instance, 0, 0, position});
    }
    return hit;
}

}  // namespace obscura
