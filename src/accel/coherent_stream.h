// accel/coherent_stream.h - rays that go much the same way, in streams of two packets.
// SPDX-License-Identifier: Apache-2.0
//
// Embree 3 finds the hits of 32 such rays sooner than those of two packets: it leaves out at once
// what lies outside the frustum around them. Embree 4 has no streams.
#pragma once

#include "accel/embree.h"

namespace obscura {

/// How many packets of 16 make a stream.
inline constexpr int stream_packets = 2;

/// How many rays a packet must have, 16 or 8, for the device to trace several as a stream; 0: it
/// would not, or slowly.
int stream_width(RTCDevice device);

/// Finds the nearest hits of coherent rays.
///
/// In      width: stream_width, not 0
/// In/Out  packets: stream_packets of them, all of whose rays are valid
void intersect_stream(Query& query, RTCScene scene, int width, RTCRayHit16* packets);

}  // namespace obscura
