// accel/splat_callbacks.cpp - Embree's callbacks for splats; compiled once per instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/splat_layers.h"
#include "shape/splat.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Lists the splats of one block that one ray passes between its ends.
OBSCURA_INLINE void list_block(const float* block,
                               int32_t first_index,
                               const ShapeRay<float>& ray,
                               const Span<float>& limits,
                               SplatList& list) {
    const auto all = [](const Vec3f& v) { return Vec3<Lanes>{Lanes(v.x), Lanes(v.y), Lanes(v.z)}; };
    const ShapeRay<Lanes> rays{all(ray.origin), all(ray.direction)};
    for (int i = 0; i < splat_block; i += lane_count) {
        const SplatPassage<Lanes> passage = pass_splat(read_splats(block, i), rays);
        uint32_t bits = mask_bits((passage.alpha > Lanes(0.0f)) & (passage.t > Lanes(limits.low)) &
                                  (passage.t <= Lanes(limits.high)));
        if (bits == 0) continue;
        alignas(64) float t[lane_count];
        alignas(64) float alpha[lane_count];
        store(t, passage.t);
        store(alpha, passage.alpha);
        for (; bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            list.layers[list.count++] = {t[lane], alpha[lane], first_index + i + lane};
        }
    }
}

void intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& geometry = *static_cast<const SplatGeometry*>(args->geometryUserPtr);
    SplatList& list = *reinterpret_cast<const SplatContext*>(args->context)->list;
    if (args->valid[0] == 0) return;
    // Rays come one by one.
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    const ShapeRay<float> ray{
        {RTCRayN_org_x(rays, 1, 0), RTCRayN_org_y(rays, 1, 0), RTCRayN_org_z(rays, 1, 0)},
        {RTCRayN_dir_x(rays, 1, 0), RTCRayN_dir_y(rays, 1, 0), RTCRayN_dir_z(rays, 1, 0)}};
    float& end = RTCRayN_tfar(rays, 1, 0);
    list_block(geometry.blocks + static_cast<int64_t>(args->primID) * splat_block_floats,
               static_cast<int32_t>(args->primID) * splat_block,
               ray,
               {RTCRayN_tnear(rays, 1, 0), end},
               list);
    if (list.count + splat_block > list.capacity) end = make_room(list, end);
}

void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& geometry = *static_cast<const SplatGeometry*>(args->geometryUserPtr);
    const ShapeBox& box = geometry.boxes[args->primID];
    *args->bounds_o = {
        box.low.x, box.low.y, box.low.z, 0.0f, box.high.x, box.high.y, box.high.z, 0.0f};
}

}  // namespace

extern const SplatCallbacks splat_callbacks;
const SplatCallbacks splat_callbacks = {bounds, intersect};

}  // namespace OBSCURA_ISA
}  // namespace obscura
