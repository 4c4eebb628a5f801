// accel/ask_again.h - traces one ray from its start, with a filter that sees every candidate hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"
#include "accel/safe_ray.h"

namespace obscura {

/// Traces a ray; geomID is RTC_INVALID_GEOMETRY_ID where it hits nothing.
///
/// In      context: the filter finds it in its arguments
inline RTCRayHit ask_again(const Accel::Impl& impl,
                           QueryContext& context,
                           RTCFilterFunctionN filter,
                           const RayColumns& rays,
                           int index) {
    context.nearest = nullptr;  // of the packet
    Query query(context, false);
    query.set_filter(filter);
    RTCRayHit out;
    load_ray(rays, index, out.ray);
    out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    out.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect1(impl.top, &out);
    return out;
}

}  // namespace obscura
