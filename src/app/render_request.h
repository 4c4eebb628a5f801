// app/render_request.h - the request of `obscura render`, checked and ready to use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/delivery_options.h"
#include "app/layer_options.h"
#include "app/lens_options.h"
#include "app/list_options.h"
#include "app/long_run_options.h"
#include "app/part_options.h"
#include "app/product_options.h"
#include "session/render_request.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line; an empty optional was not given.
struct RenderArguments {
    std::string scene_file;
    std::vector<std::string> more_scenes;  ///< rendered after it, with the same options
    std::string asset;                     ///< {asset} in names; empty: the scene's name
    std::string look = "default";          ///< {look} in names
    std::vector<std::string> outputs, aovs;
    std::optional<std::string> size, spp, noise_target, spp_min, depth, seed, threads, isa;
    std::optional<std::string> tile_size, crop;
    std::optional<std::string> scene, variant, camera, camera_model, eye, target, up, fov;
    LensArguments lens;
    ProductArguments product;
    LayerArguments layer;
    DeliveryArguments delivery;
    PartArguments part;
    LongRunArguments long_run;
    ListArguments list;
    std::optional<std::string> env, env_intensity, env_rotation, background, occlusion;
    std::optional<std::string> integrator, ao_distance, wire_width, filter, crypto_levels;
    std::optional<std::string> clamp_direct, clamp_indirect, caustics;
    std::optional<std::string> crypto_manifest, exr_layout, compression, exr_tiles;
    std::optional<std::string> priority, display_server;
    std::optional<std::string> point_size, line_width, max_memory;
    std::optional<std::string> texture_memory, texture_cache;
    std::optional<std::string> view, display, ocio, exposure, stats, write_retries;
    std::optional<std::string> format, bits, quality, page;
    bool no_dither = false;
    bool regularize = false;
    bool animate_seed = false;
    std::optional<std::string> animation, time, frames, fps;
    std::string default_ending = ".exr";  ///< of the output, where none is given
    bool float32 = false;
    bool exr_mipmap = false;
    bool writes_images = true;  ///< false: no output unless one is named
    bool quiet = false;
    bool verbose = false;
    bool strict = false;  ///< the default, too
    bool lenient = false;
    bool check = false;
    bool list_aovs = false;
};

/// Parses the texts; touches files only to find out whether two names mean the same one.
///
/// Errors  64, each with the option and what it accepts: E-USAGE-NUMBER, E-USAGE-RANGE,
///         E-USAGE-CHOICE, E-USAGE-CONFLICT, E-USAGE-SAMEFILE; those of read_layers
Result<RenderRequest> make_render_request(const RenderArguments& arguments);

/// Reads the files that a request names, except the scene and images: camera, views, colour space.
///
/// Errors  those of load_requested_camera, load_views and use_color_space
Result<void> read_named_files(RenderRequest& request, Log& log);

/// What --quiet and --verbose ask for.
Verbosity verbosity_of(const RenderArguments& arguments);

}  // namespace obscura::app
