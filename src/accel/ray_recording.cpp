// accel/ray_recording.cpp - records the rays of a rendering, to replay them on bare Embree.
// SPDX-License-Identifier: Apache-2.0
#include "accel/ray_recording.h"

#include "accel/alpha_filter.h"
#include "accel/safe_ray.h"

namespace obscura {

namespace {

void append(const RayColumns& rays, int index, uint32_t segment, RecordedRays& out) {
    out.ox.push_back(rays.ox[index]);
    out.oy.push_back(rays.oy[index]);
    out.oz.push_back(rays.oz[index]);
    out.dx.push_back(rays.dx[index]);
    out.dy.push_back(rays.dy[index]);
    out.dz.push_back(rays.dz[index]);
    if (rays.tfar != nullptr) out.tfar.push_back(rays.tfar[index]);
    out.key.push_back(rays.key != nullptr ? segment_key(rays.key[index], segment) : 0U);
}

void note_answer(bool hit, const Cutaway* cutaway, int index, RecordedRays& out) {
    out.hits += hit ? 1 : 0;
    out.spared += !hit && cutaway != nullptr && cuts(*cutaway, index) ? 1 : 0;
}

void append_hits(const RayColumns& rays,
                 const HitView& hits,
                 const SeeThrough& see_through,
                 const RayReach& reach,
                 RecordedRays& out) {
    for (int index = 0; index < rays.count; ++index) {
        if (!is_safe(rays, index, reach)) continue;
        append(rays, index, see_through.segment, out);
        note_answer(hits.primitive[index] >= 0, see_through.cutaway, index, out);
    }
}

}  // namespace

RayColumns RecordedRays::columns() const {
    const float* ends = tfar.empty() ? nullptr : tfar.data();
    return {ox.data(), oy.data(), oz.data(), dx.data(), dy.data(), dz.data(), ends, key.data(), 0};
}

void RayRecorder::add_hits(const RayColumns& rays, const HitView& hits, SeeThrough see_through) {
    fixed_alpha_ = see_through.fixed_alpha;
    const RayKind kind = see_through.segment == 0 ? RayKind::camera : RayKind::bounce;
    append_hits(rays, hits, see_through, reach_, list(kind));
}

void RayRecorder::add_shadow_hits(const RayColumns& rays,
                                  const HitView& hits,
                                  SeeThrough see_through) {
    append_hits(rays, hits, see_through, reach_, shadow_hits_);
}

void RayRecorder::add_shadows(const RayColumns& rays,
                              const uint8_t* occluded,
                              const ShadowQuery& query) {
    RecordedRays& out = list(RayKind::shadow);
    passes_thin_walls_ = query.thin_walls != nullptr;
    for (int index = 0; index < rays.count; ++index) {
        if (!is_safe(rays, index, reach_)) continue;
        append(rays, index, query.segment, out);
        note_answer(occluded[index] != 0, query.cutaway, index, out);
    }
}

uint64_t RayRecording::count(RayKind kind) const {
    uint64_t sum = 0;
    for (const auto& thread : threads) {
        sum += thread->rays(kind).count();
        if (kind == RayKind::shadow) sum += thread->shadow_hits().count();
    }
    return sum;
}

uint64_t RayRecording::spared(RayKind kind) const {
    uint64_t sum = 0;
    for (const auto& thread : threads) {
        sum += thread->rays(kind).spared;
        if (kind == RayKind::shadow) sum += thread->shadow_hits().spared;
    }
    return sum;
}

uint64_t RayRecording::hits(RayKind kind) const {
    uint64_t sum = 0;
    for (const auto& thread : threads) {
        sum += thread->rays(kind).hits;
        if (kind == RayKind::shadow) sum += thread->shadow_hits().hits;
    }
    return sum;
}

}  // namespace obscura
