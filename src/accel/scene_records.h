// accel/scene_records.h - converts Embree's geometry and instance ids to indices of the scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

inline SceneRecords scene_records(const Accel::Impl& impl,
                                  unsigned geometry,
                                  unsigned instance_id) {
    const auto first = static_cast<int32_t>(geometry);
    if (instance_id == RTC_INVALID_GEOMETRY_ID) return {-1, first};
    const int32_t instance = static_cast<int32_t>(instance_id) - impl.scene->world_primitive_count;
    if (instance == static_cast<int32_t>(impl.scene->instances.size()))
        return {-1, first};  // still
    return {instance, first + impl.instance_first_primitive[static_cast<size_t>(instance)]};
}

/// Writes one hit from Embree's result.
inline void store_hit(const Accel::Impl& impl,
                      const RTCRayHit& ray,
                      const HitColumns& hits,
                      int index) {
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        hits.primitive[index] = -1;
        return;
    }
    const SceneRecords records = scene_records(impl, ray.hit.geomID, ray.hit.instID[0]);
    hits.t[index] = ray.ray.tfar;
    hits.u[index] = ray.hit.u;
    hits.v[index] = ray.hit.v;
    hits.instance[index] = records.instance;
    hits.primitive[index] = records.primitive;
    hits.triangle[index] = static_cast<int32_t>(ray.hit.primID);
}

}  // namespace obscura
