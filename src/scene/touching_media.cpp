// scene/touching_media.cpp - finds media whose boundaries may share faces.
// SPDX-License-Identifier: Apache-2.0
#include "scene/touching_media.h"

#include "scene/media.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr float far_away = 3e38f;

/// The box around one instance of a medium's boundary.
struct Boundary {
    Vec3f low, high;
    int32_t primitive = 0;
};

void grow(Boundary& box, const Vec3f& low, const Vec3f& high) {
    box.low = -max3(-box.low, -low);
    box.high = max3(box.high, high);
}

/// The box in the primitive's own space. Infinite for primitives that move and for those that are
/// neither meshes nor shapes.
Boundary own_box(const Scene& scene, int32_t number) {
    const Primitive& primitive = scene.primitives[static_cast<size_t>(number)];
    const Vec3f far{far_away, far_away, far_away};
    Boundary box{far, -far, number};
    const auto first = static_cast<size_t>(primitive.first_triangle);
    const auto count = static_cast<size_t>(primitive.triangle_count);
    const bool still = !moves(primitive);
    if (still && is_mesh(primitive)) {
        for (size_t i = 3 * first; i < 3 * (first + count); ++i) {
            const float* p = &scene.positions[3 * static_cast<size_t>(scene.indices[i])];
            const Vec3f corner{p[0], p[1], p[2]};
            grow(box, corner, corner);
        }
    } else if (still && primitive.geometry == static_cast<int32_t>(GeometryKind::shapes)) {
        for (size_t i = first; i < first + count; ++i) {
            const ShapeBox around = shape_bounds(scene.shapes[i]);
            grow(box, around.low, around.high);
        }
    } else {
        grow(box, -far, far);
    }
    return box;
}

Boundary placed(const Boundary& own, const Instance& instance) {
    const Vec3f far{far_away, far_away, far_away};
    Boundary box{far, -far, own.primitive};
    const bool infinite = max_component(max3(abs(own.low), abs(own.high))) >= far_away;
    if (moves(instance) || infinite) return {-far, far, own.primitive};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3f p = transform_point(instance.world_from_object,
                                        {(corner & 1U) != 0 ? own.high.x : own.low.x,
                                         (corner & 2U) != 0 ? own.high.y : own.low.y,
                                         (corner & 4U) != 0 ? own.high.z : own.low.z});
        grow(box, p, p);
    }
    return box;
}

/// World boxes, enlarged by 1/10,000 of their coordinates for rounding in transforms and modelling.
std::vector<Boundary> find_boundaries(const Scene& scene) {
    std::vector<Boundary> out;
    for (int32_t i = 0; i < scene.world_primitive_count; ++i) {
        if (medium_of(scene, scene.primitives[static_cast<size_t>(i)]) > 0) {
            out.push_back(own_box(scene, i));
        }
    }
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        std::vector<Boundary> own;
        const Mesh& mesh = scene.meshes[m];
        for (int32_t i = mesh.first_primitive; i < mesh.first_primitive + mesh.primitive_count;
             ++i) {
            if (medium_of(scene, scene.primitives[static_cast<size_t>(i)]) > 0) {
                own.push_back(own_box(scene, i));
            }
        }
        if (own.empty()) continue;
        for (const Instance& instance : scene.instances) {
            if (instance.mesh != static_cast<int32_t>(m)) continue;
            for (const Boundary& box : own)
                out.push_back(placed(box, instance));
        }
    }
    for (Boundary& box : out) {
        const Vec3f size = max3(abs(box.low), abs(box.high));
        const float room = 1e-4f * std::min(max_component(size), 1e30f);
        box.low = box.low - Vec3f{room, room, room};
        box.high = box.high + Vec3f{room, room, room};
    }
    return out;
}

bool touch(const Boundary& a, const Boundary& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y &&
           b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z;
}

}  // namespace

std::vector<int32_t> find_touching_media(const Scene& scene) {
    if (scene.media.size() < 2) return {};
    std::vector<Boundary> boundaries = find_boundaries(scene);
    std::sort(boundaries.begin(), boundaries.end(), [](const Boundary& a, const Boundary& b) {
        return a.low.x < b.low.x;
    });
    const auto medium = [&](const Boundary& box) {
        return medium_of(scene, scene.primitives[static_cast<size_t>(box.primitive)]);
    };
    std::vector<int32_t> out(scene.primitives.size(), 0);
    bool any = false;
    // After this many comparisons, the remaining boundaries count as touching.
    size_t comparisons_left = 20'000'000;
    for (size_t i = 0; i < boundaries.size(); ++i) {
        int32_t& own = out[static_cast<size_t>(boundaries[i].primitive)];
        for (size_t k = i + 1; k < boundaries.size(); ++k) {
            if (boundaries[k].low.x > boundaries[i].high.x) break;
            int32_t& other = out[static_cast<size_t>(boundaries[k].primitive)];
            if (own != 0 && other != 0) continue;
            if (comparisons_left > 0) --comparisons_left;
            if (comparisons_left > 0 && !touch(boundaries[i], boundaries[k])) continue;
            own = medium(boundaries[i]);
            other = medium(boundaries[k]);
            any = true;
        }
    }
    if (!any) out.clear();
    return out;
}

}  // namespace obscura
