// accel/nearest_hits.cpp - the filter that keeps nearest hits; compiled once per instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/nearest_hits.h"

#include <cmath>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

void begin(const RTCRay16& rays, int first, float scene_size, NearestHits& nearest) {
    // Of large numbers far away the rounding counts, but less than the room that there is for rays
    // that graze what is near.
    const Lanes far_away(scene_size * 0x1p-5f);
    nearest.first_id = first;
    for (int i = 0; i < packet; i += lane_count) {
        store(nearest.t + i, Lanes(INFINITY));
        const Lanes origin =
            abs(load(rays.org_x + i)) + abs(load(rays.org_y + i)) + abs(load(rays.org_z + i));
        store(nearest.coordinates + i, origin + far_away);
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
    OBSCURA_INLINE Vec3<Lanes> origin() const {
        return {load(&RTCRayN_org_x(args.ray, args.N, i)),
                load(&RTCRayN_org_y(args.ray, args.N, i)),
                load(&RTCRayN_org_z(args.ray, args.N, i))};
    }
    OBSCURA_INLINE Vec3<Lanes> direction() const {
        return {load(&RTCRayN_dir_x(args.ray, args.N, i)),
                load(&RTCRayN_dir_y(args.ray, args.N, i)),
                load(&RTCRayN_dir_z(args.ray, args.N, i))};
    }
    OBSCURA_INLINE int32_t id(unsigned k) const {
        return static_cast<int32_t>(RTCRayN_id(args.ray, args.N, i + k));
    }
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
OBSCURA_INLINE Mask have_lower_ids(const Candidates& at, const NearestHits& nearest, int lane) {
    const auto compare = [](LanesI a, const int32_t* column, Mask or_else) {
        const LanesI b = load(column);
        return (a < b) | ((a == b) & or_else);
    };
    const Mask element = compare(at.element(), nearest.element + lane, Mask(false));
    const Mask geometry = compare(at.geometry(), nearest.geometry + lane, element);
    return compare(at.instance(), nearest.instance + lane, geometry);
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
    float coordinates = nearest.coordinates[lane];
    if (candidate.instance >= 0) {
        const Vec3f origin{RTCRayN_org_x(args.ray, n, i),
                           RTCRayN_org_y(args.ray, n, i),
                           RTCRayN_org_z(args.ray, n, i)};
        const Vec3f direction{RTCRayN_dir_x(args.ray, n, i),
                              RTCRayN_dir_y(args.ray, n, i),
                              RTCRayN_dir_z(args.ray, n, i)};
        coordinates = max(coordinates, own_coordinates(origin, direction));
    }
    t = end_of_search(t, coordinates);
}

/// Candidates whose rays have lanes one after the other, from `lane` on.
OBSCURA_INLINE void keep_nearest_of_many(const Candidates& at, int lane, NearestHits& nearest) {
    const Mask valid = at.valid();
    const Lanes t = load(at.t());
    const Lanes best = load(nearest.t + lane);
    Mask taken = valid & (t < best);
    const Mask tied = valid & (t == best);
    if (any(tied)) taken = taken | (tied & have_lower_ids(at, nearest, lane));
    store(at.args.valid + at.i, select(taken, LanesI(-1), LanesI(0)));
    if (none(taken)) return;
    const LanesI instance = at.instance();
    store(nearest.t + lane, select(taken, t, best));
    replace(nearest.instance + lane, taken, instance);
    replace(nearest.geometry + lane, taken, at.geometry());
    replace(nearest.element + lane, taken, at.element());
    Lanes coordinates = load(nearest.coordinates + lane);
    if (any(instance >= LanesI(0)))
        coordinates = max(coordinates, own_coordinates(at.origin(), at.direction()));
    store(at.t(), select(taken, end_of_search(t, coordinates), t));
}

void keep_nearest(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    for (unsigned i = 0; i < args->N; i += lane_count) {
        const Candidates at{*args, i};
        uint32_t bits = at.valid_bits();
        if (bits == 0) continue;
        const auto first = static_cast<unsigned>(__builtin_ctz(bits));
        NearestHits& nearest = nearest_hits_of(context, static_cast<unsigned>(at.id(first)));
        if (i + lane_count <= args->N && (bits & (bits - 1)) != 0) {
            // Embree's packets may be narrower than ours, and parts of them.
            const auto last = 31U - static_cast<unsigned>(__builtin_clz(bits));
            const int lane = at.id(first) - nearest.first_id - static_cast<int>(first);
            const bool are_neighbours =
                at.id(last) - at.id(first) == static_cast<int>(last - first);
            if (are_neighbours && lane >= 0 && lane <= packet - lane_count) {
                keep_nearest_of_many(at, lane, nearest);
                continue;
            }
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
