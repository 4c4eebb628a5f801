// explain/explain_pixel.h - collects everything that the report of one pixel tells.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "explain/pixel_report.h"
#include "render/render.h"

namespace obscura {

/// The scene, camera and pixel to explain.
struct PixelTask {
    const PreparedScene* scene = nullptr;
    Camera camera;
    RenderOptions options;  ///< image size and background; the integrator is raycast
    PixelPlace pixel;
    std::string file, camera_name;
    size_t max_objects = 16;  ///< that are listed
    bool draws = false;       ///< makes the report's drawing, too
};

/// Renders the pixel with --integrator raycast and the AOVs of its hit, and works the same out in
/// double precision: the camera's ray, every object near it, the light.
///
/// Errors  those of render
Result<PixelReport> explain_pixel(const PixelTask& task);

/// For people: a paragraph a step, every number with its name.
std::string pixel_text(const PixelReport& report);

/// For scripts: one document; docs/cli.md explains the keys.
std::string pixel_json(const PixelReport& report);

}  // namespace obscura
