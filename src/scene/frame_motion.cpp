// scene/frame_motion.cpp - where a scene's parts are one frame before and after an image's time.
// SPDX-License-Identifier: Apache-2.0
#include "scene/frame_motion.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace obscura {

namespace {

using Frames = std::span<const ScenePose>;

/// Adds the vertices of one primitive, if they move.
void add_vertices(const Scene& scene, Frames frames, size_t index, FrameMotion& out) {
    const Primitive& primitive = scene.primitives[index];
    const StaticSizes& fixed = frames.front().static_sizes;
    if (!is_mesh(primitive) || static_cast<size_t>(primitive.first_triangle) * 3 < fixed.indices)
        return;
    const VertexRange range = vertices_of(scene, primitive);
    if (range.count == 0) return;
    const size_t floats = 3 * range.count;
    const auto start = [&](const ScenePose& pose) {
        return pose.positions.data() + (3 * range.first - fixed.positions);
    };
    const auto differs = [&](const ScenePose& pose) {
        return std::memcmp(start(pose), start(frames.front()), floats * sizeof(float)) != 0;
    };
    if (std::none_of(frames.begin(), frames.end(), differs)) return;
    const auto base =
        static_cast<int64_t>(out.positions.size()) - 3 * static_cast<int64_t>(range.first);
    out.vertices[index] = {static_cast<int32_t>(base), static_cast<int32_t>(floats)};
    for (const ScenePose& pose : frames)
        out.positions.insert(out.positions.end(), start(pose), start(pose) + floats);
}

bool is_same_place(const Affinef& a, const Affinef& b) {
    using Words = std::array<uint32_t, sizeof(Affinef) / sizeof(uint32_t)>;
    return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

/// Adds the placings of one instance, if it moves.
void add_instance(Frames frames, size_t index, FrameMotion& out) {
    const auto place = [&](const ScenePose& pose) -> const Affinef& {
        return pose.instances[index].world_from_object;
    };
    const auto differs = [&](const ScenePose& pose) {
        return !is_same_place(place(pose), place(frames.front()));
    };
    if (std::none_of(frames.begin(), frames.end(), differs)) return;
    out.instance[index] = static_cast<int32_t>(out.instances.size());
    for (const ScenePose& pose : frames)
        out.instances.push_back(place(pose));
}

}  // namespace

bool make_frame_motion(const Scene& scene, Frames frames, FrameMotion& out) {
    out = {};
    out.vertices.resize(scene.primitives.size());
    out.instance.assign(scene.instances.size(), -1);
    for (size_t s = 0; s < frames.size(); ++s)
        out.cameras[s] = frames[s].cameras;
    const auto fits = [&](const ScenePose& pose) { return have_same_structure(scene, pose); };
    if (!std::all_of(frames.begin(), frames.end(), fits)) return false;
    for (size_t index = 0; index < scene.primitives.size(); ++index)
        add_vertices(scene, frames, index, out);
    for (size_t index = 0; index < scene.instances.size(); ++index)
        add_instance(frames, index, out);
    if (!out.positions.empty()) out.positions.insert(out.positions.end(), 4, 0.0F);
    return true;
}

void leave_out_frames(const std::vector<Instance>& before,
                      const std::vector<Instance>& after,
                      FrameMotion& motion) {
    std::vector<int32_t> kept;
    size_t next = 0;
    for (const Instance& instance : after) {
        const auto is_it = [&](const Instance& earlier) {
            return earlier.mesh == instance.mesh && earlier.node == instance.node &&
                   is_same_place(earlier.world_from_object, instance.world_from_object);
        };
        while (next < before.size() && !is_it(before[next]))
            ++next;
        kept.push_back(next < before.size() ? motion.instance[next++] : -1);
    }
    motion.instance = std::move(kept);
}

}  // namespace obscura
