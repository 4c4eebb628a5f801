// render/frame_view.cpp - the scene and the camera of neighbouring frames, for the layer `motion`.
// SPDX-License-Identifier: Apache-2.0
#include "render/frame_view.h"

#include "scene/frame_motion.h"

#include <algorithm>
#include <variant>

namespace obscura {

namespace {

bool is_motion(const Layer& layer) {
    const Aov* aov = std::get_if<Aov>(&layer.source);
    return aov != nullptr && *aov == Aov::motion;
}

}  // namespace

std::optional<FrameView> frame_view(const Scene& scene,
                                    const Camera& camera,
                                    const RenderOptions& options) {
    if (std::none_of(options.layers.begin(), options.layers.end(), is_motion)) return std::nullopt;
    FrameView out;
    out.camera_moves = !options.frame_cameras.empty();
    for (size_t s = 0; s < std::size(out.cameras); ++s) {
        out.cameras[s] = out.camera_moves ? options.frame_cameras[s] : camera;
        out.camera_from_world[s] = inverse(affine_cast<double>(out.cameras[s].world_from_camera));
    }
    if (const FrameMotion* motion = scene.frame_motion.get()) {
        if (!motion->positions.empty()) {
            out.positions = motion->positions.data();
            out.vertices = motion->vertices.data();
        }
        if (!motion->instances.empty()) {
            out.instances = motion->instances.data();
            out.instance = motion->instance.data();
        }
    }
    if (!out.camera_moves && out.positions == nullptr && out.instances == nullptr) {
        return std::nullopt;
    }
    return out;
}

}  // namespace obscura
