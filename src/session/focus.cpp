// session/focus.cpp - autofocus: focuses a camera on what one pixel shows.
// SPDX-License-Identifier: Apache-2.0
#include "session/focus.h"

#include "base/setting_names.h"
#include "base/text.h"

#include <cmath>

namespace obscura {

namespace {

tl::unexpected<Error> refuse(const std::string& message) {
    return fail(ExitCode::usage, "E-CAM-FOCUS", setting("focus-on"), message);
}

/// Metres along the view axis to what the pixel shows, by one ray; 0: nothing.
Result<double> depth_of_pixel(const PreparedScene& prepared,
                              const Camera& camera,
                              RenderOptions options,
                              const std::array<int, 2>& pixel) {
    options.integrator = Integrator::depth;  // it has no other layers
    options.layers.clear();
    options.light_groups = {};
    options.crop = PixelRect{pixel[0], pixel[1], 1, 1};
    const std::atomic<bool> never = false;
    const Result<RenderResult> result = render(prepared, camera, options, {}, never);
    if (!result) return fail(result.error());
    return static_cast<double>(result->film.pixels.front());
}

}  // namespace

Result<ChosenCamera> choose_unfocused_camera(const FramedScene& framed,
                                             const RenderRequest& request,
                                             Log& log) {
    const RenderOptions& options = request.options;
    Result<ChosenCamera> chosen =
        choose_camera(framed, request.camera, options.width, options.height, log);
    if (!chosen) return chosen;
    if (request.overscan && chosen->camera.model == CameraModel::environment) {
        return fail(ExitCode::usage,
                    "E-CAM-OVERSCAN",
                    setting("overscan"),
                    "this camera's image shows all directions: there is nothing around it; leave "
                    "it out, or choose another camera model");
    }
    if (!request.camera.focus_on_px) return chosen;
    if (chosen->camera.model != CameraModel::thin_lens) {
        return refuse("this camera has no lens; expected a thin lens: " + setting("fstop") +
                      " N or " + setting("lens-radius"));
    }
    const std::array<int, 2> pixel = *request.camera.focus_on_px;
    if (pixel[0] >= options.width || pixel[1] >= options.height) {
        return refuse("the pixel is outside the picture of " + std::to_string(options.width) + "x" +
                      std::to_string(options.height));
    }
    return chosen;
}

Result<void> focus(const PreparedScene& prepared,
                   const RenderRequest& request,
                   Log& log,
                   ChosenCamera& camera) {
    if (!request.camera.focus_on_px) return {};
    const std::array<int, 2> pixel = *request.camera.focus_on_px;
    const RenderOptions& options = request.options;
    // A real lens' angle of view changes slightly with its focus, so the pixel is traced again.
    constexpr int max_rounds = 8;
    double before = 0;
    for (int round = 0; round < max_rounds; ++round) {
        const Result<double> depth = depth_of_pixel(prepared, camera.camera, options, pixel);
        if (!depth) return fail(depth.error());
        if (!(*depth > 0)) return refuse("the pixel shows nothing to focus on; choose another");
        if (std::abs(*depth - before) <= 1e-7 * *depth) break;
        before = *depth;
        const Result<void> sharp = refocus(camera, *depth, prepared.scene().info.file_name);
        if (!sharp) return sharp;
    }
    log.detail("focus: " + shortest(before) + " m");
    return {};
}

}  // namespace obscura
