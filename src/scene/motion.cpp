// scene/motion.cpp - merges several poses of a scene into one scene with motion blur.
// SPDX-License-Identifier: Apache-2.0
#include "scene/motion.h"

#include <algorithm>
#include <cstring>

namespace obscura {

namespace {

using Poses = std::span<const ScenePose>;

/// Whether two arrays are equal after their static part.
bool has_same_tail(const LargeArray<uint32_t>& all,
                   size_t static_size,
                   const LargeArray<uint32_t>& tail) {
    return all.size() == static_size + tail.size() &&
           std::equal(tail.begin(), tail.end(), &all[static_size]);
}

/// Start of a primitive's normals in Scene::attributes.
size_t normals_start(const Primitive& primitive, const VertexRange& range) {
    return static_cast<size_t>(static_cast<int64_t>(primitive.normal_base) +
                               3 * static_cast<int64_t>(range.first));
}

bool moves(const Scene& first,
           const ScenePose& later,
           const Primitive& primitive,
           const VertexRange& range) {
    const size_t bytes = 3 * range.count * sizeof(float);
    const size_t p = 3 * range.first;
    if (std::memcmp(
            &first.positions[p], &later.positions[p - later.static_sizes.positions], bytes) != 0) {
        return true;
    }
    if (primitive.normal_base == no_attribute) return false;
    const size_t n = normals_start(primitive, range);
    return std::memcmp(&first.attributes[n],
                       &later.attributes[n - later.static_sizes.attributes],
                       bytes) != 0;
}

/// The start of a primitive's vertices in one pose.
struct PoseArrays {
    const float* positions;
    const float* normals;  ///< null: it has none
};

void append_pose(const PoseArrays& pose, size_t floats, Motion& motion) {
    motion.positions.insert(motion.positions.end(), pose.positions, pose.positions + floats);
    if (pose.normals == nullptr) {
        motion.normals.resize(motion.positions.size(), 0.0F);
        return;
    }
    motion.normals.insert(motion.normals.end(), pose.normals, pose.normals + floats);
}

/// Adds the motion of one primitive's vertices, if they move.
void join_primitive(Scene& first, Poses later, Primitive& primitive) {
    const StaticSizes& static_sizes = later.front().static_sizes;
    if (static_cast<size_t>(primitive.first_triangle) * 3 < static_sizes.indices) return;
    const VertexRange range = vertices_of(first, primitive);
    if (range.count == 0) return;
    const auto differs = [&](const ScenePose& pose) {
        return moves(first, pose, primitive, range);
    };
    if (std::none_of(later.begin(), later.end(), differs)) return;
    const size_t floats = 3 * range.count;
    primitive.motion_stride = static_cast<int32_t>(floats);
    primitive.motion_base =
        static_cast<int32_t>(static_cast<int64_t>(first.motion.positions.size()) -
                             3 * static_cast<int64_t>(range.first));
    const bool has_normals = primitive.normal_base != no_attribute;
    const size_t p = 3 * range.first;
    const size_t n = has_normals ? normals_start(primitive, range) : 0;
    const auto append = [&](const float* positions, const float* normals) {
        append_pose({positions, has_normals ? normals : nullptr}, floats, first.motion);
    };
    append(&first.positions[p], first.attributes.data() + n);
    for (const ScenePose& pose : later) {
        append(&pose.positions[p - static_sizes.positions],
               has_normals ? &pose.attributes[n - static_sizes.attributes] : nullptr);
    }
}

template <typename F>
bool is_same(const Affine<F>& a, const Affine<F>& b) {
    return std::equal(&a.m[0][0], &a.m[0][0] + 12, &b.m[0][0]);
}

void join_instance(Scene& first, Poses later, size_t index) {
    Instance& instance = first.instances[index];
    const auto differs = [&](const ScenePose& pose) {
        return !is_same(instance.world_from_object, pose.instances[index].world_from_object);
    };
    if (std::none_of(later.begin(), later.end(), differs)) return;
    instance.motion = static_cast<int32_t>(first.motion.instances.size());
    first.motion.instances.push_back(instance.world_from_object);
    for (const ScenePose& pose : later)
        first.motion.instances.push_back(pose.instances[index].world_from_object);
}

void join_camera(SceneCamera& first, Poses later, size_t index) {
    const auto differs = [&](const ScenePose& pose) {
        return !is_same(first.world_from_camera, pose.cameras[index].world_from_camera);
    };
    if (std::none_of(later.begin(), later.end(), differs)) return;
    first.moving = {first.world_from_camera};
    for (const ScenePose& pose : later)
        first.moving.push_back(pose.cameras[index].world_from_camera);
}

void join_lights(Scene& first, Poses later) {
    const auto differs = [&](const ScenePose& pose) {
        return std::memcmp(first.lights.data(),
                           pose.lights.data(),
                           first.lights.size() * sizeof(PunctualLight)) != 0;
    };
    if (first.lights.empty() || std::none_of(later.begin(), later.end(), differs)) return;
    for (size_t index = 0; index < first.lights.size(); ++index) {
        first.motion.lights.push_back(first.lights[index]);
        for (const ScenePose& pose : later)
            first.motion.lights.push_back(pose.lights[index]);
    }
}

}  // namespace

bool have_same_structure(const Scene& a, const ScenePose& b) {
    const auto same_primitive = [](const Primitive& p, const Primitive& q) {
        return p.first_triangle == q.first_triangle && p.triangle_count == q.triangle_count &&
               p.normal_base == q.normal_base && p.geometry == q.geometry;
    };
    const auto same_instance = [](const Instance& p, const Instance& q) {
        return p.mesh == q.mesh && p.mirrored == q.mirrored;
    };
    const auto same_light = [](const PunctualLight& p, const PunctualLight& q) {
        return p.type == q.type && p.profile == q.profile;
    };
    const auto all_same = [](const auto& p, const auto& q, const auto& same) {
        return std::equal(p.begin(), p.end(), q.begin(), q.end(), same);
    };
    return a.positions.size() == b.static_sizes.positions + b.positions.size() &&
           a.cameras.size() == b.cameras.size() &&
           has_same_tail(a.indices, b.static_sizes.indices, b.indices) &&
           a.attributes.size() == b.static_sizes.attributes + b.attributes.size() &&
           all_same(a.primitives, b.primitives, same_primitive) &&
           all_same(a.instances, b.instances, same_instance) &&
           all_same(a.lights, b.lights, same_light);
}

VertexRange vertices_of(const Scene& scene, const Primitive& primitive) {
    const auto begin =
        scene.indices.begin() + static_cast<std::ptrdiff_t>(primitive.first_triangle) * 3;
    const auto end = begin + static_cast<std::ptrdiff_t>(primitive.triangle_count) * 3;
    if (begin == end) return {};
    const auto [least, most] = std::minmax_element(begin, end);
    return {*least, static_cast<size_t>(*most) - *least + 1};
}

Affinef world_from_object_at(const Scene& scene, const Instance& instance, float time) {
    if (instance.motion < 0) return instance.world_from_object;
    const float position = time * static_cast<float>(scene.motion.steps - 1);
    const int32_t step = std::clamp(static_cast<int32_t>(position), 0, scene.motion.steps - 2);
    const float fraction = position - static_cast<float>(step);
    const Affinef* before =
        &scene.motion.instances[static_cast<size_t>(instance.motion) + static_cast<size_t>(step)];
    Affinef out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = before[0].m[r][c] + (before[1].m[r][c] - before[0].m[r][c]) * fraction;
    }
    return out;
}

ScenePose take_pose(Scene& scene, const StaticSizes& static_sizes) {
    const auto tail = [](const auto& all, size_t from) {
        using Array = std::decay_t<decltype(all)>;
        return Array(all.begin() + static_cast<std::ptrdiff_t>(from), all.end());
    };
    return {static_sizes,
            tail(scene.positions, static_sizes.positions),
            tail(scene.indices, static_sizes.indices),
            tail(scene.attributes, static_sizes.attributes),
            std::move(scene.primitives),
            std::move(scene.instances),
            std::move(scene.cameras),
            std::move(scene.lights),
            scene.bounds};
}

bool join_motion(Scene& first, std::span<const ScenePose> later) {
    if (later.empty()) return true;
    const auto fits = [&](const ScenePose& pose) { return have_same_structure(first, pose); };
    if (!std::all_of(later.begin(), later.end(), fits)) return false;
    Motion& motion = first.motion;
    motion.steps = static_cast<int32_t>(later.size()) + 1;
    for (Primitive& primitive : first.primitives) {
        if (is_mesh(primitive)) join_primitive(first, later, primitive);
    }
    for (size_t index = 0; index < first.instances.size(); ++index)
        join_instance(first, later, index);
    for (size_t index = 0; index < first.cameras.size(); ++index)
        join_camera(first.cameras[index], later, index);
    join_lights(first, later);
    for (const ScenePose& pose : later) {
        first.bounds.low = -max3(-first.bounds.low, -pose.bounds.low);
        first.bounds.high = max3(first.bounds.high, pose.bounds.high);
    }
    const bool moves =
        !motion.positions.empty() || !motion.instances.empty() || !motion.lights.empty();
    if (!moves) motion.steps = 1;
    if (motion.positions.empty()) return true;
    for (std::vector<float>* table : {&motion.positions, &motion.normals})
        table->insert(table->end(), 4, 0.0F);  // as pad_tables
    return true;
}

}  // namespace obscura
