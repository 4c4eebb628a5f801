// accel/coherent_stream.cpp - hands two packets to Embree as a stream.
// SPDX-License-Identifier: Apache-2.0
#include "accel/coherent_stream.h"

#include <cstddef>
#include <cstring>

namespace obscura {

#if OBSCURA_EMBREE == 4

int stream_width(RTCDevice) {
    return 0;
}

/// Never called, as the width is 0.
void intersect_stream(Query&, RTCScene, int, RTCRayHit16*) {}

#else

namespace {

constexpr int half_width = 8;
constexpr size_t half_bytes = half_width * sizeof(float);
constexpr size_t columns = sizeof(RTCRayHit8) / half_bytes;
static_assert(sizeof(RTCRayHit16) == columns * 2 * half_bytes, "columns of words, and no padding");

/// The columns of the first or second eight rays of a packet.
std::byte* half_column(RTCRayHit16& packet, int half, size_t column) {
    return reinterpret_cast<std::byte*>(&packet) +
           (2 * column + static_cast<size_t>(half)) * half_bytes;
}

std::byte* column_of(RTCRayHit8& packet, size_t column) {
    return reinterpret_cast<std::byte*>(&packet) + column * half_bytes;
}

}  // namespace

int stream_width(RTCDevice device) {
    const auto has = [&](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device, property) != 0;
    };
    if (!has(RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED)) return 0;
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 2 * half_width;
    return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? half_width : 0;
}

void intersect_stream(Query& query, RTCScene scene, int width, RTCRayHit16* packets) {
    if (width != half_width) {
        query.intersect_packets16(scene, packets, stream_packets);
        return;
    }
    RTCRayHit8 halves[2 * stream_packets];
    for (int i = 0; i < 2 * stream_packets; ++i) {
        for (size_t c = 0; c < columns; ++c)
            std::memcpy(column_of(halves[i], c), half_column(packets[i / 2], i % 2, c), half_bytes);
    }
    query.intersect_packets8(scene, halves, 2 * stream_packets);
    for (int i = 0; i < 2 * stream_packets; ++i) {
        for (size_t c = 0; c < columns; ++c)
            std::memcpy(half_column(packets[i / 2], i % 2, c), column_of(halves[i], c), half_bytes);
    }
}

#endif

}  // namespace obscura
