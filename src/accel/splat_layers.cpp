// accel/splat_layers.cpp - finds the Gaussian splats along a ray and blends them in order.
// SPDX-License-Identifier: Apache-2.0
#include "accel/splat_layers.h"

#include "accel/accel_impl.h"
#include "accel/safe_ray.h"
#include "surface/srgb.h"

#include <algorithm>
#include <vector>

namespace obscura {

namespace {

/// A list that owns its memory.
struct OwnedList : SplatList {
    std::vector<SplatLayer> memory = std::vector<SplatLayer>(256);
    void begin() {
        layers = memory.data();
        capacity = static_cast<int>(memory.size());
        count = 0;
    }
};

/// Sorts from near to far; ties are broken in the same way in every list.
void sort_layers(SplatList& list) {
    std::sort(list.layers, list.layers + list.count, [](const SplatLayer& a, const SplatLayer& b) {
        return a.t != b.t ? a.t < b.t : a.index < b.index;
    });
}

/// Lists the splats that ray i passes, from near to far.
void list_layers(const Accel::Impl& impl, const RayColumns& rays, int i, OwnedList& list) {
    list.begin();
    SplatContext context;
    context.list = &list;
    Query query(context.common, false);
    RTCRayHit hit;
    load_ray(rays, i, hit.ray);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect1(impl.splats, &hit);
    sort_layers(list);
}

/// Blended light of the splats with one colour space.
struct BlendedColor {
    Vec3f sum = {0, 0, 0};
    float weight = 0;
};

/// Linear light: the decoded mean colour times its coverage.
Vec3f light_of(const BlendedColor& color, bool linear) {
    if (linear || color.weight <= 0) return color.sum;
    const Vec3f mean = color.sum * (1.0f / color.weight);
    return Vec3f{linear_from_srgb(mean.x), linear_from_srgb(mean.y), linear_from_srgb(mean.z)} *
           color.weight;
}

/// Transmittance of all layers.
float transmittance_of(const SplatList& list) {
    float passes = 1;
    for (int i = 0; i < list.count; ++i) {
        passes *= 1.0f - list.layers[i].alpha;
        if (passes < min_transmittance) return 0;
    }
    return passes;
}

/// The ray along which splats are seen.
struct SplatView {
    Vec3f origin, direction;
    bool parallel = false;  ///< all rays have the direction
};

struct BlendedLayers {
    Vec3f light;
    float transmittance;
};

/// Blends encoded colours and decodes the result, as splats were trained.
BlendedLayers blend_layers(const SplatField& field, const SplatList& list, const SplatView& view) {
    BlendedColor colors[2];  // with the sRGB curve, and linear ones
    float passes = 1;
    for (int i = 0; i < list.count && passes > 0; ++i) {
        const auto index = static_cast<size_t>(list.layers[i].index);
        const auto group = static_cast<size_t>(field.group_of_block[index / splat_block]);
        const float* mean =
            &field.blocks[index / splat_block * splat_block_floats + index % splat_block];
        const Vec3f centre{mean[0], mean[splat_block], mean[2 * splat_block]};
        const Vec3f direction = view.parallel ? view.direction : centre - view.origin;
        const float weight = passes * list.layers[i].alpha;
        BlendedColor& color = colors[field.groups[group].linear ? 1 : 0];
        color.sum = color.sum + splat_color(field, index, direction) * weight;
        color.weight += weight;
        passes *= 1.0f - list.layers[i].alpha;
        if (passes < min_transmittance) passes = 0;
    }
    return {light_of(colors[0], false) + light_of(colors[1], true), passes};
}

}  // namespace

float make_room(SplatList& list, float end) {
    sort_layers(list);
    float passes = 1;
    for (int i = 0; i < list.count; ++i) {
        passes *= 1.0f - list.layers[i].alpha;
        // Well below the limit, so that the product over all layers is below it despite rounding.
        if (passes >= 0.99f * min_transmittance) continue;
        end = std::min(end, list.layers[i].t);
        list.count = i + 1;
        break;
    }
    if (list.count > list.capacity / 2) {
        auto& owned = static_cast<OwnedList&>(list);
        owned.memory.resize(owned.memory.size() * 2);
        owned.layers = owned.memory.data();
        owned.capacity = static_cast<int>(owned.memory.size());
    }
    return end;
}

void build_splats(Accel::Impl& impl) {
    if (impl.splats != nullptr) rtcReleaseScene(impl.splats);
    impl.splats = nullptr;
    const SplatField& field = impl.scene->splats;
    if (field.empty()) return;
    impl.splat_geometry = {field.blocks.data(), field.boxes.data()};
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(field.boxes.size()));
    rtcSetGeometryUserData(geometry, &impl.splat_geometry);
    rtcSetGeometryBoundsFunction(geometry, impl.functions.splats->bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, impl.functions.splats->intersect);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    impl.splats = rtcNewScene(impl.device);
    rtcSetSceneFlags(impl.splats, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(impl.splats, RTC_BUILD_QUALITY_HIGH);
    rtcAttachGeometry(impl.splats, geometry);
    rtcReleaseGeometry(geometry);
    commit_scene(impl.splats);
}

bool Accel::has_splats() const {
    return impl_->splats != nullptr;
}

void Accel::blend_splats(const RayColumns& rays, bool parallel, const SplatColumns& out) const {
    OwnedList list;
    for (int i = 0; i < rays.count; ++i) {
        BlendedLayers blended{{0, 0, 0}, 1};
        if (is_safe(rays, i, impl_->reach)) {
            list_layers(*impl_, rays, i, list);
            blended = blend_layers(impl_->scene->splats,
                                   list,
                                   {{rays.ox[i], rays.oy[i], rays.oz[i]},
                                    {rays.dx[i], rays.dy[i], rays.dz[i]},
                                    parallel});
        }
        out.r[i] = blended.light.x;
        out.g[i] = blended.light.y;
        out.b[i] = blended.light.z;
        out.transmittance[i] = blended.transmittance;
    }
}

void Accel::dim_by_splats(const RayColumns& rays,
                          const uint8_t* skips,
                          float* transmittance) const {
    OwnedList list;
    for (int i = 0; i < rays.count; ++i) {
        transmittance[i] = 1;
        if (skips[i] == 1 || !is_safe(rays, i, impl_->reach)) continue;
        list_layers(*impl_, rays, i, list);
        transmittance[i] = transmittance_of(list);
    }
}

}  // namespace obscura
