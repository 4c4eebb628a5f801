// session/library_camera.cpp - the camera that a library's caller gives as OpenCV describes it.
// SPDX-License-Identifier: Apache-2.0
#include "session/library_camera.h"

#include "gltf/camera_json.h"

#include <algorithm>
#include <cmath>

namespace obscura {

Result<void> place_opencv(const v0::View& view, CameraRequest& request) {
    if (!view.opencv) return {};
    const v0::OpenCvCamera& from = *view.opencv;
    const bool has_size = from.width != 0 || from.height != 0;
    // The same rules and the same bits as from a file.
    const nlohmann::json keys = {{"K", from.K},
                                 {"R", from.R},
                                 {"t", from.t},
                                 {"width", std::max(0, has_size ? from.width : view.width)},
                                 {"height", std::max(0, has_size ? from.height : view.height)},
                                 {"pixel_center", from.pixel_center}};
    JsonFault fault;
    fault.file = "opencv";
    const JsonReader reader(keys, "", fault);
    const auto finite = [](const auto& numbers) {
        return std::all_of(
            numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
    };
    if (!finite(from.K)) reader.fault("K", "E-CAM-VALUE", "it is not finite");
    if (!finite(from.t)) reader.fault("t", "E-CAM-VALUE", "it is not finite");
    SceneCamera camera = gltf::read_camera(reader, keys, {});
    if (fault.error) return fail(std::move(*fault.error));
    camera.name = "opencv";
    request.loaded = std::move(camera);
    return {};
}

}  // namespace obscura
