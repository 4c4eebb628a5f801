// accel/queries.cpp - columns of rays through Embree, in packets of 16 or one at a time.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/safe_ray.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr int packet = 16;

struct alignas(64) ValidMask {
    int lane[packet];
};

/// Marks the rows [first, first + 16) that exist and are safe; counts the refused ones.
int mark_valid(const RayColumns& rays, int first, ValidMask& valid) {
    int refused = 0;
    for (int i = 0; i < packet; ++i) {
        const int row = first + i;
        const bool exists = row < rays.count;
        const bool safe = exists && is_safe(rays, row);
        valid.lane[i] = safe ? -1 : 0;
        refused += exists && !safe ? 1 : 0;
    }
    return refused;
}

/// Reads a column of the packet's rows. Idle lanes repeat the row of `stand_in`, for Embree sees
/// them too: where its packets are narrower than 16 it takes all 16 rays whatever the mask says.
void load_column(const float* column, int first, const ValidMask& valid, int stand_in, float* out) {
    for (int i = 0; i < packet; ++i)
        out[i] = column[first + (valid.lane[i] != 0 ? i : stand_in)];
}

/// False when no lane is valid; then `out` is left as it was.
bool load_packet(const RayColumns& rays, int first, const ValidMask& valid, RTCRay16& out) {
    const int* found = std::find(valid.lane, valid.lane + packet, -1);
    if (found == valid.lane + packet) return false;
    const auto stand_in = static_cast<int>(found - valid.lane);
    load_column(rays.ox, first, valid, stand_in, out.org_x);
    load_column(rays.oy, first, valid, stand_in, out.org_y);
    load_column(rays.oz, first, valid, stand_in, out.org_z);
    load_column(rays.dx, first, valid, stand_in, out.dir_x);
    load_column(rays.dy, first, valid, stand_in, out.dir_y);
    load_column(rays.dz, first, valid, stand_in, out.dir_z);
    if (rays.tfar != nullptr) load_column(rays.tfar, first, valid, stand_in, out.tfar);
    for (int i = 0; i < packet; ++i) {
        out.tnear[i] = 0.0f;
        if (rays.tfar == nullptr) out.tfar[i] = unlimited;
        out.time[i] = 0.0f;
        out.mask[i] = 0xFFFFFFFFU;
        out.id[i] = static_cast<unsigned>(first + i);
        out.flags[i] = 0;
    }
    return true;
}

void load_ray(const RayColumns& rays, int row, RTCRay& out) {
    out.org_x = rays.ox[row];
    out.org_y = rays.oy[row];
    out.org_z = rays.oz[row];
    out.dir_x = rays.dx[row];
    out.dir_y = rays.dy[row];
    out.dir_z = rays.dz[row];
    out.tnear = 0.0f;
    out.tfar = rays.tfar != nullptr ? rays.tfar[row] : unlimited;
    out.time = 0.0f;
    out.mask = 0xFFFFFFFFU;
    out.id = static_cast<unsigned>(row);
    out.flags = 0;
}

/// What a hit lies on, as rows of the scene's tables.
struct SceneRows {
    int32_t instance = -1;
    int32_t primitive = -1;
};

SceneRows scene_rows(const Accel::Impl& impl, unsigned geometry, unsigned instance_id) {
    const auto first = static_cast<int32_t>(geometry);
    if (instance_id == RTC_INVALID_GEOMETRY_ID) return {-1, first};
    const int32_t instance = static_cast<int32_t>(instance_id) - impl.scene->world_primitive_count;
    return {instance, first + impl.instance_first_primitive[static_cast<size_t>(instance)]};
}

/// Writes one row from what Embree found.
void store_hit(const Accel::Impl& impl, const RTCRayHit& ray, const HitColumns& hits, int row) {
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        hits.primitive[row] = -1;
        return;
    }
    const SceneRows rows = scene_rows(impl, ray.hit.geomID, ray.hit.instID[0]);
    hits.t[row] = ray.ray.tfar;
    hits.u[row] = ray.hit.u;
    hits.v[row] = ray.hit.v;
    hits.instance[row] = rows.instance;
    hits.primitive[row] = rows.primitive;
    hits.triangle[row] = static_cast<int32_t>(ray.hit.primID);
}

/// True when the hit is the back of a single-sided surface. Embree's Ng is in object space, and a
/// mirroring instance turns both the winding and glTF's rule: only the object-space sign matters.
bool is_hidden_back(const Accel::Impl& impl,
                    const SceneRows& rows,
                    const Vec3f& ng,
                    const Vec3f& direction_world) {
    if (impl.single_sided[static_cast<size_t>(rows.primitive)] == 0) return false;
    if (rows.instance < 0) return dot(ng, direction_world) > 0.0f;
    const Instance& instance = impl.scene->instances[static_cast<size_t>(rows.instance)];
    return dot(ng, transform_vector(instance.object_from_world, direction_world)) > 0.0f;
}

/// A query of one ray that passes hidden backs. The common part must come first.
struct CullingContext {
    QueryContext common;
    const Accel::Impl* impl;
    Vec3f direction_world;
};

/// Embree filter function: hidden backs do not count.
void pass_hidden_backs(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const CullingContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const SceneRows rows = scene_rows(*context.impl,
                                          RTCHitN_geomID(args->hit, args->N, i),
                                          RTCHitN_instID(args->hit, args->N, i, 0));
        const Vec3f ng{RTCHitN_Ng_x(args->hit, args->N, i),
                       RTCHitN_Ng_y(args->hit, args->N, i),
                       RTCHitN_Ng_z(args->hit, args->N, i)};
        if (is_hidden_back(*context.impl, rows, ng, context.direction_world)) args->valid[i] = 0;
    }
}

/// Traces a camera ray that met a hidden back again, from its start: what lies behind the back or
/// in the very same plane may be the first surface that the ray can see.
void look_behind(const Accel::Impl& impl,
                 const QueryContext& common,
                 const RayColumns& rays,
                 const HitColumns& hits,
                 int row) {
    CullingContext context{common, &impl, {rays.dx[row], rays.dy[row], rays.dz[row]}};
    Query query(context.common, false);
    query.set_filter(pass_hidden_backs);
    RTCRayHit ray;
    load_ray(rays, row, ray.ray);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect1(impl.top, &ray);
    store_hit(impl, ray, hits, row);
}

int intersect_packets(const Accel::Impl& impl,
                      QueryContext& context,
                      const RayColumns& rays,
                      const HitColumns& hits,
                      bool culls_back_faces) {
    Query query(context, true);
    int refused = 0;
    for (int first = 0; first < rays.count; first += packet) {
        ValidMask valid;
        RTCRayHit16 block;
        refused += mark_valid(rays, first, valid);
        const bool any_valid = load_packet(rays, first, valid, block.ray);
        for (int i = 0; i < packet; ++i) {
            block.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            block.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        if (any_valid) query.intersect16(valid.lane, impl.top, &block);
        const int count = std::min(packet, rays.count - first);
        for (int i = 0; i < count; ++i) {
            RTCRayHit one;
            one.ray.tfar = block.ray.tfar[i];
            one.hit.u = block.hit.u[i];
            one.hit.v = block.hit.v[i];
            one.hit.primID = block.hit.primID[i];
            const bool valid_lane = valid.lane[i] != 0;
            one.hit.geomID = valid_lane ? block.hit.geomID[i] : RTC_INVALID_GEOMETRY_ID;
            one.hit.instID[0] = block.hit.instID[0][i];
            const int row = first + i;
            store_hit(impl, one, hits, row);
            if (!culls_back_faces || hits.primitive[row] < 0) continue;
            const Vec3f ng{block.hit.Ng_x[i], block.hit.Ng_y[i], block.hit.Ng_z[i]};
            const Vec3f direction{rays.dx[row], rays.dy[row], rays.dz[row]};
            const SceneRows rows{hits.instance[row], hits.primitive[row]};
            if (is_hidden_back(impl, rows, ng, direction)) {
                look_behind(impl, context, rays, hits, row);
            }
        }
    }
    return refused;
}

int intersect_single(const Accel::Impl& impl,
                     QueryContext& context,
                     const RayColumns& rays,
                     const HitColumns& hits) {
    Query query(context, false);
    int refused = 0;
    for (int row = 0; row < rays.count; ++row) {
        if (!is_safe(rays, row)) {
            ++refused;
            hits.primitive[row] = -1;
            continue;
        }
        RTCRayHit ray;
        load_ray(rays, row, ray.ray);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        query.intersect1(impl.top, &ray);
        store_hit(impl, ray, hits, row);
    }
    return refused;
}

}  // namespace

int Accel::intersect(const RayColumns& rays,
                     const HitColumns& hits,
                     Coherence coherence,
                     SeeThrough see_through) const {
    QueryContext context;
    context.keys = rays.key;
    context.fixed_threshold = see_through.fixed_alpha;
    context.segment = see_through.segment;
    return coherence == Coherence::coherent
               ? intersect_packets(*impl_, context, rays, hits, see_through.culls_back_faces)
               : intersect_single(*impl_, context, rays, hits);
}

int Accel::occluded(const RayColumns& rays,
                    uint8_t* occluded,
                    Coherence coherence,
                    uint32_t segment) const {
    // On instances the coherent kernel of Embree 3.13 for AVX-512 may never come back.
    const bool coherent = coherence == Coherence::coherent && impl_->scene->instances.empty();
    QueryContext context;
    Query query(context, coherent);
    context.keys = rays.key;
    context.segment = segment;
    int refused = 0;
    for (int first = 0; first < rays.count; first += packet) {
        ValidMask valid;
        RTCRay16 block;
        refused += mark_valid(rays, first, valid);
        if (load_packet(rays, first, valid, block)) {
            query.occluded16(valid.lane, impl_->top, &block);
        }
        const int count = std::min(packet, rays.count - first);
        for (int i = 0; i < count; ++i) {
            occluded[first + i] = valid.lane[i] == 0 || block.tfar[i] < 0.0f ? 1 : 0;
        }
    }
    return refused;
}

}  // namespace obscura
