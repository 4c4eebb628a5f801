// accel/shape_callbacks.cpp - Embree's callbacks for shapes; compiled once per instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/nearest_hits.h"
#include "accel/shape_geometry.h"
#include "math/word_of.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// The rays of one call as columns of N numbers, one field after the other.
struct RayFields {
    float* field;  ///< RTCRayN
    int n;

    /// In  member: of RTCRay, whose fields RTCRayN has in the same order
    template <auto member>
    OBSCURA_INLINE float* column() const {
        return field + word_of<member> * n;
    }
    OBSCURA_INLINE float* tfar() const { return column<&RTCRay::tfar>(); }
    OBSCURA_INLINE unsigned id(int i) const {
        return static_cast<unsigned>(float_bits(column<&RTCRay::id>()[i]));
    }
    OBSCURA_INLINE ShapeRay<float> ray(int i) const {
        return {
            {column<&RTCRay::org_x>()[i], column<&RTCRay::org_y>()[i], column<&RTCRay::org_z>()[i]},
            {column<&RTCRay::dir_x>()[i],
             column<&RTCRay::dir_y>()[i],
             column<&RTCRay::dir_z>()[i]}};
    }
    OBSCURA_INLINE Span<float> limits(int i) const {
        return {column<&RTCRay::tnear>()[i], tfar()[i]};
    }
    template <auto member>
    OBSCURA_INLINE Lanes lanes(int i) const {
        return load(column<member>() + i);
    }
};

/// The arguments of one callback.
struct Call {
    const ShapeGeometry& geometry;
    const QueryContext& context;
    RayFields rays;
    const int* valid;
    unsigned primitive;
    bool front_only;
    bool any;  ///< occlusion: any hit will do
};

struct Found {
    float t = 0;
    int32_t index = -1;  ///< -1: nothing
};

OBSCURA_INLINE bool counts(
    const Call& call, int i, int32_t index, int root, const Vec3f& position) {
    if (call.geometry.alpha == nullptr) return true;
    return is_opaque_there(call.geometry,
                           call.context,
                           {call.rays.id(i), call.context.embree.instID[0], index, root, position});
}

/// One ray against one shape.
OBSCURA_INLINE Found find_on_shape(const Call& call, int i) {
    const ShapeRecord& record = call.geometry.records[call.primitive];
    const ShapeRay<float> ray = call.rays.ray(i);
    const Span<float> limits = call.rays.limits(i);
    const Roots<float> roots = intersect_shape<float>(record, ray);
    for (int k = 0; k < 2; ++k) {
        const float t = roots.t[k];
        if (!roots.hit[k] || !(t > limits.low) || !(t <= limits.high)) continue;
        if (call.front_only && !is_front<float>(record, ray, t, k)) continue;
        const auto primitive = static_cast<int32_t>(call.primitive);
        if (counts(call, i, primitive, k, ray.origin + ray.direction * t)) return {t, primitive};
    }
    return {};
}

/// The spheres of a block that are tested.
struct BlockPart {
    int32_t first;  ///< index of its first sphere
    Span<float> limits;
};

/// One ray against the spheres of a block, one by one because alpha may reject each hit.
Found find_in_open_block(const Call& call, int i, const float* block, const BlockPart& part) {
    const ShapeRay<float> ray = call.rays.ray(i);
    const auto& [first, limits] = part;
    Found best{limits.high, -1};
    for (int s = 0; s < sphere_block; ++s) {
        const Sphere<float> sphere{{block[s], block[sphere_block + s], block[2 * sphere_block + s]},
                                   block[3 * sphere_block + s]};
        const Roots<float> roots = intersect_sphere(sphere, ray);
        for (int k = 0; k < (call.front_only ? 1 : 2); ++k) {
            const float t = roots.t[k];
            if (!roots.hit[k] || !(t > limits.low) || !(t <= best.t)) continue;
            if (counts(call, i, first + s, k, ray.origin + ray.direction * t)) {
                best = {t, first + s};
                break;
            }
        }
    }
    return best;
}

/// The nearest hit of one ray within the limits, with block `number` of the geometry.
OBSCURA_INLINE Found find_in_block(const Call& call,
                                   int i,
                                   int32_t number,
                                   const Span<float>& limits) {
    const int32_t first = number * sphere_block;
    const float* block = call.geometry.spheres + static_cast<int64_t>(number) * sphere_block_floats;
    if (call.geometry.alpha != nullptr) return find_in_open_block(call, i, block, {first, limits});
    const BlockHit hit = intersect_sphere_block(block, call.rays.ray(i), limits, call.front_only);
    return {hit.t, hit.sphere < 0 ? -1 : first + hit.sphere};
}

/// One ray against a cluster: its blocks in the order in which the ray enters them.
OBSCURA_INLINE Found find_in_cluster(const Call& call, int i) {
    const auto cluster = static_cast<int32_t>(call.primitive);
    const float* boxes = call.geometry.boxes + static_cast<int64_t>(cluster) * cluster_floats;
    Span<float> limits = call.rays.limits(i);
    const BoxEntries entries = enter_boxes(boxes, call.rays.ray(i), limits);
    Found best;
    for (uint32_t bits = entries.bits; bits != 0;) {
        const int next = first_entry(entries, bits);
        if (entries.t[next] > limits.high) break;
        bits &= ~(1U << next);
        const Found found = find_in_block(call, i, cluster * cluster_blocks + next, limits);
        if (found.index < 0) continue;
        best = found;
        if (call.any) break;
        limits.high = found.t;
    }
    return best;
}

/// Lanes [i, i + lane_count) that exist and are active.
OBSCURA_INLINE Mask active_lanes(const Call& call, int i) {
    if (i + lane_count <= call.rays.n) return load(call.valid + i) != LanesI(0);
    alignas(64) int32_t active[lane_count] = {};
    for (int k = 0; k < lane_count && i + k < call.rays.n; ++k)
        active[k] = call.valid[i + k];
    return load(active) != LanesI(0);
}

/// Sixteen, eight or four rays against one opaque shape; hit(i, found) receives each result.
template <typename Hit>
OBSCURA_INLINE void packet_on_shape(const Call& call, const Hit& hit) {
    const ShapeRecord& record = call.geometry.records[call.primitive];
    for (int i = 0; i < call.rays.n; i += lane_count) {
        // A load past the last ray reads the fields behind, which exist for all fields up to tfar.
        const RayFields& rays = call.rays;
        const ShapeRay<Lanes> ray{{rays.lanes<&RTCRay::org_x>(i),
                                   rays.lanes<&RTCRay::org_y>(i),
                                   rays.lanes<&RTCRay::org_z>(i)},
                                  {rays.lanes<&RTCRay::dir_x>(i),
                                   rays.lanes<&RTCRay::dir_y>(i),
                                   rays.lanes<&RTCRay::dir_z>(i)}};
        Roots<Lanes> roots = intersect_shape<Lanes>(record, ray);
        if (call.front_only) {
            roots.hit[0] = roots.hit[0] & is_front<Lanes>(record, ray, roots.t[0], 0);
            roots.hit[1] = roots.hit[1] & is_front<Lanes>(record, ray, roots.t[1], 1);
        }
        const NearHit<Lanes> found =
            nearest(roots, rays.lanes<&RTCRay::tnear>(i), rays.lanes<&RTCRay::tfar>(i));
        uint32_t bits = mask_bits(found.found & active_lanes(call, i));
        if (bits == 0) continue;
        alignas(64) float t[lane_count];
        store(t, found.t);
        for (; bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            hit(i + lane, Found{t[lane], static_cast<int32_t>(call.primitive)});
        }
    }
}

/// All rays of a call, whatever their number.
template <typename Hit>
OBSCURA_INLINE void find_hits(const Call& call, const Hit& hit) {
    const bool is_shape = call.geometry.records != nullptr;
    if (is_shape && call.rays.n > 1 && call.geometry.alpha == nullptr) {
        packet_on_shape(call, hit);
        return;
    }
    // For diverged rays Embree passes a packet with one active ray.
    for (int first = 0; first < call.rays.n; first += lane_count) {
        for (uint32_t bits = mask_bits(active_lanes(call, first)); bits != 0; bits &= bits - 1) {
            const int i = first + __builtin_ctz(bits);
            const Found found = is_shape ? find_on_shape(call, i) : find_in_cluster(call, i);
            if (found.index >= 0) hit(i, found);
        }
    }
}

/// Records the intersections of one ray with one shape within the ray's limits.
template <typename IsFront>
void note_roots(const Call& call,
                int i,
                const Roots<float>& roots,
                ShapeCrossing crossing,
                const IsFront& is_front_at) {
    const ShapeRay<float> ray = call.rays.ray(i);
    const Span<float> limits = call.rays.limits(i);
    for (int k = 0; k < 2; ++k) {
        crossing.t = roots.t[k];
        if (!roots.hit[k] || !(crossing.t > limits.low) || !(crossing.t <= limits.high)) continue;
        crossing.front = is_front_at(crossing.t, k);
        if (call.front_only && !crossing.front) continue;
        const Vec3f position = ray.origin + ray.direction * crossing.t;
        if (!counts(call, i, crossing.index, k, position)) continue;
        call.context.crossings->note_shape(*call.context.crossings, crossing);
    }
}

/// Records all intersections of one ray with a shape, or with the spheres of a cluster.
void note_crossings(const Call& call, int i, unsigned geometry) {
    const ShapeRay<float> ray = call.rays.ray(i);
    ShapeCrossing crossing{
        call.rays.id(i), 0.0f, geometry, call.context.embree.instID[0], 0, false};
    const auto primitive = static_cast<int32_t>(call.primitive);
    if (call.geometry.records != nullptr) {
        const ShapeRecord& record = call.geometry.records[call.primitive];
        crossing.index = primitive;
        const auto front = [&](float t, int k) { return is_front<float>(record, ray, t, k); };
        note_roots(call, i, intersect_shape<float>(record, ray), crossing, front);
        return;
    }
    const int32_t first = primitive * cluster_spheres;
    const int32_t end = min(first + cluster_spheres, call.geometry.count);
    for (crossing.index = first; crossing.index < end; ++crossing.index) {
        const float* at = call.geometry.spheres + sphere_word(crossing.index);
        const Sphere<float> sphere{{at[0], at[sphere_block], at[2 * sphere_block]},
                                   at[3 * sphere_block]};
        const auto front = [](float, int k) { return k == 0; };
        note_roots(call, i, intersect_sphere(sphere, ray), crossing, front);
    }
}

/// Ends a ray at a hit, unless the hit so far comes first: see NearestHits.
OBSCURA_INLINE bool stops(const Call& call, int i, const Found& found, unsigned geometry) {
    if (call.context.nearest == nullptr) {
        call.rays.tfar()[i] = found.t;
        return true;
    }
    const auto id = static_cast<unsigned>(call.rays.id(i));
    NearestHits& nearest = nearest_hits_of(call.context, id);
    const int lane = static_cast<int>(id) - nearest.first_id;
    const CandidateHit candidate{found.t,
                                 static_cast<int32_t>(call.context.embree.instID[0]),
                                 static_cast<int32_t>(geometry),
                                 found.index};
    if (!takes(nearest, lane, candidate)) return false;
    float coordinates = nearest.coordinates[lane];
    if (candidate.instance >= 0) {
        const ShapeRay<float> ray = call.rays.ray(i);
        coordinates = max(coordinates, own_coordinates(ray.origin, ray.direction));
    }
    call.rays.tfar()[i] = end_of_search(found.t, coordinates);
    return true;
}

void intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& geometry = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    if (geometry.visibility != nullptr && passes_shape(geometry, context, context.embree.instID[0]))
        return;
    const unsigned n = args->N;
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    const RayFields rays{reinterpret_cast<float*>(RTCRayHitN_RayN(args->rayhit, n)),
                         static_cast<int>(n)};
    const bool front_only = context.culls_back_faces && geometry.single_sided;
    const Call call{geometry, context, rays, args->valid, args->primID, front_only, false};
    if (context.crossings != nullptr) {
        for (int i = 0; i < rays.n; ++i) {
            if (args->valid[i] != 0) note_crossings(call, i, args->geomID);
        }
        return;
    }
    find_hits(call, [&](int index, const Found& found) {
        const auto i = static_cast<unsigned>(index);
        if (!stops(call, index, found, args->geomID)) return;
        RTCHitN_Ng_x(hits, n, i) = -rays.column<&RTCRay::dir_x>()[index];
        RTCHitN_Ng_y(hits, n, i) = -rays.column<&RTCRay::dir_y>()[index];
        RTCHitN_Ng_z(hits, n, i) = -rays.column<&RTCRay::dir_z>()[index];
        RTCHitN_u(hits, n, i) = 0.0f;
        RTCHitN_v(hits, n, i) = 0.0f;
        RTCHitN_primID(hits, n, i) = static_cast<unsigned>(found.index);
        RTCHitN_geomID(hits, n, i) = args->geomID;
        copy_instance_stack(context, hits, n, i);
    });
}

void occluded(const RTCOccludedFunctionNArguments* args) {
    const auto& geometry = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    if (geometry.visibility != nullptr && passes_shape(geometry, context, context.embree.instID[0]))
        return;
    const RayFields rays{reinterpret_cast<float*>(args->ray), static_cast<int>(args->N)};
    const Call call{geometry, context, rays, args->valid, args->primID, false, true};
    find_hits(call, [&](int index, const Found&) {
        if (geometry.thin_wall && passes_thin_wall(context, rays.id(index))) return;
        rays.tfar()[index] = -INFINITY;
    });
}

void set_bounds(const ShapeBox& box, RTCBounds& out) {
    out.lower_x = box.low.x;
    out.lower_y = box.low.y;
    out.lower_z = box.low.z;
    out.upper_x = box.high.x;
    out.upper_y = box.high.y;
    out.upper_z = box.high.z;
}

void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& geometry = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
    const auto primitive = static_cast<int32_t>(args->primID);
    if (geometry.records != nullptr) {
        set_bounds(shape_bounds(geometry.records[primitive]), *args->bounds_o);
        return;
    }
    const float* boxes = geometry.boxes + static_cast<int64_t>(primitive) * cluster_floats;
    set_bounds(cluster_bounds(boxes), *args->bounds_o);
}

}  // namespace

extern const ShapeCallbacks shape_callbacks;
const ShapeCallbacks shape_callbacks = {bounds, intersect, occluded};

}  // namespace OBSCURA_ISA
}  // namespace obscura
