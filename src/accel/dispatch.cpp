// accel/dispatch.cpp - chooses Accel's functions for an instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/dispatch.h"

#include "accel/nearest_hits.h"
#include "accel/packets.h"
#include "accel/shape_geometry.h"
#include "accel/splat_layers.h"
#include "base/cpu.h"

namespace obscura {

// This file is compiled as baseline, where isa_baseline is the inline namespace.
inline namespace isa_baseline {
extern const ShapeCallbacks shape_callbacks;
extern const PacketMoves packet_moves;
extern const SplatCallbacks splat_callbacks;
extern const NearestHitCalls nearest_hit_calls;
}  // namespace isa_baseline
namespace isa_avx2 {
extern const ShapeCallbacks shape_callbacks;
extern const PacketMoves packet_moves;
extern const SplatCallbacks splat_callbacks;
extern const NearestHitCalls nearest_hit_calls;
}  // namespace isa_avx2
namespace isa_avx512 {
extern const ShapeCallbacks shape_callbacks;
extern const PacketMoves packet_moves;
extern const SplatCallbacks splat_callbacks;
extern const NearestHitCalls nearest_hit_calls;
}  // namespace isa_avx512

AccelFunctions accel_functions_for(const std::string& embree_isa) {
#if defined(__x86_64__)
    if (embree_isa == "avx512" || (embree_isa.empty() && cpu_has_avx512())) {
        return {&isa_avx512::shape_callbacks,
                &isa_avx512::packet_moves,
                &isa_avx512::splat_callbacks,
                &isa_avx512::nearest_hit_calls};
    }
    if (embree_isa == "avx2" || (embree_isa.empty() && cpu_has_avx2())) {
        return {&isa_avx2::shape_callbacks,
                &isa_avx2::packet_moves,
                &isa_avx2::splat_callbacks,
                &isa_avx2::nearest_hit_calls};
    }
#endif
    (void)embree_isa;
    return {&isa_baseline::shape_callbacks,
            &isa_baseline::packet_moves,
            &isa_baseline::splat_callbacks,
            &isa_baseline::nearest_hit_calls};
}

}  // namespace obscura
