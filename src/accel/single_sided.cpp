// accel/single_sided.cpp - back faces of single-sided meshes, which camera rays pass.
// SPDX-License-Identifier: Apache-2.0
#include "accel/single_sided.h"

#include "accel/ask_again.h"
#include "accel/packets.h"
#include "accel/scene_records.h"
#include "accel/tied_hits.h"
#include "scene/motion.h"

#include <algorithm>

namespace obscura {

TimedDirection direction_of(const RayColumns& rays, int index) {
    return {{rays.dx[index], rays.dy[index], rays.dz[index]},
            rays.time != nullptr ? rays.time[index] : 0.0f};
}

bool shows_back(const Accel::Impl& impl,
                const SceneRecords& records,
                const Vec3f& ng,
                const TimedDirection& direction) {
    if (records.instance < 0) return dot(ng, direction.world) > 0.0f;
    const Affinef map = object_from_world_at(
        *impl.scene, impl.scene->instances[static_cast<size_t>(records.instance)], direction.time);
    return dot(ng, transform_vector(map, direction.world)) > 0.0f;
}

bool is_hidden_back(const Accel::Impl& impl,
                    const SceneRecords& records,
                    const Vec3f& ng,
                    const TimedDirection& direction) {
    return impl.single_sided[static_cast<size_t>(records.primitive)] != 0 &&
           shows_back(impl, records, ng, direction);
}

namespace {

bool is_same(const SceneRecords& a, const SceneRecords& b) {
    return a.primitive == b.primitive && a.instance == b.instance;
}

}  // namespace

bool is_cut_away(const Accel::Impl& impl, const CutFaces& cut, const MetFace& face) {
    if (!is_same(face.records, cut.surface)) return false;
    const float* eye = cut.eye;
    const Vec3f view = face.met * eye[3] - Vec3f{eye[0], eye[1], eye[2]};
    return shows_back(impl, face.records, face.ng, {view, face.time});
}

namespace {

/// Context of a query whose ray passes some faces. `common` must come first.
struct FaceContext {
    QueryContext common;
    const Accel::Impl* impl;
    TimedDirection direction;
    Vec3f origin{0, 0, 0};
    CutFaces cut = {};
    LowestHit lowest = {};  ///< of the faces that it does not pass
};

/// The candidate hit of a filter function.
struct Candidate {
    SceneRecords records;
    Vec3f ng;
};

Candidate candidate(const RTCFilterFunctionNArguments* args, const Accel::Impl& impl, unsigned i) {
    return {
        scene_records(
            impl, RTCHitN_geomID(args->hit, args->N, i), RTCHitN_instID(args->hit, args->N, i, 0)),
        {RTCHitN_Ng_x(args->hit, args->N, i),
         RTCHitN_Ng_y(args->hit, args->N, i),
         RTCHitN_Ng_z(args->hit, args->N, i)}};
}

/// Embree filter function: rejects back faces of single-sided meshes.
void drop_hidden_backs(const RTCFilterFunctionNArguments* args) {
    auto& context = *reinterpret_cast<FaceContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const Candidate c = candidate(args, *context.impl, i);
        const bool passes = is_hidden_back(*context.impl, c.records, c.ng, context.direction);
        if (passes || !context.lowest.takes(args, i)) args->valid[i] = 0;
    }
}

/// Embree filter function: rejects cut-away faces, those of one surface whose back faces the eye.
void drop_cutaway(const RTCFilterFunctionNArguments* args) {
    auto& context = *reinterpret_cast<FaceContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const Candidate c = candidate(args, *context.impl, i);
        const float t = RTCRayN_tfar(args->ray, args->N, i);
        const Vec3f met = context.origin + context.direction.world * t;
        const MetFace face{c.records, c.ng, met, context.direction.time};
        const bool passes = is_cut_away(*context.impl, context.cut, face);
        if (passes || !context.lowest.takes(args, i)) args->valid[i] = 0;
    }
}

FaceContext face_context(const Accel::Impl& impl,
                         const QueryContext& common,
                         const RayColumns& rays,
                         int index) {
    FaceContext context{common, &impl, direction_of(rays, index)};
    context.origin = {rays.ox[index], rays.oy[index], rays.oz[index]};
    if (common.cutaway != nullptr) context.cut = common.cutaway->of(index);
    return context;
}

/// Replaces a ray's hit by the first one that a filter leaves: it may even lie in the plane of the
/// face that the ray passes.
void replace_hit(FaceContext& context,
                 RTCFilterFunctionN filter,
                 int index,
                 const RaysAndHits& columns) {
    const RTCRayHit found = ask_again(*context.impl, context.common, filter, columns.rays, index);
    store_hit(*context.impl, found, columns.hits, index);
}

/// True if faces of a surface may be cut away. Emitters may not: light sampling chooses points on
/// them. Nor may analytic shapes: their callbacks call no filter.
bool may_be_cut(const Scene& scene, const SceneRecords& records) {
    const Primitive& primitive = scene.primitives[static_cast<size_t>(records.primitive)];
    const float* emission = scene.materials[static_cast<size_t>(primitive.material)].emission;
    return is_mesh(primitive) && !(emission[0] > 0.0f || emission[1] > 0.0f || emission[2] > 0.0f);
}

/// A quick test of a packet without branches: mostly no ray has hit a back face.
bool may_meet_backs(const RTCHit16& hit, int first, const RaysAndHits& columns) {
    int candidates = 0;
    for (int i = 0; i < packet; ++i) {
        const int index = first + i;
        const float along = hit.Ng_x[i] * columns.rays.dx[index] +
                            hit.Ng_y[i] * columns.rays.dy[index] +
                            hit.Ng_z[i] * columns.rays.dz[index];
        const int turned =
            static_cast<int>(along > 0.0f) | static_cast<int>(columns.hits.instance[index] >= 0);
        candidates |= turned & static_cast<int>(columns.hits.primitive[index] >= 0);
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
        const int index = first + i;
        const SceneRecords records{columns.hits.instance[index], columns.hits.primitive[index]};
        if (records.primitive < 0) continue;
        const Vec3f ng{hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]};
        if (!is_hidden_back(impl, records, ng, direction_of(columns.rays, index))) continue;
        if (context.passed_backs != nullptr && may_be_cut(*impl.scene, records)) {
            context.passed_backs->push_back({index, columns.hits.t[index], records});
        }
        FaceContext again = face_context(impl, context, columns.rays, index);
        replace_hit(again, drop_hidden_backs, index, columns);
    }
}

void pass_cutaway(const Accel::Impl& impl,
                  const QueryContext& context,
                  int index,
                  const RaysAndHits& columns) {
    const SceneRecords met{columns.hits.instance[index], columns.hits.primitive[index]};
    if (met.primitive < 0 || !is_same(met, context.cutaway->of(index).surface)) return;
    FaceContext again = face_context(impl, context, columns.rays, index);
    replace_hit(again, drop_cutaway, index, columns);
}

bool is_occluded_despite_cutaway(const Accel::Impl& impl,
                                 const QueryContext& context,
                                 int index,
                                 const RayColumns& rays) {
    if (!cuts(*context.cutaway, index)) return true;
    FaceContext again = face_context(impl, context, rays, index);
    Query query(again.common, false);
    query.set_filter(drop_cutaway);
    RTCRay ray;
    load_ray(rays, index, ray);
    query.occluded1(impl.top, &ray);
    return ray.tfar < 0.0f;
}

}  // namespace obscura
