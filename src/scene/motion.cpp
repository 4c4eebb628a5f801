// scene/motion.cpp - the same scene at several times becomes one scene with motion.
// SPDX-License-Identifier: Apache-2.0
#include "scene/motion.h"

#include <algorithm>
#include <cstring>

namespace obscura {

namespace {

bool have_same_parts(const Scene& a, const Scene& b) {
    const auto same_primitive = [](const Primitive& p, const Primitive& q) {
        return p.first_triangle == q.first_triangle && p.triangle_count == q.triangle_count &&
               p.normal_base == q.normal_base && p.geometry == q.geometry;
    };
    const auto same_instance = [](const Instance& p, const Instance& q) {
        return p.mesh == q.mesh && p.mirrored == q.mirrored;
    };
    return a.positions.size() == b.positions.size() && a.cameras.size() == b.cameras.size() &&
           a.indices == b.indices && a.attributes.size() == b.attributes.size() &&
           std::equal(a.primitives.begin(),
                      a.primitives.end(),
                      b.primitives.begin(),
                      b.primitives.end(),
                      same_primitive) &&
           std::equal(a.instances.begin(),
                      a.instances.end(),
                      b.instances.begin(),
                      b.instances.end(),
                      same_instance);
}

/// The vertices of a primitive: they are stored together.
struct VertexRange {
    size_t first = 0;
    size_t count = 0;
};

VertexRange vertices_of(const Scene& scene, const Primitive& primitive) {
    const auto begin =
        scene.indices.begin() + static_cast<std::ptrdiff_t>(primitive.first_triangle) * 3;
    const auto end = begin + static_cast<std::ptrdiff_t>(primitive.triangle_count) * 3;
    if (begin == end) return {};
    const auto [least, most] = std::minmax_element(begin, end);
    return {*least, static_cast<size_t>(*most) - *least + 1};
}

/// Start of a primitive's normals in Scene::attributes.
size_t normals_start(const Primitive& primitive, const VertexRange& range) {
    return static_cast<size_t>(static_cast<int64_t>(primitive.normal_base) +
                               3 * static_cast<int64_t>(range.first));
}

bool moves(const Scene& first,
           const Scene& later,
           const Primitive& primitive,
           const VertexRange& range) {
    const auto differ = [&](const std::vector<float>& a, const std::vector<float>& b, size_t at) {
        return std::memcmp(&a[at], &b[at], 3 * range.count * sizeof(float)) != 0;
    };
    if (range.count == 0) return false;
    if (differ(first.positions, later.positions, 3 * range.first)) return true;
    return primitive.normal_base != no_attribute &&
           differ(first.attributes, later.attributes, normals_start(primitive, range));
}

void append_pose(const Scene& pose,
                 const Primitive& primitive,
                 const VertexRange& range,
                 Motion& motion) {
    const auto floats = static_cast<std::ptrdiff_t>(3 * range.count);
    const auto p = pose.positions.begin() + static_cast<std::ptrdiff_t>(3 * range.first);
    motion.positions.insert(motion.positions.end(), p, p + floats);
    if (primitive.normal_base == no_attribute) {
        motion.normals.resize(motion.positions.size(), 0.0F);
        return;
    }
    const auto n =
        pose.attributes.begin() + static_cast<std::ptrdiff_t>(normals_start(primitive, range));
    motion.normals.insert(motion.normals.end(), n, n + floats);
}

/// Motion of one primitive's vertices, where they move.
void join_primitive(Scene& first, std::span<const Scene> later, Primitive& primitive) {
    const VertexRange range = vertices_of(first, primitive);
    const auto differs = [&](const Scene& pose) { return moves(first, pose, primitive, range); };
    if (std::none_of(later.begin(), later.end(), differs)) return;
    primitive.motion_stride = static_cast<int32_t>(3 * range.count);
    primitive.motion_base =
        static_cast<int32_t>(static_cast<int64_t>(first.motion.positions.size()) -
                             3 * static_cast<int64_t>(range.first));
    append_pose(first, primitive, range, first.motion);
    for (const Scene& pose : later)
        append_pose(pose, primitive, range, first.motion);
}

template <typename F>
bool is_same(const Affine<F>& a, const Affine<F>& b) {
    return std::equal(&a.m[0][0], &a.m[0][0] + 12, &b.m[0][0]);
}

void join_instance(Scene& first, std::span<const Scene> later, size_t row) {
    Instance& instance = first.instances[row];
    const auto differs = [&](const Scene& pose) {
        return !is_same(instance.world_from_object, pose.instances[row].world_from_object);
    };
    if (std::none_of(later.begin(), later.end(), differs)) return;
    instance.motion = static_cast<int32_t>(first.motion.instances.size());
    first.motion.instances.push_back(instance.world_from_object);
    for (const Scene& pose : later)
        first.motion.instances.push_back(pose.instances[row].world_from_object);
}

void join_camera(SceneCamera& first, std::span<const Scene> later, size_t row) {
    const auto differs = [&](const Scene& pose) {
        return !is_same(first.world_from_camera, pose.cameras[row].world_from_camera);
    };
    if (std::none_of(later.begin(), later.end(), differs)) return;
    first.moving = {first.world_from_camera};
    for (const Scene& pose : later)
        first.moving.push_back(pose.cameras[row].world_from_camera);
}

}  // namespace

Affinef world_from_object_at(const Scene& scene, const Instance& instance, float time) {
    if (instance.motion < 0) return instance.world_from_object;
    const float place = time * static_cast<float>(scene.motion.steps - 1);
    const int32_t step = std::clamp(static_cast<int32_t>(place), 0, scene.motion.steps - 2);
    const float share = place - static_cast<float>(step);
    const Affinef* before =
        &scene.motion.instances[static_cast<size_t>(instance.motion) + static_cast<size_t>(step)];
    Affinef out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = before[0].m[r][c] + (before[1].m[r][c] - before[0].m[r][c]) * share;
    }
    return out;
}

bool join_motion(Scene& first, std::span<const Scene> later) {
    const auto fits = [&](const Scene& pose) { return have_same_parts(first, pose); };
    if (!std::all_of(later.begin(), later.end(), fits)) return false;
    first.motion.steps = static_cast<int32_t>(later.size()) + 1;
    for (Primitive& primitive : first.primitives) {
        if (is_mesh(primitive)) join_primitive(first, later, primitive);
    }
    for (size_t row = 0; row < first.instances.size(); ++row)
        join_instance(first, later, row);
    for (size_t row = 0; row < first.cameras.size(); ++row)
        join_camera(first.cameras[row], later, row);
    for (const Scene& pose : later) {
        first.bounds.low = -max3(-first.bounds.low, -pose.bounds.low);
        first.bounds.high = max3(first.bounds.high, pose.bounds.high);
    }
    Motion& motion = first.motion;
    if (motion.positions.empty() && motion.instances.empty()) motion.steps = 1;
    if (motion.positions.empty()) return true;
    for (std::vector<float>* table : {&motion.positions, &motion.normals})
        table->insert(table->end(), 4, 0.0F);  // as pad_tables
    return true;
}

}  // namespace obscura
