// app/stroke_scaling.cpp - points and lines get their size before the picture's camera is made.
// SPDX-License-Identifier: Apache-2.0
#include "app/stroke_scaling.h"

namespace obscura {

Result<void> scale_strokes(const RenderRequest& request, Scene& scene) {
    if (!has_strokes(scene)) return {};
    const StrokeSizes& sizes = request.strokes;
    Camera camera;
    if (sizes.points.unit == LengthUnit::pixels || sizes.lines.unit == LengthUnit::pixels) {
        Log silent(Verbosity::quiet);  // the same camera is chosen again, and talked about, later
        const RenderOptions& options = request.options;
        const Result<ChosenCamera> chosen =
            choose_camera(scene, request.camera, options.width, options.height, silent);
        if (!chosen) return fail(chosen.error());
        camera = chosen->camera;
    }
    size_strokes(sizes, camera, scene);
    return {};
}

}  // namespace obscura
