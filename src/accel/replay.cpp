// accel/replay.cpp - replays recorded rays on bare Embree: the lower bound of a renderer's time.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/coherent_stream.h"
#include "accel/packets.h"
#include "accel/ray_recording.h"
#include "accel/safe_ray.h"
#include "base/parallel.h"
#include "base/stopwatch.h"

#include <algorithm>
#include <bit>

namespace obscura {

namespace {

/// Rays that a thread takes at a time: enough to make scheduling free.
constexpr size_t chunk_rays = 4096;

/// A range of one thread's recording.
struct Chunk {
    const RecordedRays* rays;
    bool fixed_alpha, passes_thin_walls, any_hit;
    uint8_t passes;  ///< see SeeThrough
    size_t begin, end;
};

struct Tally {
    uint64_t hits = 0;
    uint64_t checksum = 0;
};

std::vector<Chunk> cut_chunks(const RayRecording& recording, RayKind kind) {
    std::vector<Chunk> chunks;
    const auto cut = [&](Chunk chunk) {
        for (size_t begin = 0; begin < chunk.rays->count(); begin += chunk_rays) {
            chunk.begin = begin;
            chunk.end = std::min(begin + chunk_rays, chunk.rays->count());
            chunks.push_back(chunk);
        }
    };
    const bool shadow = kind == RayKind::shadow;
    const uint8_t passes = shadow                    ? shadow_rays_pass
                           : kind == RayKind::camera ? camera_rays_pass
                                                     : bounce_rays_pass;
    for (const auto& thread : recording.threads) {
        const bool fixed = thread->fixed_alpha();
        cut({&thread->rays(kind), fixed, thread->passes_thin_walls(), shadow, passes, 0, 0});
        if (shadow) cut({&thread->shadow_hits(), fixed, false, false, passes, 0, 0});
    }
    return chunks;
}

/// Alpha filters read the ray's key from the context; recorded keys already include the segment.
void give_keys(QueryContext& context, const Chunk& chunk) {
    context.keys = chunk.rays->key.data();
    context.fixed_threshold = chunk.fixed_alpha;
    context.passes_thin_walls = chunk.passes_thin_walls;
    context.passes = chunk.passes;
}

/// Loads rays [first, first + count); the remaining lanes repeat the first.
void load_sixteen(
    const Accel::Impl& impl, const RayColumns& rays, int first, int count, RTCRay16& out) {
    if (count == packet && impl.functions.packets->load(rays, first, impl.reach, out)) return;
    for (int i = 0; i < packet; ++i)
        load_lane(rays, i < count ? first + i : first, i, out);
}

Tally intersect_one_by_one(RTCScene scene, const Chunk& chunk) {
    QueryContext context;
    Query query(context, false);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    for (size_t index = chunk.begin; index < chunk.end; ++index) {
        RTCRayHit ray;
        load_ray(rays, static_cast<int>(index), ray.ray);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        query.intersect1(scene, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
        ++tally.hits;
        tally.checksum += std::bit_cast<uint32_t>(ray.ray.tfar);
    }
    return tally;
}

Tally occlude_one_by_one(RTCScene scene, const Chunk& chunk) {
    QueryContext context;
    Query query(context, false);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    for (size_t index = chunk.begin; index < chunk.end; ++index) {
        RTCRay ray;
        load_ray(rays, static_cast<int>(index), ray);
        query.occluded1(scene, &ray);
        tally.hits += ray.tfar < 0.0f ? 1 : 0;
    }
    tally.checksum = tally.hits;
    return tally;
}

ValidMask first_lanes(int count) {
    ValidMask valid;
    std::fill_n(valid.lane, packet, 0);
    std::fill_n(valid.lane, count, -1);
    return valid;
}

void add_hits(const RTCRayHit16& block, int count, Tally& tally) {
    for (int i = 0; i < count; ++i) {
        const bool hit = block.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        tally.hits += hit ? 1 : 0;
        tally.checksum += hit ? std::bit_cast<uint32_t>(block.ray.tfar[i]) : 0U;
    }
}

/// Loads rays as hits to be found.
void load_unhit(
    const Accel::Impl& impl, const RayColumns& rays, int first, int count, RTCRayHit16& out) {
    load_sixteen(impl, rays, first, count, out.ray);
    std::fill_n(out.hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(out.hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
}

Tally intersect_streams(const Accel::Impl& impl, const Chunk& chunk) {
    QueryContext context;
    Query query(context, true);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    RTCRayHit16 blocks[stream_packets];
    for (RTCRayHit16& block : blocks)
        begin_packets(block.ray);
    const auto end = static_cast<int>(chunk.end);
    for (auto first = static_cast<int>(chunk.begin); first < end;) {
        int counts[stream_packets];
        for (int k = 0; k < stream_packets; ++k) {
            // Where there are no rays left, the last one is traced again, and not counted.
            counts[k] = std::clamp(end - first, 0, packet);
            load_unhit(impl, rays, std::min(first, end - 1), std::max(counts[k], 1), blocks[k]);
            first += packet;
        }
        intersect_stream(query, impl.top, impl.stream_width, blocks);
        for (int k = 0; k < stream_packets; ++k)
            add_hits(blocks[k], counts[k], tally);
    }
    return tally;
}

Tally intersect_sixteen(const Accel::Impl& impl, const Chunk& chunk, bool coherent) {
    QueryContext context;
    Query query(context, coherent);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    RTCRayHit16 block;
    begin_packets(block.ray);
    const auto end = static_cast<int>(chunk.end);
    for (auto first = static_cast<int>(chunk.begin); first < end; first += packet) {
        const int count = std::min(packet, end - first);
        const ValidMask valid = first_lanes(count);
        load_unhit(impl, rays, first, count, block);
        query.intersect16(valid.lane, impl.top, &block);
        add_hits(block, count, tally);
    }
    return tally;
}

Tally occlude_sixteen(const Accel::Impl& impl, const Chunk& chunk, bool coherent) {
    QueryContext context;
    Query query(context, coherent);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    RTCRay16 block;
    begin_packets(block);
    const auto end = static_cast<int>(chunk.end);
    for (auto first = static_cast<int>(chunk.begin); first < end; first += packet) {
        const int count = std::min(packet, end - first);
        const ValidMask valid = first_lanes(count);
        load_sixteen(impl, rays, first, count, block);
        query.occluded16(valid.lane, impl.top, &block);
        for (int i = 0; i < count; ++i)
            tally.hits += block.tfar[i] < 0.0f ? 1 : 0;
    }
    tally.checksum = tally.hits;
    return tally;
}

Tally replay_chunk(const Accel::Impl& impl, const Chunk& chunk, ReplayMode mode) {
    if (mode == ReplayMode::single) {
        return chunk.any_hit ? occlude_one_by_one(impl.top, chunk)
                             : intersect_one_by_one(impl.top, chunk);
    }
    if (mode == ReplayMode::coherent_streams) return intersect_streams(impl, chunk);
    const bool coherent = mode == ReplayMode::coherent_packets;
    return chunk.any_hit ? occlude_sixteen(impl, chunk, coherent)
                         : intersect_sixteen(impl, chunk, coherent);
}

}  // namespace

ReplayResult Accel::replay(const RayRecording& recording, RayKind kind, ReplayMode mode) const {
    const bool has_streams = impl_->stream_width > 0 && !impl_->has_instances;
    if (mode == ReplayMode::coherent_streams && (kind == RayKind::shadow || !has_streams))
        mode = ReplayMode::coherent_packets;
    // With instances, the coherent AVX-512 kernel of Embree 3.13 may hang.
    if (kind == RayKind::shadow && impl_->has_instances && mode == ReplayMode::coherent_packets) {
        mode = ReplayMode::packets;
    }
    const std::vector<Chunk> chunks = cut_chunks(recording, kind);
    std::atomic<uint64_t> hits = 0;
    std::atomic<uint64_t> checksum = 0;
    const Stopwatch replaying;
    parallel_for(chunks.size(), [&](size_t i) {
        const Tally tally = replay_chunk(*impl_, chunks[i], mode);
        hits.fetch_add(tally.hits, std::memory_order_relaxed);
        checksum.fetch_add(tally.checksum, std::memory_order_relaxed);
    });
    return {replaying.seconds(), hits.load(), checksum.load()};
}

}  // namespace obscura
