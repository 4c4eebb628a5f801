// session/opencv_camera.cpp - a chosen camera as computer vision writes it: K, R and t.
// SPDX-License-Identifier: Apache-2.0
#include "session/opencv_camera.h"

namespace obscura {

std::optional<Intrinsics> intrinsics_of(const Camera& camera, const ImageSize& size) {
    if (camera.model != CameraModel::pinhole && camera.model != CameraModel::thin_lens) return {};
    const PinholeCamera& film = camera.pinhole;
    const double half_height = static_cast<double>(film.tan_half_yfov);
    const double half_width = half_height * static_cast<double>(film.aspect);
    const double width = size.width_px;
    const double height = size.height_px;
    Intrinsics out{width, height, 0.5 * width / half_width, 0.5 * height / half_height};
    out.cx_px = 0.5 * width - out.fx_px * static_cast<double>(film.shift_x);
    out.cy_px = 0.5 * height + out.fy_px * static_cast<double>(film.shift_y);
    return out;
}

Affined opencv_from_world(const Camera& camera) {
    Affined out = inverse(affine_cast<double>(camera.world_from_camera));
    for (int c = 0; c < 4; ++c) {
        out.m[1][c] = -out.m[1][c];
        out.m[2][c] = -out.m[2][c];
    }
    return out;
}

Json intrinsics_json(const ChosenCamera& chosen, const ImageSize& size) {
    const std::optional<Intrinsics> k = intrinsics_of(chosen.camera, size);
    if (!k) return nullptr;
    return {{k->fx_px, 0, k->cx_px}, {0, k->fy_px, k->cy_px}, {0, 0, 1}};
}

void add_pose_json(const Camera& camera, Json& out) {
    const Affined from_world = opencv_from_world(camera);
    out["R"] = Json::array();
    for (const auto& row : from_world.m)
        out["R"].push_back({row[0], row[1], row[2]});
    out["t"] = {from_world.m[0][3], from_world.m[1][3], from_world.m[2][3]};
}

}  // namespace obscura
