// accel/dispatch.h - chooses Accel's functions for an instruction set.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace obscura {

struct NearestHitCalls;
struct PacketMoves;
struct ShapeCallbacks;
struct SplatCallbacks;

struct AccelFunctions {
    const ShapeCallbacks* shapes = nullptr;
    const PacketMoves* packets = nullptr;
    const SplatCallbacks* splats = nullptr;
    const NearestHitCalls* nearest = nullptr;
};

/// In   embree_isa: as Accel::build; "" takes the widest that this CPU has
AccelFunctions accel_functions_for(const std::string& embree_isa);

}  // namespace obscura
