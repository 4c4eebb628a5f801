// stages/2_scatter.cpp - stage 2, inside bodies that scatter light: one flight of each path.
// SPDX-License-Identifier: Apache-2.0
#include "stages/2_scatter.h"

#include "math/sampler.h"
#include "stages/3_media.h"
#include "surface/scattering.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Flights before weak paths are given up now and then.
constexpr int flights_before_roulette = 16;

/// What a flight's random numbers are for.
enum class FlightUse : uint32_t { channel, distance, angle, turn, roulette, count };

/// Flights have no place in the pixel's Sobol points, of which there is a pair a bounce: theirs are
/// hashed.
OBSCURA_INLINE Lanes flight_random(LanesU path_key, const Flight& flight, FlightUse use) {
    const uint32_t number =
        (static_cast<uint32_t>(flight.bounce) << 20U) +
        static_cast<uint32_t>(flight.number) * static_cast<uint32_t>(FlightUse::count) +
        static_cast<uint32_t>(use);
    const uint32_t salt = hash_word(number ^ 0x53434154U);
    return unit_float<Lanes>(hash_word(LanesU(path_key ^ LanesU(salt))));
}

/// Each channel's share of a path's light.
OBSCURA_INLINE Vec3<Lanes> channel_shares(const Vec3<Lanes>& throughput) {
    const Lanes sum = throughput.x + throughput.y + throughput.z;
    const Mask dark = sum <= Lanes(0.0f);
    const Vec3<Lanes> share = throughput * (Lanes(1.0f) / select(dark, Lanes(1.0f), sum));
    return select(dark, splat3(Lanes(1.0f / 3.0f)), share);
}

OBSCURA_INLINE PathLanes scattered_path(const PathLanes& path,
                                        const FreeFlight<Lanes>& free,
                                        Lanes anisotropy,
                                        const Flight& flight) {
    const auto random = [&](FlightUse use) { return flight_random(path.path_key, flight, use); };
    PathLanes next = path;
    next.origin = path.origin + path.direction * free.distance_m;
    next.direction = scatter_direction(
        path.direction, anisotropy, {random(FlightUse::angle), random(FlightUse::turn)});
    next.throughput = path.throughput * free.scattered;
    next.pdf = Lanes(0.0f);  // no light is sampled here: what the ray finds counts in full
    next.cone_width = path.cone_width + path.cone_spread * free.distance_m;
    next.cone_spread = max(path.cone_spread, Lanes(0.5f));
    return next;
}

/// Weak paths end with some probability; the others take over their light.
OBSCURA_INLINE Mask survives(const Flight& flight, PathLanes& path) {
    if (flight.number < flights_before_roulette) return Mask(true);
    const Lanes chance = clamp(max_component(path.throughput), Lanes(0.05f), Lanes(1.0f));
    path.throughput = path.throughput * (Lanes(1.0f) / chance);
    return flight_random(path.path_key, flight, FlightUse::roulette) < chance;
}

/// Writes lanes to the rows that they came from.
class RowWriter {
public:
    OBSCURA_INLINE RowWriter(const uint32_t* rows, Mask mask) : rows_(rows), mask_(mask) {}

    template <typename L, typename Word>
    OBSCURA_INLINE void operator()(const L& value, Word* column) const {
        alignas(64) Word lanes[lane_count];
        store(lanes, value);
        for (uint32_t bits = mask_bits(mask_); bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            column[rows_[lane]] = lanes[lane];
        }
    }
    OBSCURA_INLINE void operator()(const Vec3<Lanes>& v, float* x, float* y, float* z) const {
        (*this)(v.x, x);
        (*this)(v.y, y);
        (*this)(v.z, z);
    }
    /// A flight does not change which path it is, nor what it travels in.
    OBSCURA_INLINE void operator()(const LanesU&, uint32_t*) const {}

private:
    const uint32_t* rows_;
    Mask mask_;
};

/// What a flight can change of a path, and the hit that it ended at.
OBSCURA_INLINE void give_back(const ScatterRows& rows,
                              const RowWriter& write,
                              const PathLanes& path,
                              const HitLanes& hit) {
    PathRows::for_each_field(write, path, rows.paths);
    HitRows::for_each_field(write, hit, rows.hits);
}

template <typename Rows>
OBSCURA_INLINE int append_walkers(
    const Rows& rows, int at, Mask mask, const PathLanes& path, LanesU row) {
    const Packer packer(mask);
    store(rows.row + at, pack(packer, row));
    return append_paths(rows.walkers, at, mask, path);
}

}  // namespace

int begin_scatter(const SceneView& scene, int count, const ScatterStart& rows) {
    int walkers = 0;
    for (int i = 0; i < count; i += lane_count) {
        const PathLanes path = load_paths(rows.paths, i);
        const HitLanes hit = load_hits(rows.hits, i);
        const LanesI body = filling_body(path.bodies);
        Mask inside = rows_in_range(i, count) & (hit.primitive >= LanesI(0)) & (body > LanesI(0));
        if (none(inside)) continue;
        const LanesI number = select(inside, body, LanesI(0));
        inside = inside & scatters(read_scattering(scene, number));
        append_hits(rows.walker_hits, walkers, inside, hit);
        const LanesU row = as_uint(lane_numbers() + LanesI(i));
        walkers = append_walkers(rows, walkers, inside, path, row);
    }
    return walkers;
}

int scatter(const SceneView& scene, const Flight& flight, int count, const ScatterRows& rows) {
    int stay = 0;
    for (int i = 0; i < count; i += lane_count) {
        const Mask exists = rows_in_range(i, count);
        PathLanes path = load_paths(rows.walkers, i);
        HitLanes hit = load_hits(rows.walker_hits, i);
        const LanesU row = load(rows.row + i);
        const LanesI body = select(exists, filling_body(path.bodies), LanesI(0));
        const Four<Lanes> medium = read_medium(scene, body);
        const Four<Lanes> scattering = read_scattering(scene, body);
        const Vec2<Lanes> u{flight_random(path.path_key, flight, FlightUse::channel),
                            flight_random(path.path_key, flight, FlightUse::distance)};
        const FreeFlight<Lanes> free = sample_flight({medium.x, medium.y, medium.z},
                                                     {scattering.x, scattering.y, scattering.z},
                                                     channel_shares(path.throughput),
                                                     hit.t,
                                                     u);
        // Where a body is open, its inside has no end: what finds none is as if it had left.
        const Mask has_end = exists & (hit.primitive >= LanesI(0));
        const Mask turns = has_end & (free.distance_m < hit.t);
        PathLanes next = scattered_path(path, free, scattering.w, flight);
        const Mask alive =
            turns & survives(flight, next) & (max_component(next.throughput) > Lanes(0.0f));
        const Mask goes_on = flight.last ? Mask(false) : alive;
        const Mask lost = turns & (!goes_on);
        path.throughput = select(has_end, path.throughput * free.passed, path.throughput);
        path.throughput = select(lost, splat3(Lanes(0.0f)), path.throughput);
        hit.primitive = select(lost, LanesI(-1), hit.primitive);
        // Before the walkers that stay are packed: they may be written over this group's rows.
        alignas(64) uint32_t row_numbers[lane_count];
        store(row_numbers, row);
        give_back(rows, {row_numbers, exists & (!goes_on)}, path, hit);
        stay = append_walkers(rows, stay, goes_on, next, row);
    }
    return stay;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
