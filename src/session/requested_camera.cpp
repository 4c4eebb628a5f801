// session/requested_camera.cpp - reads the camera of --camera-json before anything else.
// SPDX-License-Identifier: Apache-2.0
#include "session/requested_camera.h"

#include "gltf/camera_json.h"

namespace obscura {

Result<void> load_requested_camera(RenderRequest& request, Log& log) {
    if (!request.camera_json) return {};
    Result<SceneCamera> camera = gltf::load_camera_json(*request.camera_json, log);
    if (!camera) return fail(camera.error());
    const Intrinsics& intrinsics = *camera->settings.intrinsics;
    if (!request.size_is_given) {
        request.options.width = static_cast<int>(intrinsics.width_px);
        request.options.height = static_cast<int>(intrinsics.height_px);
    }
    request.camera.loaded = std::move(*camera);
    return check_crop(request.options);
}

}  // namespace obscura
