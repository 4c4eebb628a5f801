// app/autofocus.cpp - the camera of a request, focused on what one pixel shows where that is asked.
// SPDX-License-Identifier: Apache-2.0
#include "app/autofocus.h"

#include "app/numbers.h"

#include <cmath>

namespace obscura {

namespace {

tl::unexpected<Error> refuse(const std::string& message) {
    return fail(ExitCode::usage, "E-CAM-FOCUS", "--focus-on", message);
}

/// Metres along the view axis to what the pixel shows; 0: nothing.
Result<double> depth_of_pixel(const PreparedScene& prepared,
                              const Camera& camera,
                              RenderOptions options,
                              const std::array<int, 2>& pixel) {
    options.integrator = Integrator::depth;
    options.crop = PixelRect{pixel[0], pixel[1], 1, 1};
    const std::atomic<bool> never = false;
    const Result<RenderResult> result = render(prepared, camera, options, {}, never);
    if (!result) return fail(result.error());
    const size_t at = static_cast<size_t>(pixel[1]) * static_cast<size_t>(options.width) +
                      static_cast<size_t>(pixel[0]);
    return static_cast<double>(result->film.pixels[at]);
}

}  // namespace

Result<ChosenCamera> choose_unfocused_camera(const Scene& scene,
                                             const RenderRequest& request,
                                             Log& log) {
    const RenderOptions& options = request.options;
    Result<ChosenCamera> chosen =
        choose_camera(scene, request.camera, options.width, options.height, log);
    if (!chosen || !request.camera.focus_on_px) return chosen;
    if (chosen->camera.model != CameraModel::thin_lens) {
        return refuse("this camera has no lens; expected a thin lens: --fstop N or --lens-radius");
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
    CameraRequest asked = request.camera;
    // A real lens' angle of view depends a little on its focus, so the pixel is asked again.
    constexpr int most_rounds = 8;
    double before = 0;
    for (int round = 0; round < most_rounds; ++round) {
        const Result<double> depth = depth_of_pixel(prepared, camera.camera, options, pixel);
        if (!depth) return fail(depth.error());
        if (!(*depth > 0)) return refuse("the pixel shows nothing to focus on; choose another");
        asked.settings.focus_distance_m = *depth;
        if (std::abs(*depth - before) <= 1e-7 * *depth) break;
        before = *depth;
        Result<ChosenCamera> chosen =
            choose_camera(prepared.scene(), asked, options.width, options.height, log);
        if (!chosen) return fail(chosen.error());
        camera = std::move(*chosen);
    }
    log.detail("focus: " + shortest(before) + " m");
    return {};
}

}  // namespace obscura
