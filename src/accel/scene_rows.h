// accel/scene_rows.h - from Embree's numbers of geometry and instance to rows of the scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

inline SceneRows scene_rows(const Accel::Impl& impl, unsigned geometry, unsigned instance_id) {
    const auto first = static_cast<int32_t>(geometry);
    if (instance_id == RTC_INVALID_GEOMETRY_ID) return {-1, first};
    const int32_t instance = static_cast<int32_t>(instance_id) - impl.scene->world_primitive_count;
    if (instance == static_cast<int32_t>(impl.scene->instances.size()))
        return {-1, first};  // still
    return {instance, first + impl.instance_first_primitive[static_cast<size_t>(instance)]};
}

/// Writes one row from what Embree found.
inline void store_hit(const Accel::Impl& impl,
                      const RTCRayHit& ray,
                      const HitColumns& hits,
                      int row) {
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        hits.primitive[row] = -1;
        return;
    }
    const SceneRows rows = scene_rows(impl, ray.hit.geomID, ray.hit.instID[0]);
    hits.t[row] = ray.ray.tfar;
    hits.u[row] = ray.hit.u;
    hits.v[row] = ray.hit.v;
    hits.instance[row] = rows.instance;
    hits.primitive[row] = rows.primitive;
    hits.triangle[row] = static_cast<int32_t>(ray.hit.primID);
}

}  // namespace obscura
