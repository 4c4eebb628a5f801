// accel/replay.cpp - recorded rays through bare Embree: the time below which no renderer can go.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/ray_recording.h"
#include "accel/safe_ray.h"
#include "base/parallel.h"
#include "base/stopwatch.h"

#include <algorithm>
#include <bit>

namespace obscura {

namespace {

constexpr size_t packet = 16;
/// Rays that a thread takes at a time: long enough that handing them out costs nothing.
constexpr size_t chunk_rays = 4096;

/// Some rows of one thread's recording.
struct Chunk {
    const RecordedRays* rays;
    bool fixed_alpha;
    size_t begin, end;
};

struct Tally {
    uint64_t hits = 0;
    uint64_t checksum = 0;
};

std::vector<Chunk> cut_chunks(const RayRecording& recording, RayKind kind) {
    std::vector<Chunk> chunks;
    for (const auto& thread : recording.threads) {
        const RecordedRays& rays = thread->rays(kind);
        for (size_t begin = 0; begin < rays.count(); begin += chunk_rays) {
            const size_t end = std::min(begin + chunk_rays, rays.count());
            chunks.push_back({&rays, thread->fixed_alpha(), begin, end});
        }
    }
    return chunks;
}

/// The alpha filters see the ray's key through the context; the recorded keys hold the segment.
void give_keys(QueryContext& context, const Chunk& chunk) {
    context.keys = chunk.rays->key.data();
    context.fixed_threshold = chunk.fixed_alpha;
}

/// Loads rows [first, first + count) of a column; the lanes behind them repeat the first. Whole
/// packets are copied with a length that the compiler knows.
void load_column(const float* column, size_t first, size_t count, float* out) {
    if (count == packet) {
        std::copy_n(column + first, packet, out);
        return;
    }
    std::copy_n(column + first, count, out);
    std::fill_n(out + count, packet - count, column[first]);
}

void load_sixteen(const RayColumns& rays, size_t first, size_t count, RTCRay16& out) {
    load_column(rays.ox, first, count, out.org_x);
    load_column(rays.oy, first, count, out.org_y);
    load_column(rays.oz, first, count, out.org_z);
    load_column(rays.dx, first, count, out.dir_x);
    load_column(rays.dy, first, count, out.dir_y);
    load_column(rays.dz, first, count, out.dir_z);
    if (rays.tfar != nullptr) {
        load_column(rays.tfar, first, count, out.tfar);
    } else {
        std::fill_n(out.tfar, packet, unlimited);
    }
    for (size_t i = 0; i < packet; ++i) {
        out.tnear[i] = 0.0f;
        out.time[i] = 0.0f;
        out.mask[i] = 0xFFFFFFFFU;
        out.id[i] = static_cast<unsigned>(first + i);
        out.flags[i] = 0;
    }
}

Tally intersect_one_by_one(RTCScene scene, const Chunk& chunk) {
    QueryContext context;
    Query query(context, false);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    for (size_t row = chunk.begin; row < chunk.end; ++row) {
        RTCRayHit ray;
        load_ray(rays, static_cast<int>(row), ray.ray);
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
    for (size_t row = chunk.begin; row < chunk.end; ++row) {
        RTCRay ray;
        load_ray(rays, static_cast<int>(row), ray);
        query.occluded1(scene, &ray);
        tally.hits += ray.tfar < 0.0f ? 1 : 0;
    }
    tally.checksum = tally.hits;
    return tally;
}

/// Which of the 16 lanes hold a ray.
struct alignas(64) Lanes16 {
    explicit Lanes16(size_t count) {
        std::fill_n(valid, packet, 0);
        std::fill_n(valid, count, -1);
    }
    int valid[packet];
};

Tally intersect_sixteen(RTCScene scene, const Chunk& chunk, bool coherent) {
    QueryContext context;
    Query query(context, coherent);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    for (size_t first = chunk.begin; first < chunk.end; first += packet) {
        const size_t count = std::min(packet, chunk.end - first);
        const Lanes16 lanes(count);
        RTCRayHit16 block;
        load_sixteen(rays, first, count, block.ray);
        std::fill_n(block.hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(block.hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
        query.intersect16(lanes.valid, scene, &block);
        for (size_t i = 0; i < count; ++i) {
            const bool hit = block.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            tally.hits += hit ? 1 : 0;
            tally.checksum += hit ? std::bit_cast<uint32_t>(block.ray.tfar[i]) : 0U;
        }
    }
    return tally;
}

Tally occlude_sixteen(RTCScene scene, const Chunk& chunk, bool coherent) {
    QueryContext context;
    Query query(context, coherent);
    give_keys(context, chunk);
    const RayColumns rays = chunk.rays->columns();
    Tally tally;
    for (size_t first = chunk.begin; first < chunk.end; first += packet) {
        const size_t count = std::min(packet, chunk.end - first);
        const Lanes16 lanes(count);
        RTCRay16 block;
        load_sixteen(rays, first, count, block);
        query.occluded16(lanes.valid, scene, &block);
        for (size_t i = 0; i < count; ++i)
            tally.hits += block.tfar[i] < 0.0f ? 1 : 0;
    }
    tally.checksum = tally.hits;
    return tally;
}

Tally replay_chunk(RTCScene scene, const Chunk& chunk, bool any_hit, ReplayWay way) {
    if (way == ReplayWay::single) {
        return any_hit ? occlude_one_by_one(scene, chunk) : intersect_one_by_one(scene, chunk);
    }
    const bool coherent = way == ReplayWay::coherent_packets;
    return any_hit ? occlude_sixteen(scene, chunk, coherent)
                   : intersect_sixteen(scene, chunk, coherent);
}

}  // namespace

ReplayResult Accel::replay(const RayRecording& recording, RayKind kind, ReplayWay way) const {
    const bool any_hit = kind == RayKind::shadow;
    // On instances the coherent kernel of Embree 3.13 for AVX-512 may never come back.
    if (any_hit && impl_->has_instances && way == ReplayWay::coherent_packets) {
        way = ReplayWay::packets;
    }
    const std::vector<Chunk> chunks = cut_chunks(recording, kind);
    std::atomic<uint64_t> hits = 0;
    std::atomic<uint64_t> checksum = 0;
    const Stopwatch replaying;
    parallel_for(chunks.size(), [&](size_t i) {
        const Tally tally = replay_chunk(impl_->top, chunks[i], any_hit, way);
        hits.fetch_add(tally.hits, std::memory_order_relaxed);
        checksum.fetch_add(tally.checksum, std::memory_order_relaxed);
    });
    return {replaying.seconds(), hits.load(), checksum.load()};
}

}  // namespace obscura
