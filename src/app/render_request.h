// app/render_request.h - everything that `obscura render` was asked for, checked and ready to use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/camera_choice.h"
#include "app/frames.h"
#include "app/lens_options.h"
#include "base/log.h"
#include "gltf/load.h"
#include "image/display.h"
#include "image/write.h"
#include "render/render.h"
#include "render/stroke_sizes.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

struct RenderRequest {
    std::filesystem::path scene;
    std::vector<std::filesystem::path> outputs;  ///< at least one where pictures are written
    LoadOptions load;  ///< --scene, --variant, --animation, --time, --lenient, --occlusion
    std::optional<FrameRange> frames;         ///< then the outputs are patterns; see frame_file
    std::optional<ShutterFractions> shutter;  ///< --shutter OPEN,CLOSE
    double fps = 24;
    CameraRequest camera;
    std::optional<std::filesystem::path> camera_json;
    StrokeSizes strokes;         ///< --point-size, --line-width
    bool size_is_given = false;  ///< else --camera-json may have one
    RenderOptions options;
    std::optional<std::filesystem::path> environment;
    double environment_intensity = 1;
    double environment_rotation_deg = 0;
    int threads = 0;  ///< 0: every core
    Isa isa = Isa::automatic;
    DisplayOptions display;
    ExrDepth exr_depth = ExrDepth::half;
    std::optional<std::filesystem::path> statistics;
    Verbosity verbosity = Verbosity::normal;
    bool check = false;  ///< --check: nothing is built, rendered or written
};

/// The texts of the options as they stood on the command line; an empty optional was not given.
struct RenderArguments {
    std::string scene_file;
    std::vector<std::string> outputs;
    std::optional<std::string> size, spp, depth, seed, threads, isa, tile_size, crop;
    std::optional<std::string> scene, variant, camera, camera_model, eye, target, up, fov;
    LensArguments lens;
    std::optional<std::string> env, env_intensity, env_rotation, background, occlusion;
    std::optional<std::string> integrator, ao_distance, wire_width, filter;
    std::optional<std::string> point_size, line_width;
    std::optional<std::string> view, display, ocio, exposure, stats;
    std::optional<std::string> animation, time, frames, fps;
    bool float32 = false;
    bool writes_pictures = true;  ///< false: no output unless one is named
    bool quiet = false;
    bool verbose = false;
    bool strict = false;  ///< what is so without it, too
    bool lenient = false;
    bool check = false;
};

/// Reads the texts; touches no file but to find out whether two names mean the same one.
///
/// Errors  64, each with the option and what it accepts: E-USAGE-NUMBER, E-USAGE-RANGE,
///         E-USAGE-CHOICE, E-USAGE-CONFLICT, E-USAGE-SAMEFILE
Result<RenderRequest> make_render_request(const RenderArguments& arguments);

/// The pictures that a request asks for: one, or one for each frame.
std::vector<MovieFrame> frames_of(const RenderRequest& request);

/// 64 E-USAGE-CONFLICT when the part to render reaches beyond the picture.
Result<void> check_crop(const RenderOptions& options);

/// One name of --isa.
///
/// Errors  64 E-USAGE-CHOICE
Result<Isa> parse_isa(const std::string& text);

/// What --quiet and --verbose ask for.
Verbosity verbosity_of(const RenderArguments& arguments);

/// True when both names lead to one file, through links too, also when it does not exist yet.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace obscura
