// session/render_request.h - everything that an image or a sequence is asked for, checked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "base/memory_limit.h"
#include "gltf/load.h"
#include "image/display.h"
#include "image/rendering_space.h"
#include "image/write.h"
#include "render/points_lines_sizes.h"
#include "render/render.h"
#include "session/camera_choice.h"
#include "session/film_keeper.h"
#include "session/frames.h"
#include "session/image_list.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// What is rendered around the image, on every side.
struct Overscan {
    double amount = 0;
    bool is_fraction = false;  ///< of the image's width and height; else pixels
};

/// How work is divided into parts; automatic: a sequence by frames, a picture by tiles.
enum class PartBy { automatic, tiles, samples, frames };

/// Managers of render farms, by the lines that they read in a program's output.
enum class FarmManager { none, deadline, alfred, openjd };

/// What is asked for a rendering that takes long and may be cut short.
struct LongRun {
    bool has_checkpoint = false;
    std::filesystem::path checkpoint;  ///< empty: beside the output; see checkpoint_file
    double checkpoint_interval_s = 300;
    bool keep_checkpoint = false;  ///< when the image is written
    Resume resume = Resume::automatic;
    std::optional<double> time_limit_s, snapshot_interval_s;
    bool skips_existing = false;  ///< --skip-existing: what is there already is left as it is
};

/// Where a viewer listens.
struct DisplayAddress {
    std::string host;
    uint16_t port = 0;
};

struct RenderRequest {
    std::filesystem::path scene;
    std::vector<std::filesystem::path> outputs;
    std::optional<OutputFormat> standard_output;  ///< -o -: the image goes there, too
    gltf::LoadOptions load;  ///< --scene, --variant, --animation, --time, --lenient, --occlusion
    /// Then the outputs and `segmentation` are patterns; see frame_file.
    std::optional<FrameList> frames;
    bool animates_seed = false;               ///< --animate-seed: the frame's number is added to it
    ListRequest lists;                        ///< --views, --cameras, --variants, --turntable
    std::optional<int> frame;                 ///< of a sequence or turntable, the one rendered
    std::optional<ShutterFractions> shutter;  ///< --shutter OPEN,CLOSE
    double fps = 24;
    CameraRequest camera;
    std::optional<std::filesystem::path> camera_json;
    PointsLinesSizes points_lines;  ///< --point-size, --line-width
    bool size_is_given = false;     ///< else --camera-json may have one
    bool catcher_ground = false;  ///< --catcher ground: RenderOptions::catcher_ground_m by the pose
    RenderOptions options;
    std::optional<std::filesystem::path> environment;
    double environment_intensity = 1;
    double environment_rotation_deg = 0;
    bool environment_follows_camera = false;   ///< the rotation is added to the camera's azimuth
    int threads = 0;                           ///< 0: every core
    std::optional<MemorySize> max_memory;      ///< nothing: 80 % of what there is
    std::optional<MemorySize> texture_memory;  ///< --texture-memory; nothing: all that there are
    std::filesystem::path texture_cache;       ///< --texture-cache; "": the user's cache folder
    bool gives_way = false;                    ///< --priority low
    Isa isa = Isa::automatic;
    std::string color_space;  ///< --color-space; empty: lin_rec709
    RenderingSpace space;     ///< what it means: set by use_color_space
    DisplayOptions display;
    /// --exposure auto: the exposure is metered, one for all images of a group; "": of the look.
    std::optional<std::string> exposure_group;
    DisplayEncoding encoding;  ///< --bits, --quality, --no-dither, --page; without its transform
    ExrOptions exr;            ///< --float, --compression, --exr-layout and the like
    bool denoise = false;      ///< --denoise
    std::optional<Overscan> overscan;
    std::optional<std::filesystem::path> segmentation;  ///< --segmentation, a PNG
    int crypto_levels = 6;                              ///< of Cryptomatte layers in options.layers
    /// Where their manifest is written; none: in the headers.
    std::optional<std::filesystem::path> crypto_manifest;
    std::optional<std::filesystem::path> statistics;
    Verbosity verbosity = Verbosity::normal;
    FarmManager farm = FarmManager::none;  ///< --farm: for whom progress is told
    std::optional<FilmPart> part;          ///< --part: only this share is rendered
    PartBy part_by = PartBy::automatic;    ///< in a merge: how the parts were
    int write_retries = 0;                 ///< --write-retries: of an image's files
    LongRun long_run;
    std::optional<DisplayAddress> display_server;  ///< --display-server: who is shown the image
    bool check = false;  ///< --check: nothing is built, rendered or written
};

/// Whether something looks at the image before it is finished, or keeps what there is of it: also a
/// part of its samples, whose sums are its result.
bool is_followed(const RenderRequest& request);

/// The formats of the image's outputs.
std::vector<OutputFormat> formats_of(const RenderRequest& request);

/// Whether somebody may look at the image, or it may have to do, long before it is finished.
bool shows_early(const RenderRequest& request);

/// Whether the image is rendered in passes, whose sums are kept; see render/film_sums.h.
bool takes_passes(const RenderRequest& request);

/// All files that an image of a request is written to: its outputs, and layers in files of their
/// own.
std::vector<std::filesystem::path> image_files(const RenderRequest& request,
                                               const ListedImage& image);

/// The part of an image that is rendered: with overscan it reaches beyond the image, by whole
/// pixels. None: the image.
std::optional<PixelRect> rendered_part(const RenderRequest& request);

/// Finds the rendering space that is asked for, and makes the scene's colours, the background, the
/// environment and the display use it. To be called once, before anything is loaded.
///
/// Errors  78 E-OCIO-FILE, E-OCIO-SPACE
Result<void> use_color_space(RenderRequest& request, Log& log);

/// 64 E-USAGE-CONFLICT when the part to render reaches beyond the image.
Result<void> check_crop(const RenderOptions& options);

/// Whether adaptive sampling, if it is asked for, fits the rest.
///
/// Errors  64 E-USAGE-CONFLICT the integrator takes a fixed number of samples; the least number of
///         samples is more than the most
Result<void> check_adaptive(const RenderOptions& options);

/// Asks for layers, of as many Cryptomatte levels as the request says.
///
/// In      names: those of `--list-aovs`
/// Errors  64 E-USAGE-CONFLICT the integrator computes none; E-AOV-NAME
Result<void> choose_layers(std::span<const std::string> names, RenderRequest& request);

/// Whether the integrator computes the layers that are asked for.
///
/// In      asked_by: the setting that asks for them, for messages
/// Errors  64 E-USAGE-CONFLICT
Result<void> check_layers(const RenderRequest& request, const std::string& asked_by);

/// Whether the layer of an AOV is asked for.
bool has_layer(const RenderOptions& options, Aov wanted);

/// True when texture coordinates are wanted that no texture needs.
bool wants_uv(const RenderOptions& options);

}  // namespace obscura
