// accel/crossings.cpp - lists all boundaries of media along a ray, not only the nearest hit.
// SPDX-License-Identifier: Apache-2.0
#include "accel/ask_again.h"
#include "accel/infinite_planes.h"
#include "accel/scene_records.h"
#include "accel/single_sided.h"

namespace obscura {

namespace {

/// Context of a query that records the boundaries along one ray. `common` must come first.
struct NotingContext {
    QueryContext common;
    const Accel::Impl* impl;
    Vec3f origin;
    TimedDirection direction;
    CutFaces cut;
    std::vector<Crossing>* out;
};

/// Passes the crossings with analytic shapes on to the query's context.
struct ShapeNotes {
    CrossingNotes notes;  ///< must come first
    const NotingContext* context;
};

void note_shape(CrossingNotes& notes, const ShapeCrossing& found) {
    const NotingContext& context = *reinterpret_cast<ShapeNotes&>(notes).context;
    const SceneRecords records = scene_records(*context.impl, found.geometry, found.instance);
    const int32_t medium = context.impl->media[static_cast<size_t>(records.primitive)];
    if (medium == 0) return;
    context.out->push_back({found.t, 0.0f, 0.0f, records, found.index, medium, found.front});
}

/// Embree filter function: records every boundary of a medium and rejects the hit.
void note_faces(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const NotingContext*>(args->context);
    const Accel::Impl& impl = *context.impl;
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        args->valid[i] = 0;
        const SceneRecords records = scene_records(
            impl, RTCHitN_geomID(args->hit, n, i), RTCHitN_instID(args->hit, n, i, 0));
        const int32_t medium = impl.media[static_cast<size_t>(records.primitive)];
        if (medium == 0) continue;
        const Vec3f ng{RTCHitN_Ng_x(args->hit, n, i),
                       RTCHitN_Ng_y(args->hit, n, i),
                       RTCHitN_Ng_z(args->hit, n, i)};
        if (context.common.culls_back_faces &&
            is_hidden_back(impl, records, ng, context.direction)) {
            continue;
        }
        const float t = RTCRayN_tfar(args->ray, n, i);
        const Vec3f met = context.origin + context.direction.world * t;
        if (is_cut_away(impl, context.cut, {records, ng, met, context.direction.time})) continue;
        context.out->push_back({t,
                                RTCHitN_u(args->hit, n, i),
                                RTCHitN_v(args->hit, n, i),
                                records,
                                static_cast<int32_t>(RTCHitN_primID(args->hit, n, i)),
                                medium,
                                !shows_back(impl, records, ng, context.direction)});
    }
}

}  // namespace

void Accel::list_crossings(const RayColumns& rays,
                           int index,
                           const SeeThrough& see_through,
                           std::vector<Crossing>& out) const {
    if (!is_safe(rays, index, impl_->reach)) return;
    NotingContext context{{},
                          impl_.get(),
                          {rays.ox[index], rays.oy[index], rays.oz[index]},
                          direction_of(rays, index),
                          {},
                          &out};
    ShapeNotes notes{{note_shape}, &context};
    QueryContext& common = context.common;
    common.keys = rays.key;
    common.fixed_threshold = see_through.fixed_alpha || rays.key == nullptr;
    common.segment = see_through.segment;
    common.culls_back_faces = see_through.culls_back_faces;
    common.passes = see_through.passes;
    common.crossings = &notes.notes;
    if (see_through.cutaway != nullptr) context.cut = see_through.cutaway->of(index);
    ask_again(*impl_, common, note_faces, rays, index);
    if (!impl_->infinite_planes.empty()) {
        list_infinite_crossings(*impl_, common, rays, index, out);
    }
}

}  // namespace obscura
