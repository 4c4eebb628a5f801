// accel/moving_geometry.cpp - hands moving vertices and transforms to Embree.
// SPDX-License-Identifier: Apache-2.0
#include "accel/moving_geometry.h"

#include <algorithm>

namespace obscura {

void set_moving_triangles(const Scene& scene, const Primitive& primitive, RTCGeometry geometry) {
    const auto corners = static_cast<size_t>(primitive.triangle_count) * 3;
    const uint32_t* from = &scene.indices[static_cast<size_t>(primitive.first_triangle) * 3];
    // Motion stores each primitive's vertices separately, so that indices begin at 0.
    const uint32_t first = *std::min_element(from, from + corners);
    auto* to = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), corners / 3));
    if (to == nullptr) return;  // out of memory: Embree has said so
    std::transform(from, from + corners, to, [&](uint32_t corner) { return corner - first; });
    const auto steps = static_cast<unsigned>(scene.motion.steps);
    rtcSetGeometryTimeStepCount(geometry, steps);
    const auto begin = static_cast<size_t>(static_cast<int64_t>(primitive.motion_base) +
                                           3 * static_cast<int64_t>(first));
    const auto stride = static_cast<size_t>(primitive.motion_stride);
    for (unsigned step = 0; step < steps; ++step) {
        rtcSetSharedGeometryBuffer(geometry,
                                   RTC_BUFFER_TYPE_VERTEX,
                                   step,
                                   RTC_FORMAT_FLOAT3,
                                   scene.motion.positions.data(),
                                   (begin + step * stride) * sizeof(float),
                                   3 * sizeof(float),
                                   stride / 3);
    }
}

void set_instance_transforms(const Scene& scene, const Instance& instance, RTCGeometry geometry) {
    const auto set = [&](unsigned step, const Affinef& map) {
        rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, &map.m[0][0]);
    };
    if (instance.motion < 0) return set(0, instance.world_from_object);
    const auto steps = static_cast<unsigned>(scene.motion.steps);
    rtcSetGeometryTimeStepCount(geometry, steps);
    for (unsigned step = 0; step < steps; ++step)
        set(step, scene.motion.instances[static_cast<size_t>(instance.motion) + step]);
}

}  // namespace obscura
