// stages/2_scatter.cpp - stage 2, inside scattering media: one flight of each random-walk path.
// SPDX-License-Identifier: Apache-2.0
#include "stages/2_scatter.h"

#include "math/sampler.h"
#include "stages/2_scatter_lights.h"
#include "stages/3_media.h"
#include "surface/scattering.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Flights before Russian roulette begins.
constexpr int flights_before_roulette = 16;

/// The uses of a flight's random numbers.
enum class FlightUse : uint32_t { channel, distance, angle, turn, roulette, count };

/// Random numbers of flights after a bounce's first are hashed: the pixel's Sobol points have pairs
/// for that one alone.
OBSCURA_INLINE Lanes flight_random(LanesU path_key, const Flight& flight, FlightUse use) {
    const uint32_t number =
        (static_cast<uint32_t>(flight.bounce) << 20U) +
        static_cast<uint32_t>(flight.number) * static_cast<uint32_t>(FlightUse::count) +
        static_cast<uint32_t>(use);
    const uint32_t salt = hash_word(number ^ 0x53434154U);
    return unit_float<Lanes>(hash_word(LanesU(path_key ^ LanesU(salt))));
}

OBSCURA_INLINE Vec2<Lanes> distance_random(const PathLanes& path, const Flight& flight) {
    if (flight.number == 0) return flight_pair(path, flight, FlightPair::distance);
    return {flight_random(path.path_key, flight, FlightUse::channel),
            flight_random(path.path_key, flight, FlightUse::distance)};
}

OBSCURA_INLINE Vec2<Lanes> turn_random(const PathLanes& path, const Flight& flight) {
    if (flight.number == 0) return flight_pair(path, flight, FlightPair::turn);
    return {flight_random(path.path_key, flight, FlightUse::angle),
            flight_random(path.path_key, flight, FlightUse::turn)};
}

/// The fraction of a path's throughput that each channel carries.
OBSCURA_INLINE Vec3<Lanes> channel_weights(const Vec3<Lanes>& throughput) {
    const Lanes sum = throughput.x + throughput.y + throughput.z;
    const Mask dark = sum <= Lanes(0.0f);
    const Vec3<Lanes> share = throughput * (Lanes(1.0f) / select(dark, Lanes(1.0f), sum));
    return select(dark, splat3(Lanes(1.0f / 3.0f)), share);
}

OBSCURA_INLINE PathLanes scattered_path(const PathLanes& path,
                                        const FreeFlight<Lanes>& free,
                                        Lanes anisotropy,
                                        const Flight& flight) {
    PathLanes next = path;
    next.origin = path.origin + path.direction * free.distance_m;
    next.direction = scatter_direction(path.direction, anisotropy, turn_random(path, flight));
    next.throughput = path.throughput * free.scattered;
    next.pdf = Lanes(0.0f);  // unless light is sampled here, emission that it finds counts in full
    next.cone_width = path.cone_width + path.cone_spread * free.distance_m;
    next.cone_spread = max(path.cone_spread, Lanes(0.5f));
    return next;
}

/// Russian roulette: weak paths end with some probability, and survivors are weighted up.
OBSCURA_INLINE Mask survives(const Flight& flight, PathLanes& path) {
    if (flight.number < flights_before_roulette) return Mask(true);
    const Lanes chance = clamp(max_component(path.throughput), Lanes(0.05f), Lanes(1.0f));
    path.throughput = path.throughput * (Lanes(1.0f) / chance);
    return flight_random(path.path_key, flight, FlightUse::roulette) < chance;
}

/// Writes lanes back to the paths that they came from.
class IndexedWriter {
public:
    OBSCURA_INLINE IndexedWriter(const uint32_t* indices, Mask mask)
        : indices_(indices), mask_(mask) {}

    template <typename L, typename Word>
    OBSCURA_INLINE void operator()(const L& value, Word* column) const {
        alignas(64) Word lanes[lane_count];
        store(lanes, value);
        for (uint32_t bits = mask_bits(mask_); bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            column[indices_[lane]] = lanes[lane];
        }
    }
    OBSCURA_INLINE void operator()(const Vec3<Lanes>& v, float* x, float* y, float* z) const {
        (*this)(v.x, x);
        (*this)(v.y, y);
        (*this)(v.z, z);
    }
    /// A flight changes neither the path's key nor its medium stack.
    OBSCURA_INLINE void operator()(const LanesU&, uint32_t*) const {}

private:
    const uint32_t* indices_;
    Mask mask_;
};

/// Writes back the columns that a flight changes, and the hit at its end.
OBSCURA_INLINE void give_back(const ScatterColumns& columns,
                              const IndexedWriter& write,
                              const PathLanes& path,
                              const HitLanes& hit) {
    PathColumns::for_each_field(write, path, columns.paths);
    HitColumns::for_each_field(write, hit, columns.hits);
}

template <typename Columns>
OBSCURA_INLINE int append_random_walks(
    const Columns& columns, int at, Mask mask, const PathLanes& path, LanesU path_index) {
    const Packer packer(mask);
    store(columns.path_index + at, pack(packer, path_index));
    return append_paths(columns.random_walks, at, mask, path);
}

}  // namespace

int begin_scatter(const SceneView& scene, int count, const ScatterStart& columns) {
    int random_walks = 0;
    for (int i = 0; i < count; i += lane_count) {
        const PathLanes path = load_paths(columns.paths, i);
        const HitLanes hit = load_hits(columns.hits, i);
        const LanesI medium = dominant_medium(path.medium_stack);
        Mask inside =
            lanes_in_range(i, count) & (hit.primitive >= LanesI(0)) & (medium > LanesI(0));
        if (none(inside)) continue;
        const LanesI number = select(inside, medium, LanesI(0));
        inside = inside & scatters(read_scattering(scene, number));
        append_hits(columns.random_walk_hits, random_walks, inside, hit);
        const LanesU path_index = as_uint(lane_numbers() + LanesI(i));
        random_walks = append_random_walks(columns, random_walks, inside, path, path_index);
    }
    return random_walks;
}

ScatterCounts scatter(const SceneView& scene,
                      const BatchSettings& batch,
                      const Flight& flight,
                      int count,
                      const ScatterColumns& columns) {
    ScatterCounts out;
    const bool has_points = flight.samples_lights && has_point_lights(scene);
    for (int i = 0; i < count; i += lane_count) {
        const Mask exists = lanes_in_range(i, count);
        PathLanes path = load_paths(columns.random_walks, i);
        HitLanes hit = load_hits(columns.random_walk_hits, i);
        const LanesU path_index = load(columns.path_index + i);
        const LanesI medium = select(exists, dominant_medium(path.medium_stack), LanesI(0));
        const Four<Lanes> extinction = read_medium(scene, medium);
        const Four<Lanes> scattering = read_scattering(scene, medium);
        // A ray that hits nothing inside (the mesh is open) counts as having left the medium.
        const Mask has_end = exists & (hit.primitive >= LanesI(0));
        WayThrough way{has_end,
                       hit.t,
                       {extinction.x, extinction.y, extinction.z},
                       {scattering.x, scattering.y, scattering.z},
                       channel_weights(path.throughput)};
        const FreeFlight<Lanes> free = sample_flight(
            way.extinction, way.albedo, way.probability, way.end_m, distance_random(path, flight));
        const Mask turns = has_end & (free.distance_m < hit.t);
        PathLanes next = scattered_path(path, free, scattering.w, flight);
        if (flight.samples_lights && !flight.last) {
            const WalkingBatch walk{scene, batch, flight};
            const Mask passable = samples_lights(walk, medium, extinction.w);
            const Mask sampled = turns & passable;
            way.exists = has_end & passable & Mask(has_points);
            if (any(sampled | way.exists)) {
                const PathLanes here = path;  // only a copy has an address
                const ScatteringPoint at{sampled,
                                         free.distance_m,
                                         next.throughput,
                                         scattering.w,
                                         turn_random(path, flight),
                                         here,
                                         way};
                add_light_samples(walk, at, columns, next, out.shadow);
            }
        }
        const Mask alive =
            turns & survives(flight, next) & (max_component(next.throughput) > Lanes(0.0f));
        const Mask goes_on = flight.last ? Mask(false) : alive;
        const Mask lost = turns & (!goes_on);
        path.throughput = select(has_end, path.throughput * free.passed, path.throughput);
        path.throughput = select(lost, splat3(Lanes(0.0f)), path.throughput);
        hit.primitive = select(lost, LanesI(-1), hit.primitive);
        // Read before the paths that stay are packed, which may overwrite this group.
        alignas(64) uint32_t path_indices[lane_count];
        store(path_indices, path_index);
        give_back(columns, {path_indices, exists & (!goes_on)}, path, hit);
        out.random_walks =
            append_random_walks(columns, out.random_walks, goes_on, next, path_index);
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
