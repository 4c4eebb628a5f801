// accel/queries.cpp - Accel's ray queries: columns of rays through Embree, in packets and streams.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/coherent_stream.h"
#include "accel/infinite_planes.h"
#include "accel/nearest_hits.h"
#include "accel/packets.h"
#include "accel/safe_ray.h"
#include "accel/scene_records.h"
#include "accel/single_sided.h"
#include "accel/tied_hits.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace obscura {

namespace {

/// Marks the rays of [first, first + 16) that exist and are safe; returns how many are refused.
int mark_valid(const RayColumns& rays, int first, const RayReach& reach, ValidMask& valid) {
    const int existing = std::min(packet, rays.count - first);
    int safe = 0;
    for (int i = 0; i < packet; ++i) {
        valid.lane[i] = i < existing && is_safe(rays, first + i, reach) ? -1 : 0;
        safe -= valid.lane[i];
    }
    return existing - safe;
}

/// Loads the valid rays. Idle lanes repeat one of them: where Embree's packets are narrower than
/// 16, it reads all 16 rays regardless of the mask. False, with `out` unchanged, if none is valid.
bool load_part(const RayColumns& rays, int first, const ValidMask& valid, RTCRay16& out) {
    const int* found = std::find(valid.lane, valid.lane + packet, -1);
    if (found == valid.lane + packet) return false;
    const int stand_in = first + static_cast<int>(found - valid.lane);
    for (int i = 0; i < packet; ++i)
        load_lane(rays, valid.lane[i] != 0 ? first + i : stand_in, i, out);
    return true;
}

/// Drops recorded back faces that lie behind the hit: infinite planes are tested last and may stop
/// a ray before a recorded back face.
void forget_unseen_backs(const HitColumns& hits, std::vector<PassedBack>& backs) {
    std::erase_if(backs, [&](const PassedBack& back) {
        return hits.primitive[back.index] >= 0 && hits.t[back.index] < back.t;
    });
}

/// Whether Embree is told that rays are coherent. With instances its coherent AVX-512 kernel (3.13)
/// may hang in occlusion, and may pass what packets of rays apart from each other meet before them.
bool asks_coherent(const Accel::Impl& impl, Coherence coherence) {
    return coherence == Coherence::coherent && !impl.has_instances;
}

/// The result of loading 16 rays.
struct Loaded {
    int refused = 0;
    bool any = true;
    bool all = false;  ///< 16 rays, none refused
};

Loaded load_packet(
    const Accel::Impl& impl, const RayColumns& rays, int first, ValidMask& valid, RTCRay16& out) {
    if (rays.count - first >= packet &&
        impl.functions.packets->load(rays, first, impl.reach, out)) {
        std::fill_n(valid.lane, packet, -1);
        return {.all = true};
    }
    const int refused = mark_valid(rays, first, impl.reach, valid);
    return {refused, load_part(rays, first, valid, out)};
}

/// Writes 16 hits: the columns are padded to whole packets.
void store_packet(const Accel::Impl& impl,
                  const ValidMask& valid,
                  const RTCRayHit16& block,
                  const HitColumns& hits,
                  int first) {
    impl.functions.packets->store(block, valid, hits, first);
    if (!impl.has_instances) return;
    for (int i = 0; i < packet; ++i) {
        if (hits.primitive[first + i] < 0) continue;
        const SceneRecords records =
            scene_records(impl, block.hit.geomID[i], block.hit.instID[0][i]);
        hits.primitive[first + i] = records.primitive;
        hits.instance[first + i] = records.instance;
    }
}

/// Context of a query that records all surfaces along its rays. `common` must come first.
struct ListingContext {
    QueryContext common;
    const Accel::Impl* impl;
    const RayColumns* rays;
    std::vector<MetSurface>* out;
    ValidMask valid;            ///< Embree may trace idle lanes, too
    int first;                  ///< of the packet's rays
    SceneRecords last[packet];  ///< that each ray has met: meshes have many faces
};

/// Passes what rays meet of analytic shapes on to the query's context.
struct ShapeList {
    CrossingNotes notes;  ///< must come first
    ListingContext* context;
};

bool is_listed(const ListingContext& context, unsigned ray) {
    return context.valid.lane[static_cast<int>(ray) - context.first] != 0;
}

void list_surface(ListingContext& context, unsigned ray, const SceneRecords& surface) {
    const auto index = static_cast<int>(ray);
    SceneRecords& last = context.last[index - context.first];
    if (last.primitive == surface.primitive && last.instance == surface.instance) return;
    last = surface;
    context.out->push_back({index, surface});
}

void list_shape(CrossingNotes& notes, const ShapeCrossing& met) {
    ListingContext& context = *reinterpret_cast<ShapeList&>(notes).context;
    if (!is_listed(context, met.ray)) return;
    list_surface(context, met.ray, scene_records(*context.impl, met.geometry, met.instance));
}

/// Embree filter function: records every face and rejects the hit.
void list_faces(const RTCFilterFunctionNArguments* args) {
    auto& context = *reinterpret_cast<ListingContext*>(args->context);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        args->valid[i] = 0;
        const unsigned ray = RTCRayN_id(args->ray, n, i);
        if (!is_listed(context, ray)) continue;
        const SceneRecords surface = scene_records(
            *context.impl, RTCHitN_geomID(args->hit, n, i), RTCHitN_instID(args->hit, n, i, 0));
        const Vec3f ng{RTCHitN_Ng_x(args->hit, n, i),
                       RTCHitN_Ng_y(args->hit, n, i),
                       RTCHitN_Ng_z(args->hit, n, i)};
        const TimedDirection direction = direction_of(*context.rays, static_cast<int>(ray));
        const bool passes = context.common.culls_back_faces &&
                            is_hidden_back(*context.impl, surface, ng, direction);
        if (!passes) list_surface(context, ray, surface);
    }
}

/// What all queries for hits ask of rays.
void set_see_through(QueryContext& context, const RayColumns& rays, const SeeThrough& asked) {
    context.keys = rays.key;
    context.fixed_threshold = asked.fixed_alpha || rays.key == nullptr;
    context.segment = asked.segment;
    context.culls_back_faces = asked.culls_back_faces;
    context.passes = asked.passes;
}

/// 0 where the scene has no end.
float largest_coordinate(const Bounds& bounds) {
    float largest = 0;
    for (const Vec3f& corner : {bounds.low, bounds.high}) {
        for (const float coordinate : {corner.x, corner.y, corner.z})
            largest = std::max(largest, std::abs(coordinate));
    }
    return std::isfinite(largest) ? largest : 0.0f;
}

/// A query for nearest hits.
class NearestQuery {
public:
    NearestQuery(const Accel::Impl& impl,
                 const RaysAndHits& columns,
                 bool coherent,
                 const SeeThrough& see_through)
        : impl_(impl),
          columns_(columns),
          see_through_(see_through),
          // Packets of 16 for bounces too: where rays diverge Embree continues ray by ray, still
          // faster than with calls of one ray each (obscura bench shows both).
          query_(context_, coherent),
          stream_width_(coherent ? impl.stream_width : 0),
          scene_size_(largest_coordinate(impl.scene->bounds)) {
        context_.nearest = nearest_;
        query_.set_filter(impl.functions.nearest->keep_nearest);
        set_see_through(context_, columns.rays, see_through);
        context_.passed_backs = see_through.passed_backs;
        context_.cutaway = see_through.cutaway;
        for (RTCRayHit16& block : blocks_) {
            begin_packets(block.ray);
            for (float* ng : {block.hit.Ng_x, block.hit.Ng_y, block.hit.Ng_z})
                std::fill_n(ng, packet, 0.0f);  // read for misses too
        }
    }

    NearestQuery(const NearestQuery&) = delete;
    NearestQuery& operator=(const NearestQuery&) = delete;

    /// Returns how many rays are refused.
    int trace() {
        int refused = 0;
        const int count = columns_.rays.count;
        for (int first = 0; first < count; first += packet) {
            const Loaded loaded = load(0, first);
            refused += loaded.refused;
            const bool may_stream =
                stream_width_ > 0 && loaded.all && first + stream_packets * packet <= count;
            // If not, the second packet is loaded again on its turn, and its refused rays count
            // then.
            if (may_stream && load(1, first + packet).all) {
                intersect_stream(query_, impl_.top, stream_width_, blocks_);
                finish(0, first);
                first += packet;
                finish(1, first);
            } else if (loaded.any) {
                query_.intersect16(valid_[0].lane, impl_.top, &blocks_[0]);
                finish(0, first);
            } else {
                std::fill_n(columns_.hits.primitive + first, packet, -1);
            }
        }
        return refused;
    }

private:
    /// Loads the rays from `first` on as one of the packets.
    Loaded load(int number, int first) {
        RTCRayHit16& block = blocks_[number];
        const Loaded loaded = load_packet(impl_, columns_.rays, first, valid_[number], block.ray);
        std::fill_n(block.hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(block.hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
        // Embree may trace idle lanes, too: they have hits of their own.
        if (!loaded.all)
            std::iota(block.ray.id, block.ray.id + packet, static_cast<unsigned>(first));
        if (loaded.any)
            impl_.functions.nearest->begin(block.ray, first, scene_size_, nearest_[number]);
        return loaded;
    }

    /// Writes the hits of a packet that was traced.
    void finish(int number, int first) {
        RTCRayHit16& block = blocks_[number];
        std::copy_n(nearest_[number].t, packet, block.ray.tfar);  // Embree looked a little beyond
        store_packet(impl_, valid_[number], block, columns_.hits, first);
        settle_tied_hits(impl_, context_, block.hit, first, columns_);
        if (see_through_.culls_back_faces)
            pass_hidden_backs(impl_, context_, block.hit, first, columns_);
        if (see_through_.cutaway != nullptr) {
            const int end = std::min(first + packet, columns_.rays.count);
            for (int index = first; index < end; ++index)
                pass_cutaway(impl_, context_, index, columns_);
        }
        if (impl_.infinite_planes.empty()) return;
        for (int i = 0; i < packet; ++i) {
            if (valid_[number].lane[i] != 0)
                meet_infinite_planes(impl_, context_, columns_.rays, columns_.hits, first + i);
        }
    }

    const Accel::Impl& impl_;
    RaysAndHits columns_;
    const SeeThrough& see_through_;
    QueryContext context_;
    Query query_;
    int stream_width_;
    float scene_size_;
    NearestHits nearest_[stream_packets];
    ValidMask valid_[stream_packets];
    RTCRayHit16 blocks_[stream_packets];
};

}  // namespace

int Accel::intersect(const RayColumns& rays,
                     const HitColumns& hits,
                     Coherence coherence,
                     SeeThrough see_through) const {
    const int refused =
        NearestQuery(*impl_, {rays, hits}, asks_coherent(*impl_, coherence), see_through).trace();
    if (see_through.passed_backs != nullptr && !impl_->infinite_planes.empty()) {
        forget_unseen_backs(hits, *see_through.passed_backs);
    }
    return refused;
}

void Accel::list_surfaces(const RayColumns& rays,
                          Coherence coherence,
                          const SeeThrough& see_through,
                          std::vector<MetSurface>& out) const {
    ListingContext context{{}, impl_.get(), &rays, &out, {}, 0, {}};
    ShapeList shapes{{list_shape}, &context};
    Query query(context.common, asks_coherent(*impl_, coherence));
    query.set_filter(list_faces);
    set_see_through(context.common, rays, see_through);
    context.common.crossings = &shapes.notes;
    RTCRayHit16 block;
    begin_packets(block.ray);
    for (int first = 0; first < rays.count; first += packet) {
        if (!load_packet(*impl_, rays, first, context.valid, block.ray).any) continue;
        context.first = first;
        std::fill_n(context.last, packet, SceneRecords{});
        std::fill_n(block.hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(block.hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
        std::iota(block.ray.id, block.ray.id + packet, static_cast<unsigned>(first));
        query.intersect16(context.valid.lane, impl_->top, &block);
        if (impl_->infinite_planes.empty()) continue;
        for (int i = 0; i < packet; ++i) {
            if (context.valid.lane[i] == 0) continue;
            list_infinite_surfaces(*impl_, context.common, rays, first + i, out);
        }
    }
}

int Accel::occluded(const RayColumns& rays,
                    uint8_t* occluded,
                    Coherence coherence,
                    const ShadowQuery& asked) const {
    QueryContext context;
    Query query(context, asks_coherent(*impl_, coherence));
    context.keys = rays.key;
    context.fixed_threshold = rays.key == nullptr;
    context.segment = asked.segment;
    context.passes_thin_walls = asked.thin_walls != nullptr;
    context.thin_walls = asked.thin_walls;
    context.passes = asked.passes;
    context.cutaway = asked.cutaway;
    int refused = 0;
    ValidMask valid;
    RTCRay16 block;
    begin_packets(block);
    for (int first = 0; first < rays.count; first += packet) {
        const Loaded loaded = load_packet(*impl_, rays, first, valid, block);
        refused += loaded.refused;
        if (loaded.any) query.occluded16(valid.lane, impl_->top, &block);
        const int count = std::min(packet, rays.count - first);
        for (int i = 0; i < count; ++i) {
            occluded[first + i] = valid.lane[i] == 0 || block.tfar[i] < 0.0f ? 1 : 0;
        }
        for (int i = 0; asked.cutaway != nullptr && i < count; ++i) {
            const int index = first + i;
            if (valid.lane[i] == 0 || occluded[index] == 0) continue;
            occluded[index] = is_occluded_despite_cutaway(*impl_, context, index, rays) ? 1 : 0;
        }
        if (impl_->infinite_planes.empty()) continue;
        for (int i = 0; i < count; ++i) {
            if (occluded[first + i] != 0) continue;
            occluded[first + i] = infinite_plane_occludes(*impl_, context, rays, first + i) ? 1 : 0;
        }
    }
    return refused;
}

}  // namespace obscura
