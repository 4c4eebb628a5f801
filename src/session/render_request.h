// session/render_request.h - everything that an image or a sequence is asked for, checked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "gltf/load.h"
#include "image/display.h"
#include "image/write.h"
#include "render/points_lines_sizes.h"
#include "render/render.h"
#include "session/camera_choice.h"
#include "session/frames.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace obscura {

struct RenderRequest {
    std::filesystem::path scene;
    std::vector<std::filesystem::path> outputs;
    std::optional<OutputFormat> standard_output;  ///< -o -: the image goes there, too
    gltf::LoadOptions load;  ///< --scene, --variant, --animation, --time, --lenient, --occlusion
    std::optional<FrameRange> frames;         ///< then the outputs are patterns; see frame_file
    std::optional<int> frame;                 ///< of them, the one that is rendered
    std::optional<ShutterFractions> shutter;  ///< --shutter OPEN,CLOSE
    double fps = 24;
    CameraRequest camera;
    std::optional<std::filesystem::path> camera_json;
    PointsLinesSizes points_lines;  ///< --point-size, --line-width
    bool size_is_given = false;     ///< else --camera-json may have one
    RenderOptions options;
    std::optional<std::filesystem::path> environment;
    double environment_intensity = 1;
    double environment_rotation_deg = 0;
    int threads = 0;  ///< 0: every core
    Isa isa = Isa::automatic;
    DisplayOptions display;
    DisplayEncoding encoding;  ///< --bits, --quality, --no-dither, --page; without its transform
    ExrOptions exr;            ///< --float, --compression, --exr-layout and the like
    int crypto_levels = 6;     ///< of Cryptomatte layers in options.layers
    /// Where their manifest is written; none: in the headers.
    std::optional<std::filesystem::path> crypto_manifest;
    std::optional<std::filesystem::path> statistics;
    Verbosity verbosity = Verbosity::normal;
    bool check = false;  ///< --check: nothing is built, rendered or written
};

/// The images of a request: one, or one for each frame.
std::vector<MovieFrame> frames_of(const RenderRequest& request);

/// All files that an image of a request is written to: its outputs, and layers in files of their
/// own.
std::vector<std::filesystem::path> image_files(const RenderRequest& request,
                                               const MovieFrame& frame);

/// 64 E-USAGE-CONFLICT when the part to render reaches beyond the image.
Result<void> check_crop(const RenderOptions& options);

}  // namespace obscura
