// accel/crossings.cpp - all faces of bodies that a ray goes through, not the nearest alone.
// SPDX-License-Identifier: Apache-2.0
#include "accel/endless_planes.h"
#include "accel/safe_ray.h"
#include "accel/scene_rows.h"
#include "accel/single_sided.h"

namespace obscura {

namespace {

/// A query of one ray that notes what it goes through. The common part must come first.
struct NotingContext {
    QueryContext common;
    const Accel::Impl* impl;
    Vec3f origin;
    TimedDirection direction;
    CutFaces cut;
    std::vector<Crossing>* out;
};

/// What analytic shapes find goes to the context of their query.
struct ShapeNotes {
    CrossingNotes notes;  ///< must come first
    const NotingContext* context;
};

void note_shape(CrossingNotes& notes, const ShapeCrossing& found) {
    const NotingContext& context = *reinterpret_cast<ShapeNotes&>(notes).context;
    const SceneRows rows = scene_rows(*context.impl, found.geometry, found.instance);
    const int32_t body = context.impl->bodies[static_cast<size_t>(rows.primitive)];
    if (body == 0) return;
    context.out->push_back({found.t, 0.0f, 0.0f, rows, found.row, body, found.front});
}

/// Embree filter function: every face of a body is noted, and none counts.
void note_faces(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const NotingContext*>(args->context);
    const Accel::Impl& impl = *context.impl;
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        args->valid[i] = 0;
        const SceneRows rows =
            scene_rows(impl, RTCHitN_geomID(args->hit, n, i), RTCHitN_instID(args->hit, n, i, 0));
        const int32_t body = impl.bodies[static_cast<size_t>(rows.primitive)];
        if (body == 0) continue;
        const Vec3f ng{RTCHitN_Ng_x(args->hit, n, i),
                       RTCHitN_Ng_y(args->hit, n, i),
                       RTCHitN_Ng_z(args->hit, n, i)};
        if (context.common.culls_back_faces && is_hidden_back(impl, rows, ng, context.direction)) {
            continue;
        }
        const float t = RTCRayN_tfar(args->ray, n, i);
        const Vec3f met = context.origin + context.direction.world * t;
        if (is_cut_away(impl, context.cut, {rows, ng, met, context.direction.time})) continue;
        context.out->push_back({t,
                                RTCHitN_u(args->hit, n, i),
                                RTCHitN_v(args->hit, n, i),
                                rows,
                                static_cast<int32_t>(RTCHitN_primID(args->hit, n, i)),
                                body,
                                !shows_back(impl, rows, ng, context.direction)});
    }
}

}  // namespace

void Accel::list_crossings(const RayColumns& rays,
                           int row,
                           const SeeThrough& see_through,
                           std::vector<Crossing>& out) const {
    if (!is_safe(rays, row, impl_->reach)) return;
    NotingContext context{{},
                          impl_.get(),
                          {rays.ox[row], rays.oy[row], rays.oz[row]},
                          direction_of(rays, row),
                          {},
                          &out};
    ShapeNotes notes{{note_shape}, &context};
    QueryContext& common = context.common;
    Query query(common, false);
    query.set_filter(note_faces);
    common.keys = rays.key;
    common.fixed_threshold = see_through.fixed_alpha || rays.key == nullptr;
    common.segment = see_through.segment;
    common.culls_back_faces = see_through.culls_back_faces;
    common.crossings = &notes.notes;
    if (see_through.cutaway != nullptr) context.cut = see_through.cutaway->of(row);
    RTCRayHit ray;
    load_ray(rays, row, ray.ray);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect1(impl_->top, &ray);
    if (!impl_->endless_planes.empty()) {
        list_endless_crossings(*impl_, common, rays, row, out);
    }
}

}  // namespace obscura
