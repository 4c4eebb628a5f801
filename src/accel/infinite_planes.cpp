// accel/infinite_planes.cpp - infinite planes, which no BVH can hold: tested apart from it.
// SPDX-License-Identifier: Apache-2.0
#include "accel/infinite_planes.h"

#include "accel/safe_ray.h"
#include "scene/motion.h"

#include <algorithm>

namespace obscura {

namespace {

/// One ray of the columns, for infinite planes.
ShapeRay<float> shape_ray(const RayColumns& rays, int index) {
    return {{rays.ox[index], rays.oy[index], rays.oz[index]},
            {rays.dx[index], rays.dy[index], rays.dz[index]}};
}

float longest(const RayColumns& rays, int index) {
    return rays.tfar != nullptr ? rays.tfar[index] : unlimited;
}

/// The plane at the time of a ray.
InfinitePlane at_ray(const Accel::Impl& impl,
                     const InfinitePlane& plane,
                     const RayColumns& rays,
                     int index) {
    InfinitePlane out = plane;
    if (plane.instance < 0 || rays.time == nullptr) return out;
    const Instance& instance = impl.scene->instances[static_cast<size_t>(plane.instance)];
    out.object_from_world = object_from_world_at(*impl.scene, instance, rays.time[index]);
    return out;
}

}  // namespace

void Accel::Impl::list_infinite_planes() {
    infinite_planes.clear();
    const auto add = [&](int32_t primitive, int32_t instance) {
        const ShapeGeometry& geometry = shapes[static_cast<size_t>(primitive)];
        if (geometry.records == nullptr || !is_unbounded(*geometry.records)) return;
        InfinitePlane plane{geometry, *geometry.records, primitive, instance, {}};
        if (instance >= 0) {
            plane.object_from_world =
                scene->instances[static_cast<size_t>(instance)].object_from_world;
        }
        infinite_planes.push_back(plane);
    };
    for (int32_t i = 0; i < scene->world_primitive_count; ++i)
        add(i, -1);
    for (size_t i = 0; i < scene->instances.size(); ++i) {
        const Mesh& mesh = scene->meshes[static_cast<size_t>(scene->instances[i].mesh)];
        for (int32_t k = 0; k < mesh.primitive_count; ++k)
            add(mesh.first_primitive + k, static_cast<int32_t>(i));
    }
}

void meet_infinite_planes(const Accel::Impl& impl,
                          const QueryContext& context,
                          const RayColumns& rays,
                          const HitColumns& hits,
                          int index) {
    for (const InfinitePlane& plane : impl.infinite_planes) {
        const float tfar = hits.primitive[index] >= 0 ? hits.t[index] : longest(rays, index);
        const auto hit = intersect_infinite_plane(at_ray(impl, plane, rays, index),
                                                  context,
                                                  shape_ray(rays, index),
                                                  static_cast<unsigned>(index),
                                                  tfar);
        if (!hit.found) continue;
        hits.t[index] = hit.t;
        hits.u[index] = 0.0f;
        hits.v[index] = 0.0f;
        hits.instance[index] = plane.instance;
        hits.primitive[index] = plane.primitive;
        hits.triangle[index] = 0;
    }
}

void list_infinite_crossings(const Accel::Impl& impl,
                             const QueryContext& context,
                             const RayColumns& rays,
                             int index,
                             std::vector<Crossing>& out) {
    for (const InfinitePlane& plane : impl.infinite_planes) {
        const int32_t medium = impl.media[static_cast<size_t>(plane.primitive)];
        if (medium == 0) continue;
        const InfinitePlane there = at_ray(impl, plane, rays, index);
        const ShapeRay<float> ray = shape_ray(rays, index);
        const auto hit = intersect_infinite_plane(
            there, context, ray, static_cast<unsigned>(index), longest(rays, index));
        if (!hit.found) continue;
        const Vec3f direction = plane.instance < 0
                                    ? ray.direction
                                    : transform_vector(there.object_from_world, ray.direction);
        const SceneRecords surface{plane.instance, plane.primitive};
        out.push_back({hit.t, 0.0f, 0.0f, surface, 0, medium, direction.y < 0.0f});
    }
}

void list_infinite_surfaces(const Accel::Impl& impl,
                            const QueryContext& context,
                            const RayColumns& rays,
                            int index,
                            std::vector<MetSurface>& out) {
    for (const InfinitePlane& plane : impl.infinite_planes) {
        const auto hit = intersect_infinite_plane(at_ray(impl, plane, rays, index),
                                                  context,
                                                  shape_ray(rays, index),
                                                  static_cast<unsigned>(index),
                                                  longest(rays, index));
        if (hit.found) out.push_back({index, {plane.instance, plane.primitive}});
    }
}

bool infinite_plane_occludes(const Accel::Impl& impl,
                             const QueryContext& context,
                             const RayColumns& rays,
                             int index) {
    const ShapeRay<float> ray = shape_ray(rays, index);
    const float tfar = longest(rays, index);
    return std::any_of(
        impl.infinite_planes.begin(), impl.infinite_planes.end(), [&](const InfinitePlane& plane) {
            const InfinitePlane there = at_ray(impl, plane, rays, index);
            const auto id = static_cast<unsigned>(index);
            if (!intersect_infinite_plane(there, context, ray, id, tfar).found) return false;
            return !(plane.geometry.thin_wall && passes_thin_wall(context, id));
        });
}

}  // namespace obscura
