// scene/frame_motion.h - where a scene's parts are one frame before and after an image's time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/motion.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// The vertices of a primitive at three frames: vertex v at frame s starts at base + s * stride +
/// 3 v of FrameMotion::positions. Read as 32-bit words.
struct FrameVertices {
    int32_t base = no_attribute;  ///< no_attribute: the vertices stand still
    int32_t stride = 0;
};

/// A scene one frame before an image's time, at that time, and one frame after it, for motion
/// vectors. Beside Motion, which an open shutter needs.
struct FrameMotion {
    std::vector<float> positions;         ///< ends with four more floats, as Scene's own
    std::vector<FrameVertices> vertices;  ///< by primitive
    std::vector<Affinef> instances;       ///< world_from_object of moving instances, three each
    std::vector<int32_t> instance;        ///< by instance: the first of its three; -1: it stands
    std::array<std::vector<SceneCamera>, 3> cameras;
};

/// Finds what moves between three poses of a scene.
///
/// In      scene: any pose of the same asset; frames: three poses
/// Out     true; false, with cameras alone, when the poses have other parts than the scene has (a
///         node appears meanwhile): all its surfaces then stand still
bool make_frame_motion(const Scene& scene, std::span<const ScenePose> frames, FrameMotion& out);

/// Fits the motion to a scene from which instances were left out since it was made.
///
/// In      before: the scene's instances as they were, of which `after` keeps some in their order
void leave_out_frames(const std::vector<Instance>& before,
                      const std::vector<Instance>& after,
                      FrameMotion& motion);

}  // namespace obscura
