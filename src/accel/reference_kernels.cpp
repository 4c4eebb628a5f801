// accel/reference_kernels.cpp - Embree called with 1, 4, 8 and 16 rays, for the cross-check.
// SPDX-License-Identifier: Apache-2.0
#include "accel/reference_kernels.h"

#include "accel/accel_impl.h"
#include "accel/infinite_planes.h"
#include "accel/safe_ray.h"
#include "accel/scene_records.h"
#include "base/cpu.h"

#include <algorithm>

namespace obscura {

namespace {

/// Packets of one width: all have the same members.
template <int width>
struct Packet;
template <>
struct Packet<4> {
    using Rays = RTCRay4;
    using Hits = RTCRayHit4;
};
template <>
struct Packet<8> {
    using Rays = RTCRay8;
    using Hits = RTCRayHit8;
};
template <>
struct Packet<16> {
    using Rays = RTCRay16;
    using Hits = RTCRayHit16;
};

template <int width>
struct alignas(64) Valid {
    int lane[width];
    bool any = false;
};

/// The common arguments of the calls of one query.
struct Asked {
    const Accel::Impl& impl;
    const RayColumns& rays;
    QueryContext& context;
    Query& query;
    const NormalColumns* normals = nullptr;
};

/// Loads rays from `first` on. Idle lanes repeat a valid one because Embree may read them.
template <int width>
Valid<width> load_packet(const Asked& asked, int first, typename Packet<width>::Rays& out) {
    const RayColumns& rays = asked.rays;
    Valid<width> valid;
    int stand_in = -1;
    for (int i = 0; i < width; ++i) {
        valid.lane[i] =
            first + i < rays.count && is_safe(rays, first + i, asked.impl.reach) ? -1 : 0;
        if (valid.lane[i] != 0 && stand_in < 0) stand_in = first + i;
    }
    valid.any = stand_in >= 0;
    if (!valid.any) return valid;
    for (int i = 0; i < width; ++i) {
        RTCRay one;
        load_ray(rays, valid.lane[i] != 0 ? first + i : stand_in, one);
        out.org_x[i] = one.org_x;
        out.org_y[i] = one.org_y;
        out.org_z[i] = one.org_z;
        out.dir_x[i] = one.dir_x;
        out.dir_y[i] = one.dir_y;
        out.dir_z[i] = one.dir_z;
        out.tnear[i] = one.tnear;
        out.tfar[i] = one.tfar;
        out.time[i] = one.time;
        out.mask[i] = one.mask;
        out.id[i] = static_cast<unsigned>(first + i);
        out.flags[i] = one.flags;
    }
    return valid;
}

void ask(Query& query, const int* valid, RTCScene scene, RTCRayHit4& rays) {
    query.intersect4(valid, scene, &rays);
}
void ask(Query& query, const int* valid, RTCScene scene, RTCRayHit8& rays) {
    query.intersect8(valid, scene, &rays);
}
void ask(Query& query, const int* valid, RTCScene scene, RTCRayHit16& rays) {
    query.intersect16(valid, scene, &rays);
}
void ask(Query& query, const int* valid, RTCScene scene, RTCRay4& rays) {
    query.occluded4(valid, scene, &rays);
}
void ask(Query& query, const int* valid, RTCScene scene, RTCRay8& rays) {
    query.occluded8(valid, scene, &rays);
}
void ask(Query& query, const int* valid, RTCScene scene, RTCRay16& rays) {
    query.occluded16(valid, scene, &rays);
}

void store(const Asked& asked, const RTCRayHit& one, const HitColumns& hits, int index) {
    store_hit(asked.impl, one, hits, index);
    if (asked.normals == nullptr || one.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    asked.normals->x[index] = one.hit.Ng_x;
    asked.normals->y[index] = one.hit.Ng_y;
    asked.normals->z[index] = one.hit.Ng_z;
}

template <int width>
void intersect_packets(const Asked& asked, const HitColumns& hits) {
    typename Packet<width>::Hits block;
    for (int first = 0; first < asked.rays.count; first += width) {
        const Valid<width> valid = load_packet<width>(asked, first, block.ray);
        std::fill_n(block.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(block.hit.instID[0], width, RTC_INVALID_GEOMETRY_ID);
        if (valid.any) ask(asked.query, valid.lane, asked.impl.top, block);
        for (int i = 0; i < width && first + i < asked.rays.count; ++i) {
            RTCRayHit one;
            one.ray.tfar = block.ray.tfar[i];
            one.hit.Ng_x = block.hit.Ng_x[i];
            one.hit.Ng_y = block.hit.Ng_y[i];
            one.hit.Ng_z = block.hit.Ng_z[i];
            one.hit.u = block.hit.u[i];
            one.hit.v = block.hit.v[i];
            one.hit.primID = block.hit.primID[i];
            one.hit.geomID = valid.lane[i] != 0 ? block.hit.geomID[i] : RTC_INVALID_GEOMETRY_ID;
            one.hit.instID[0] = block.hit.instID[0][i];
            store(asked, one, hits, first + i);
        }
    }
}

void intersect_one_by_one(const Asked& asked, const HitColumns& hits) {
    for (int index = 0; index < asked.rays.count; ++index) {
        RTCRayHit one;
        one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (is_safe(asked.rays, index, asked.impl.reach)) {
            load_ray(asked.rays, index, one.ray);
            asked.query.intersect1(asked.impl.top, &one);
        }
        store(asked, one, hits, index);
    }
}

template <int width>
void occlude_packets(const Asked& asked, uint8_t* occluded) {
    typename Packet<width>::Rays block;
    for (int first = 0; first < asked.rays.count; first += width) {
        const Valid<width> valid = load_packet<width>(asked, first, block);
        if (valid.any) ask(asked.query, valid.lane, asked.impl.top, block);
        for (int i = 0; i < width && first + i < asked.rays.count; ++i) {
            occluded[first + i] = valid.lane[i] != 0 && block.tfar[i] < 0.0f ? 1 : 0;
        }
    }
}

void occlude_one_by_one(const Asked& asked, uint8_t* occluded) {
    for (int index = 0; index < asked.rays.count; ++index) {
        occluded[index] = 0;
        if (!is_safe(asked.rays, index, asked.impl.reach)) continue;
        RTCRay one;
        load_ray(asked.rays, index, one);
        asked.query.occluded1(asked.impl.top, &one);
        occluded[index] = one.tfar < 0.0f ? 1 : 0;
    }
}

}  // namespace

std::vector<std::string> embree_isas() {
    std::vector<std::string> out;
    if (cpu_has_sse42()) {
        out = {"sse2", "sse4.2"};
    }
    if (cpu_has_avx()) out.emplace_back("avx");
    if (cpu_has_avx2()) out.emplace_back("avx2");
    if (cpu_has_avx512()) out.emplace_back("avx512");
    return out;
}

Result<ReferenceKernels> ReferenceKernels::build(const Scene& scene, const KernelChoice& choice) {
    auto impl = build_impl(scene, choice);
    if (!impl) return fail(impl.error());
    return ReferenceKernels(std::shared_ptr<const Accel::Impl>(std::move(*impl)));
}

void ReferenceKernels::intersect(const RayColumns& rays,
                                 const HitColumns& hits,
                                 int width,
                                 const NormalColumns* normals) const {
    QueryContext context;
    Query query(context, false);
    context.keys = rays.key;
    const Asked asked{*impl_, rays, context, query, normals};
    if (width == 16) intersect_packets<16>(asked, hits);
    if (width == 8) intersect_packets<8>(asked, hits);
    if (width == 4) intersect_packets<4>(asked, hits);
    if (width == 1) intersect_one_by_one(asked, hits);
    if (impl_->infinite_planes.empty()) return;
    for (int index = 0; index < rays.count; ++index) {
        if (is_safe(rays, index, impl_->reach))
            meet_infinite_planes(*impl_, context, rays, hits, index);
    }
}

void ReferenceKernels::occluded(const RayColumns& rays, uint8_t* occluded, int width) const {
    QueryContext context;
    Query query(context, false);
    context.keys = rays.key;
    const Asked asked{*impl_, rays, context, query};
    if (width == 16) occlude_packets<16>(asked, occluded);
    if (width == 8) occlude_packets<8>(asked, occluded);
    if (width == 4) occlude_packets<4>(asked, occluded);
    if (width == 1) occlude_one_by_one(asked, occluded);
    if (impl_->infinite_planes.empty()) return;
    for (int index = 0; index < rays.count; ++index) {
        if (occluded[index] != 0 || !is_safe(rays, index, impl_->reach)) continue;
        occluded[index] = infinite_plane_occludes(*impl_, context, rays, index) ? 1 : 0;
    }
}

}  // namespace obscura
