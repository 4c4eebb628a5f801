// accel/tied_hits.cpp - hits on edges of triangles, where the neighbour is met in the same place.
// SPDX-License-Identifier: Apache-2.0
#include "accel/tied_hits.h"

#include "accel/ask_again.h"
#include "accel/packets.h"
#include "accel/scene_records.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace obscura {

namespace {

/// A barycentric coordinate as small as this may be that of an edge: rounding is some 1e-7.
constexpr float edge = 1e-6f;

bool is_on_edge(const HitColumns& hits, int index) {
    const float u = hits.u[index];
    const float v = hits.v[index];
    return std::min(std::min(u, v), 1.0f - u - v) <= edge;
}

/// A quick test of a packet without branches: mostly no hit is on an edge.
bool may_be_tied(int first, const HitColumns& hits) {
    int candidates = 0;
    for (int index = first; index < first + packet; ++index) {
        const int is_hit = static_cast<int>(hits.primitive[index] >= 0);
        candidates |= static_cast<int>(is_on_edge(hits, index)) & is_hit;
    }
    return candidates != 0;
}

/// Context of a query for the lowest hit. `common` must come first.
struct TieContext {
    QueryContext common;
    LowestHit lowest = {};
};

/// Embree filter function.
void keep_lowest(const RTCFilterFunctionNArguments* args) {
    auto& context = *reinterpret_cast<TieContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != 0 && !context.lowest.takes(args, i)) args->valid[i] = 0;
    }
}

}  // namespace

bool LowestHit::takes(const RTCFilterFunctionNArguments* args, unsigned i) {
    const unsigned n = args->N;
    const float found_t = RTCRayN_tfar(args->ray, n, i);
    const int32_t ids[] = {static_cast<int32_t>(RTCHitN_instID(args->hit, n, i, 0)),
                           static_cast<int32_t>(RTCHitN_geomID(args->hit, n, i)),
                           static_cast<int32_t>(RTCHitN_primID(args->hit, n, i))};
    const auto found = std::tie(found_t, ids[0], ids[1], ids[2]);
    auto lowest = std::tie(t, instance, geometry, triangle);
    const bool is_lower = found < lowest;
    if (is_lower) lowest = found;
    return is_lower;
}

void settle_tied_hits(const Accel::Impl& impl,
                      const QueryContext& context,
                      RTCHit16& hit,
                      int first,
                      const RaysAndHits& columns) {
    const auto& [rays, hits] = columns;
    if (!may_be_tied(first, hits)) return;
    const int count = std::min(packet, rays.count - first);
    for (int i = 0; i < count; ++i) {
        const int index = first + i;
        const int32_t primitive = hits.primitive[index];
        if (primitive < 0 || !is_on_edge(hits, index)) continue;
        if (!is_mesh(impl.scene->primitives[static_cast<size_t>(primitive)])) continue;
        TieContext tie{context};
        tie.common.passed_backs = nullptr;  // recorded before
        const RTCRayHit found = ask_again(impl, tie.common, keep_lowest, rays, index);
        store_hit(impl, found, hits, index);
        if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {  // past the rim of a mesh
            hits.t[index] = std::numeric_limits<float>::infinity();
            continue;
        }
        hit.Ng_x[i] = found.hit.Ng_x;
        hit.Ng_y[i] = found.hit.Ng_y;
        hit.Ng_z[i] = found.hit.Ng_z;
    }
}

}  // namespace obscura
