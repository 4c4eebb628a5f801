// accel/endless_planes.cpp - planes without end, beside what the BVH found.
// SPDX-License-Identifier: Apache-2.0
#include "accel/endless_planes.h"

#include "accel/safe_ray.h"
#include "scene/motion.h"

#include <algorithm>

namespace obscura {

namespace {

/// The row's ray, as planes without end take it.
ShapeRay<float> shape_ray(const RayColumns& rays, int row) {
    return {{rays.ox[row], rays.oy[row], rays.oz[row]}, {rays.dx[row], rays.dy[row], rays.dz[row]}};
}

float longest(const RayColumns& rays, int row) {
    return rays.tfar != nullptr ? rays.tfar[row] : unlimited;
}

/// The plane where it is at the time of the row's ray.
EndlessPlane at_ray(const Accel::Impl& impl,
                    const EndlessPlane& plane,
                    const RayColumns& rays,
                    int row) {
    EndlessPlane out = plane;
    if (plane.instance < 0 || rays.time == nullptr) return out;
    const Instance& instance = impl.scene->instances[static_cast<size_t>(plane.instance)];
    out.object_from_world = object_from_world_at(*impl.scene, instance, rays.time[row]);
    return out;
}

}  // namespace

void Accel::Impl::list_endless_planes() {
    endless_planes.clear();
    const auto add = [&](int32_t primitive, int32_t instance) {
        const ShapeGeometry& geometry = shapes[static_cast<size_t>(primitive)];
        if (geometry.rows == nullptr || !is_unbounded(*geometry.rows)) return;
        EndlessPlane plane{geometry, *geometry.rows, primitive, instance, {}};
        if (instance >= 0) {
            plane.object_from_world =
                scene->instances[static_cast<size_t>(instance)].object_from_world;
        }
        endless_planes.push_back(plane);
    };
    for (int32_t i = 0; i < scene->world_primitive_count; ++i)
        add(i, -1);
    for (size_t i = 0; i < scene->instances.size(); ++i) {
        const Mesh& mesh = scene->meshes[static_cast<size_t>(scene->instances[i].mesh)];
        for (int32_t k = 0; k < mesh.primitive_count; ++k)
            add(mesh.first_primitive + k, static_cast<int32_t>(i));
    }
}

void meet_endless_planes(const Accel::Impl& impl,
                         const QueryContext& context,
                         const RayColumns& rays,
                         const HitColumns& hits,
                         int row) {
    for (const EndlessPlane& plane : impl.endless_planes) {
        const float tfar = hits.primitive[row] >= 0 ? hits.t[row] : longest(rays, row);
        const auto hit = intersect_endless(at_ray(impl, plane, rays, row),
                                           context,
                                           shape_ray(rays, row),
                                           static_cast<unsigned>(row),
                                           tfar);
        if (!hit.found) continue;
        hits.t[row] = hit.t;
        hits.u[row] = 0.0f;
        hits.v[row] = 0.0f;
        hits.instance[row] = plane.instance;
        hits.primitive[row] = plane.primitive;
        hits.triangle[row] = 0;
    }
}

void list_endless_crossings(const Accel::Impl& impl,
                            const QueryContext& context,
                            const RayColumns& rays,
                            int row,
                            std::vector<Crossing>& out) {
    for (const EndlessPlane& plane : impl.endless_planes) {
        const int32_t body = impl.bodies[static_cast<size_t>(plane.primitive)];
        if (body == 0) continue;
        const EndlessPlane there = at_ray(impl, plane, rays, row);
        const ShapeRay<float> ray = shape_ray(rays, row);
        const auto hit =
            intersect_endless(there, context, ray, static_cast<unsigned>(row), longest(rays, row));
        if (!hit.found) continue;
        const Vec3f direction = plane.instance < 0
                                    ? ray.direction
                                    : transform_vector(there.object_from_world, ray.direction);
        const SceneRows surface{plane.instance, plane.primitive};
        out.push_back({hit.t, 0.0f, 0.0f, surface, 0, body, direction.y < 0.0f});
    }
}

bool endless_plane_hides(const Accel::Impl& impl,
                         const QueryContext& context,
                         const RayColumns& rays,
                         int row) {
    const ShapeRay<float> ray = shape_ray(rays, row);
    const float tfar = longest(rays, row);
    return std::any_of(
        impl.endless_planes.begin(), impl.endless_planes.end(), [&](const EndlessPlane& plane) {
            const EndlessPlane there = at_ray(impl, plane, rays, row);
            const auto id = static_cast<unsigned>(row);
            if (!intersect_endless(there, context, ray, id, tfar).found) return false;
            return !(plane.geometry.wall && passes_wall(context, id));
        });
}

}  // namespace obscura
