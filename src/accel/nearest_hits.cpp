// accel/nearest_hits.cpp - the filter that keeps nearest hits; compiled once per instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/nearest_hits.h"

#include <limits>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

void begin(const RTCRay16& rays, int first, NearestHits& nearest) {
    nearest.first_id = first;
    for (int i = 0; i < packet; i += lane_count) {
        store(nearest.t + i, Lanes(std::numeric_limits<float>::infinity()));
        store(nearest.coordinates + i,
              abs(load(rays.org_x + i)) + abs(load(rays.org_y + i)) + abs(load(rays.org_z + i)));
    }
}

OBSCURA_INLINE const int32_t* words(const unsigned* column) {
    return reinterpret_cast<const int32_t*>(column);
}

/// Candidates [i, i + lane_count) of a filter function.
struct Candidates {
    const RTCFilterFunctionNArguments& args;
    unsigned i;

    OBSCURA_INLINE Mask valid() const { return load(args.valid + i) != LanesI(0); }
    /// The same as bits, of as many as there are.
    OBSCURA_INLINE uint32_t valid_bits() const {
        if (i + lane_count <= args.N) return mask_bits(valid());
        uint32_t bits = 0;
        for (unsigned k = 0; i + k < args.N; ++k)
            bits |= (args.valid[i + k] != 0 ? 1U : 0U) << k;
        return bits;
    }
    OBSCURA_INLINE float* t() const { return &RTCRayN_tfar(args.ray, args.N, i); }
    OBSCURA_INLINE LanesI instance() const {
        return load(words(&RTCHitN_instID(args.hit, args.N, i, 0)));
    }
    OBSCURA_INLINE LanesI geometry() const {
        return load(words(&RTCHitN_geomID(args.hit, args.N, i)));
    }
    OBSCURA_INLINE LanesI element() const {
        return load(words(&RTCHitN_primID(args.hit, args.N, i)));
    }
};

/// Which of the candidates that are as near as the hits so far have lower ids, as takes()
/// has it.
OBSCURA_INLINE Mask have_lower_ids(const Candidates& at, const NearestHits& nearest) {
    const unsigned i = at.i;
    const auto compare = [](LanesI a, const int32_t* column, Mask or_else) {
        const LanesI b = load(column);
        return (a < b) | ((a == b) & or_else);
    };
    const Mask element = compare(at.element(), nearest.element + i, Mask(false));
    const Mask geometry = compare(at.geometry(), nearest.geometry + i, element);
    return compare(at.instance(), nearest.instance + i, geometry);
}

OBSCURA_INLINE void replace(int32_t* column, Mask taken, LanesI value) {
    store(column, select(taken, value, load(column)));
}

/// One candidate: where rays have diverged, Embree calls for one after the other.
OBSCURA_INLINE void keep_nearest_of_one(const RTCFilterFunctionNArguments& args,
                                        unsigned i,
                                        NearestHits& nearest) {
    const unsigned n = args.N;
    float& t = RTCRayN_tfar(args.ray, n, i);
    const int lane = static_cast<int>(RTCRayN_id(args.ray, n, i)) - nearest.first_id;
    const CandidateHit candidate{t,
                                 static_cast<int32_t>(RTCHitN_instID(args.hit, n, i, 0)),
                                 static_cast<int32_t>(RTCHitN_geomID(args.hit, n, i)),
                                 static_cast<int32_t>(RTCHitN_primID(args.hit, n, i))};
    if (!takes(nearest, lane, candidate)) {
        args.valid[i] = 0;
        return;
    }
    t = end_of_search(t, nearest.coordinates[lane]);
}

/// Candidates [i, i + lane_count) of a whole packet.
OBSCURA_INLINE void keep_nearest_of_many(const Candidates& at, Mask valid, NearestHits& nearest) {
    const unsigned i = at.i;
    const Lanes t = load(at.t());
    const Lanes best = load(nearest.t + i);
    Mask taken = valid & (t < best);
    const Mask tied = valid & (t == best);
    if (any(tied)) taken = taken | (tied & have_lower_ids(at, nearest));
    store(at.args.valid + i, select(taken, LanesI(-1), LanesI(0)));
    if (none(taken)) return;
    store(nearest.t + i, select(taken, t, best));
    replace(nearest.instance + i, taken, at.instance());
    replace(nearest.geometry + i, taken, at.geometry());
    replace(nearest.element + i, taken, at.element());
    const Lanes coordinates = load(nearest.coordinates + i);
    store(at.t(), select(taken, end_of_search(t, coordinates), t));
}

void keep_nearest(const RTCFilterFunctionNArguments* args) {
    NearestHits& nearest = *reinterpret_cast<const QueryContext*>(args->context)->nearest;
    // Where Embree's packets are narrower than ours, it also sorts the rays by their directions.
    const bool is_ours = args->N == packet;
    for (unsigned i = 0; i < args->N; i += lane_count) {
        const Candidates at{*args, i};
        uint32_t bits = at.valid_bits();
        if (is_ours && (bits & (bits - 1)) != 0) {
            keep_nearest_of_many(at, at.valid(), nearest);
            continue;
        }
        for (; bits != 0; bits &= bits - 1)
            keep_nearest_of_one(*args, i + static_cast<unsigned>(__builtin_ctz(bits)), nearest);
    }
}

}  // namespace

extern const NearestHitCalls nearest_hit_calls;
const NearestHitCalls nearest_hit_calls = {begin, keep_nearest};

}  // namespace OBSCURA_ISA
}  // namespace obscura
