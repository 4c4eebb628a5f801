// session/render_request.cpp - lists the images of a request and checks the part to render.
// SPDX-License-Identifier: Apache-2.0
#include "session/render_request.h"

#include "base/setting_names.h"

namespace obscura {

std::vector<MovieFrame> frames_of(const RenderRequest& request) {
    if (!request.frames) return {{{}, request.load.time_s.value_or(0), request.outputs}};
    std::vector<MovieFrame> out;
    for (int number = request.frames->first; number <= request.frames->last; ++number) {
        MovieFrame frame{number, request.frames->time_s(number), {}};
        for (const std::filesystem::path& pattern : request.outputs)
            frame.outputs.push_back(frame_file(pattern, number).value_or(pattern));
        out.push_back(std::move(frame));
    }
    return out;
}

std::vector<std::filesystem::path> image_files(const RenderRequest& request,
                                               const MovieFrame& frame) {
    std::vector<std::filesystem::path> files = frame.outputs;
    if (request.exr.layout != ExrLayout::separate) return files;
    for (const std::filesystem::path& output : frame.outputs) {
        if (output_format_of(output) != OutputFormat::exr) continue;
        for (const Layer& layer : request.options.layers)
            files.push_back(layer_file(output, layer.name));
    }
    return files;
}

Result<void> check_crop(const RenderOptions& options) {
    const PixelRect crop = options.crop.value_or(PixelRect{});
    if (crop.x + crop.width <= options.width && crop.y + crop.height <= options.height) return {};
    return fail(ExitCode::usage,
                "E-USAGE-CONFLICT",
                setting("crop"),
                "the part reaches beyond the picture; expected one within " +
                    std::to_string(options.width) + "x" + std::to_string(options.height));
}

}  // namespace obscura
