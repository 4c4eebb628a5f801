// accel/single_sided.cpp - backs that camera rays pass, and what is then cut away for other rays.
// SPDX-License-Identifier: Apache-2.0
#include "accel/single_sided.h"

#include "accel/packets.h"
#include "accel/safe_ray.h"
#include "accel/scene_rows.h"
#include "scene/motion.h"

#include <algorithm>

namespace obscura {

TimedDirection direction_of(const RayColumns& rays, int row) {
    return {{rays.dx[row], rays.dy[row], rays.dz[row]},
            rays.time != nullptr ? rays.time[row] : 0.0f};
}

bool shows_back(const Accel::Impl& impl,
                const SceneRows& rows,
                const Vec3f& ng,
                const TimedDirection& direction) {
    if (rows.instance < 0) return dot(ng, direction.world) > 0.0f;
    const Affinef map = object_from_world_at(
        *impl.scene, impl.scene->instances[static_cast<size_t>(rows.instance)], direction.time);
    return dot(ng, transform_vector(map, direction.world)) > 0.0f;
}

bool is_hidden_back(const Accel::Impl& impl,
                    const SceneRows& rows,
                    const Vec3f& ng,
                    const TimedDirection& direction) {
    return impl.single_sided[static_cast<size_t>(rows.primitive)] != 0 &&
           shows_back(impl, rows, ng, direction);
}

namespace {

bool is_same(const SceneRows& a, const SceneRows& b) {
    return a.primitive == b.primitive && a.instance == b.instance;
}

}  // namespace

bool is_cut_away(const Accel::Impl& impl, const CutFaces& cut, const MetFace& face) {
    if (!is_same(face.rows, cut.surface)) return false;
    const float* eye = cut.eye;
    const Vec3f view = face.met * eye[3] - Vec3f{eye[0], eye[1], eye[2]};
    return shows_back(impl, face.rows, face.ng, {view, face.time});
}

namespace {

/// A query of one ray that passes faces. The common part must come first.
struct FaceContext {
    QueryContext common;
    const Accel::Impl* impl;
    TimedDirection direction;
    Vec3f origin{0, 0, 0};
    CutFaces cut = {};
};

/// What a filter function is asked about.
struct Candidate {
    SceneRows rows;
    Vec3f ng;
};

Candidate candidate(const RTCFilterFunctionNArguments* args, const Accel::Impl& impl, unsigned i) {
    return {
        scene_rows(
            impl, RTCHitN_geomID(args->hit, args->N, i), RTCHitN_instID(args->hit, args->N, i, 0)),
        {RTCHitN_Ng_x(args->hit, args->N, i),
         RTCHitN_Ng_y(args->hit, args->N, i),
         RTCHitN_Ng_z(args->hit, args->N, i)}};
}

/// Embree filter function: hidden backs do not count.
void drop_hidden_backs(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const FaceContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const Candidate c = candidate(args, *context.impl, i);
        if (is_hidden_back(*context.impl, c.rows, c.ng, context.direction)) args->valid[i] = 0;
    }
}

/// Embree filter function: faces of the one surface whose backs face the eye do not count.
void drop_cutaway(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const FaceContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const Candidate c = candidate(args, *context.impl, i);
        const float t = RTCRayN_tfar(args->ray, args->N, i);
        const Vec3f met = context.origin + context.direction.world * t;
        const MetFace face{c.rows, c.ng, met, context.direction.time};
        if (is_cut_away(*context.impl, context.cut, face)) args->valid[i] = 0;
    }
}

FaceContext face_context(const Accel::Impl& impl,
                         const QueryContext& common,
                         const RayColumns& rays,
                         int row) {
    FaceContext context{common, &impl, direction_of(rays, row)};
    context.origin = {rays.ox[row], rays.oy[row], rays.oz[row]};
    if (common.cutaway != nullptr) context.cut = common.cutaway->of(row);
    return context;
}

/// Traces a ray again from its start: what lies behind a face that it passes, or in the very same
/// plane, may be what it meets.
void ask_again(FaceContext& context,
               RTCFilterFunctionN filter,
               int row,
               const RaysAndHits& columns) {
    Query query(context.common, false);
    query.set_filter(filter);
    RTCRayHit ray;
    load_ray(columns.rays, row, ray.ray);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect1(context.impl->top, &ray);
    store_hit(*context.impl, ray, columns.hits, row);
}

/// True where faces of a surface may be cut away: not where light sampling may choose places on
/// them. Analytic shapes answer themselves which of their hits count, and ask no filter.
bool may_be_cut(const Scene& scene, const SceneRows& rows) {
    const Primitive& primitive = scene.primitives[static_cast<size_t>(rows.primitive)];
    const float* emission = scene.materials[static_cast<size_t>(primitive.material)].emission;
    return is_mesh(primitive) && !(emission[0] > 0.0f || emission[1] > 0.0f || emission[2] > 0.0f);
}

/// A first look at a packet without branches: mostly no ray can have met a back.
bool may_meet_backs(const RTCHit16& hit, int first, const RaysAndHits& columns) {
    int candidates = 0;
    for (int i = 0; i < packet; ++i) {
        const int row = first + i;
        const float along = hit.Ng_x[i] * columns.rays.dx[row] +
                            hit.Ng_y[i] * columns.rays.dy[row] + hit.Ng_z[i] * columns.rays.dz[row];
        const int turned =
            static_cast<int>(along > 0.0f) | static_cast<int>(columns.hits.instance[row] >= 0);
        candidates |= turned & static_cast<int>(columns.hits.primitive[row] >= 0);
    }
    return candidates != 0;
}

}  // namespace

void pass_hidden_backs(const Accel::Impl& impl,
                       const QueryContext& context,
                       const RTCHit16& hit,
                       int first,
                       const RaysAndHits& columns) {
    if (!may_meet_backs(hit, first, columns)) return;
    const int count = std::min(packet, columns.rays.count - first);
    for (int i = 0; i < count; ++i) {
        const int row = first + i;
        const SceneRows rows{columns.hits.instance[row], columns.hits.primitive[row]};
        if (rows.primitive < 0) continue;
        const Vec3f ng{hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]};
        if (!is_hidden_back(impl, rows, ng, direction_of(columns.rays, row))) continue;
        if (context.passed_backs != nullptr && may_be_cut(*impl.scene, rows)) {
            context.passed_backs->push_back({row, columns.hits.t[row], rows});
        }
        FaceContext again = face_context(impl, context, columns.rays, row);
        ask_again(again, drop_hidden_backs, row, columns);
    }
}

void pass_cutaway(const Accel::Impl& impl,
                  const QueryContext& context,
                  int row,
                  const RaysAndHits& columns) {
    const SceneRows met{columns.hits.instance[row], columns.hits.primitive[row]};
    if (met.primitive < 0 || !is_same(met, context.cutaway->of(row).surface)) return;
    FaceContext again = face_context(impl, context, columns.rays, row);
    ask_again(again, drop_cutaway, row, columns);
}

bool is_hidden_beside_cutaway(const Accel::Impl& impl,
                              const QueryContext& context,
                              int row,
                              const RayColumns& rays) {
    if (!cuts(*context.cutaway, row)) return true;
    FaceContext again = face_context(impl, context, rays, row);
    Query query(again.common, false);
    query.set_filter(drop_cutaway);
    RTCRay ray;
    load_ray(rays, row, ray);
    query.occluded1(impl.top, &ray);
    return ray.tfar < 0.0f;
}

}  // namespace obscura
