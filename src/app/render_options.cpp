// app/render_options.cpp - the table of the options of `obscura render`, shared with others.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_options.h"

#include "app/compression.h"
#include "app/delivery_options.h"
#include "app/display_connection.h"
#include "app/layer_options.h"
#include "app/lens_options.h"
#include "app/list_options.h"
#include "app/long_run_options.h"
#include "app/memory_option.h"
#include "app/noise_options.h"
#include "app/option_readers.h"
#include "app/part_options.h"
#include "app/product_options.h"
#include "app/render_command.h"
#include "app/time_options.h"
#include "camera/names.h"
#include "render/integrators.h"
#include "session/built_in_environment.h"

#include <cstring>
#include <fmt/format.h>

namespace obscura::app {

namespace {

using A = RenderArguments;
using C = CameraRequest;
using D = DisplayOptions;
using E = DisplayEncoding;
using L = gltf::LoadOptions;
using O = RenderOptions;
using X = ExrOptions;
using R = RenderRequest;
using Entry = RenderOptionEntry;

constexpr const char* notes = R"(
Examples:
  obscura render helmet.glb
      writes helmet.exr, framed by the file's first camera or as a whole
  obscura render helmet.glb --env sky.hdr --spp 256 -o helmet.exr -o helmet.png
      one rendering, two files: scene-linear data and a picture to look at
  obscura render part.glb --page white -o part.webp
  obscura render part.glb --page white -o - --format jpeg | lpr
      the part alone, on the page's own white
  obscura render room.gltf --camera Door --size 1920x1080 --exposure 1.5 -o room.jpg
  obscura render part.glb --eye 2,1,3 --target 0,0.5,0 --fov 30 --background transparent

  obscura render walk.glb --check
      says all that is wrong with the file and what belongs to it, in seconds
  obscura render walk.glb --frames 1-48 --fps 24 -o walk.####.exr
      48 files, walk.0001.exr to walk.0048.exr, from one reading of the asset
  obscura render shoe.glb --variants all --turntable 36 -o '{variant}/{frame:02}.webp'
      all variants from all sides, from one reading, too

Exit codes: 0 done, 33 out of memory, 64 usage, 65 bad scene data, 66 scene missing,
67 referenced file missing or corrupt, 69 unsupported, 70 internal error, 73 output
cannot be created, 74 I/O error, 75 stopped early: run it again, 76 too many non-finite
samples, 77 refused by a limit or a policy, 78 colour configuration, parts or checkpoint
that do not fit, 128+N stopped by signal N.
Names that begin with a dash: obscura render -o ./-out.exr -- -scene.glb)";

constexpr std::array<Choice<PixelFilter>, 3> filters = {
    {{"box", PixelFilter::box},
     {"gaussian", PixelFilter::gaussian},
     {"blackman-harris", PixelFilter::blackman_harris}}};
constexpr std::array<Choice<bool>, 2> occlusions = {{{"off", false}, {"ambient", true}}};
constexpr std::array<Choice<BackgroundKind>, 2> backgrounds = {
    {{"env", BackgroundKind::environment}, {"transparent", BackgroundKind::transparent}}};

constexpr std::array<Choice<bool>, 2> priorities = {{{"normal", false}, {"low", true}}};
constexpr std::array<Choice<int>, 2> bit_depths = {{{"8", 8}, {"16", 16}}};

std::vector<std::string> color_names() {
    return {"white", "black", "grey"};
}

std::vector<std::string> background_names() {
    std::vector<std::string> names = choice_names<backgrounds>();
    for (const std::string& color : color_names())
        names.push_back(color);
    return names;
}

constexpr OptionReader<R> page = {
    .read = read_parsed<parse_page, &R::encoding, &E::page>, .show = nullptr, .names = color_names};

constexpr OptionReader<R> size = {
    .read = [](const OptionInfo& info, const std::string& text, R& r) -> Result<void> {
        const Result<std::array<int, 2>> sides = parse_size(text, info.name);
        if (!sides) return fail(sides.error());
        r.options.width = (*sides)[0];
        r.options.height = (*sides)[1];
        r.size_is_given = true;
        return {};
    },
    .show =
        [](const OptionInfo& /*info*/, const R& r) {
            return size_text({r.options.width, r.options.height});
        }};

constexpr OptionReader<R> background = {
    .read = [](const OptionInfo& info, const std::string& text, R& r) -> Result<void> {
        for (const auto& kind : backgrounds) {
            if (text != kind.name) continue;
            r.options.background = kind.value;
            return {};
        }
        const Result<std::array<float, 3>> color = parse_color(text, info.name);
        if (!color) return fail(color.error());
        r.options.background = BackgroundKind::color;
        std::copy(color->begin(), color->end(), r.options.background_color);
        return {};
    },
    .show = show_choice<backgrounds, &R::options, &O::background>,
    .names = background_names};

Result<PixelRect> parse_crop(const std::string& text, const std::string& option) {
    const Result<std::array<int, 4>> r = parse_rectangle(text, option);
    if (!r) return fail(r.error());
    return PixelRect{(*r)[0], (*r)[1], (*r)[2], (*r)[3]};
}

Result<PointsLinesSize> parse_points_lines_size(const std::string& text,
                                                const std::string& option) {
    const Result<ParsedLength> length = parse_length(text, option);
    if (!length) return fail(length.error());
    return PointsLinesSize{length->value, length->pixels ? LengthUnit::pixels : LengthUnit::metres};
}

template <auto... path>
constexpr OptionReader<R> points_lines_size_at = {
    .read = read_parsed<parse_points_lines_size, path...>,
    .show = [](const OptionInfo& /*info*/, const R& r) {
        const PointsLinesSize& thickness = field<path...>(r);
        return shortest(thickness.diameter) + (thickness.unit == LengthUnit::pixels ? "px" : "m");
    }};

Result<bool> parse_off(const std::string& /*text*/, const std::string& /*option*/) {
    return false;
}

/// A file, or the name of an environment, whose angles are checked here.
Result<void> read_environment_choice(const OptionInfo& info, const std::string& text, R& request) {
    if (auto name = parse_name(text, info.name); !name) return fail(name.error());
    if (auto known = parse_built_in_environment(text); !known) return fail(known.error());
    request.environment = text;
    return {};
}

/// Degrees, or "camera" with degrees behind it: "camera", "camera+30", "camera-30".
Result<void> read_environment_rotation(const OptionInfo& info, const std::string& text, R& r) {
    constexpr std::string_view word = "camera";
    r.environment_follows_camera =
        text == word || text.starts_with("camera+") || text.starts_with("camera-");
    r.environment_rotation_deg = 0;
    if (text == word) return {};
    const size_t sign = text.starts_with("camera+") ? word.size() + 1 : word.size();
    const std::string degrees = r.environment_follows_camera ? text.substr(sign) : text;
    Result<void> read = read_number<&R::environment_rotation_deg>(info, degrees, r);
    if (!read) read.error().message += ", camera, or camera with a number and its sign behind it";
    return read;
}

/// A number, "auto", or "auto:" with a group's name behind it.
Result<void> read_exposure(const OptionInfo& info, const std::string& text, R& r) {
    const bool has_name = text.starts_with("auto:") && text.size() > 5;
    if (text == "auto" || has_name) r.exposure_group = has_name ? text.substr(5) : "";
    if (r.exposure_group) return {};
    Result<void> read = read_number<&R::display, &D::exposure_ev>(info, text, r);
    if (!read) read.error().message += ", auto, or auto: with a group's name behind it";
    return read;
}

constexpr OptionReader<R> exposure = {.read = read_exposure,
                                      .show = show_number<&R::display, &D::exposure_ev>};

constexpr OptionReader<R> environment_rotation = {
    .read = read_environment_rotation, .show = show_number<&R::environment_rotation_deg>};

Result<ExrDepth> parse_depth(const std::string& /*text*/, const std::string& /*option*/) {
    return ExrDepth::float32;
}

constexpr OptionReader<R> compression = {
    .read = [](const OptionInfo& info, const std::string& text, R& r) -> Result<void> {
        return parse_compression(text, long_name(info), r.exr);
    },
    .show = show_choice<compression_names, &R::exr, &X::compression>,
    .names = choice_names<compression_names>};

// clang-format off
constexpr Entry scene_file[] = {
    {{.name = "SCENE", .help = "glTF 2.0 file, .gltf or .glb", .files = "gltf glb"},
     text_at<&A::scene_file>},
    {{.name = "MORE_SCENES",
      .help = "Further ones, rendered after it; names of outputs then need {asset} "
              "(docs/many_images.md)",
      .files = "gltf glb"},
     text_at<&A::more_scenes>}};

constexpr Entry image[] = {
    {{.name = "-o,--output", .argument = "FILE",
      .help = "File to write: .exr scene-linear; .png, .jpg, .tif, .webp or .avif for a display; "
              "- is standard output. May be given several times",
      .fallback = "SCENE's name with .exr, here", .files = "exr png jpg jpeg tif tiff webp avif"},
     text_at<&A::outputs>},
    {{.name = "--format", .argument = "NAME", .help = "What -o - writes:", .fallback = "png"},
     text_at<&A::format>, choice_at<output_formats, &R::standard_output>},
    {{.name = "--size", .argument = "WxH", .help = "Width and height in pixels"},
     text_at<&A::size>, size},
    {{.name = "--crop", .argument = "X,Y,W,H",
      .help = "Render only this part, in pixels from the top left: the data window of an EXR; "
              "other formats are empty elsewhere"},
     text_at<&A::crop>, parsed_at<parse_crop, &R::options, &O::crop>},
    {{.name = "--float", .help = "Store EXR colours as 32-bit floats", .fallback = "16-bit half"},
     text_at<&A::float32>, parsed_at<parse_depth, &R::exr, &X::depth>},
    {{.name = "--compression", .argument = "NAME[:LEVEL]",
      .help = "Codec of EXRs; pxr24 and those after it are lossy, never to data and ids. dwaa and "
              "dwab may have a level, 45 unless told. One of:"},
     text_at<&A::compression>, compression},
    {{.name = "--exr-tiles", .argument = "N",
      .help = "Store EXRs in tiles of so many pixels a side",
      .range = {1, 4096}, .fallback = "lines"},
     text_at<&A::exr_tiles>, number_at<&R::exr, &X::tile_size>},
    {{.name = "--exr-mipmap",
      .help = "Store smaller copies, too, in tiles of 64 pixels a side unless told"},
     text_at<&A::exr_mipmap>, flag_at<&R::exr, &X::mipmap>},
    {{.name = "--background", .argument = "KIND|NAME|#RRGGBB|R,G,B",
      .help = "What rays that hit nothing see: env, transparent, or a colour of the scene: linear "
              "R,G,B, sRGB #RRGGBB, white, black or grey"},
     text_at<&A::background>, background},
    {{.name = "--filter", .argument = "NAME", .help = "Pixel filter:"},
     text_at<&A::filter>, choice_at<filters, &R::options, &O::filter>},
    {{.name = "--point-size", .argument = "LENGTH",
      .help = "Diameter of glTF's points: metres (0.01 or 0.01m) or pixels (3px)"},
     text_at<&A::point_size>, points_lines_size_at<&R::points_lines, &PointsLinesSizes::points>},
    {{.name = "--line-width", .argument = "LENGTH", .help = "Diameter of glTF's lines, likewise"},
     text_at<&A::line_width>, points_lines_size_at<&R::points_lines, &PointsLinesSizes::lines>}};

constexpr Entry sampling[] = {
    {{.name = "--spp", .argument = "N|auto",
      .help = "Samples per pixel; with --noise-target the most. auto: as many as that asks for",
      .range = {1, 1 << 20}},
     text_at<&A::spp>, samples_or_auto},
    {{.name = "--depth", .argument = "N", .help = "Most bounces of a path", .range = {0, 1000}},
     text_at<&A::depth>, number_at<&R::options, &O::max_bounces>},
    {{.name = "--seed", .argument = "N", .help = "Random numbers; equal seeds, equal pictures"},
     text_at<&A::seed>, number_at<&R::options, &O::seed>},
    {{.name = "--integrator", .argument = "NAME",
      .help = "path: full light transport; direct: no indirect light; raycast: one ray a pixel, "
              "hard shadows, no noise; ao: ambient occlusion; wireframe; or an AOV, one ray "
              "through each pixel's centre: normal, facing, depth, distance, uv, albedo, id, heat"},
     text_at<&A::integrator>, choice_at<integrator_entries, &R::options, &O::integrator>},
    {{.name = "--ao-distance", .argument = "METRES", .help = "How far ao looks",
      .range = {1e-9, 1e12}, .fallback = "a fifth of the scene's diagonal",
      .needs = {"--integrator ao"}},
     text_at<&A::ao_distance>, number_at<&R::options, &O::ao_distance_m>},
    {{.name = "--wire-width", .argument = "PIXELS", .help = "Lines of wireframe",
      .range = {0.01, 1000}, .needs = {"--integrator wireframe"}},
     text_at<&A::wire_width>, number_at<&R::options, &O::wire_width_px>}};

constexpr Entry camera[] = {
    {{.name = "--camera", .argument = "NAME|INDEX|auto",
      .help = "A camera of the file; auto frames the scene, whatever cameras there are",
      .fallback = "the first; without any, the whole scene is framed from the front, right and "
                  "above",
      .excludes = {"--eye", "--target", "--up"}},
     text_at<&A::camera>, name_at<&R::camera, &C::choice>},
    {{.name = "--eye", .argument = "X,Y,Z",
      .help = "Place the camera by hand, in metres, +Y up. What is not given of eye, target and up "
              "comes from the framing"},
     text_at<&A::eye>, parsed_at<parse_point, &R::camera, &C::eye_m>},
    {{.name = "--target", .argument = "X,Y,Z", .help = "Point that the camera looks at"},
     text_at<&A::target>, parsed_at<parse_point, &R::camera, &C::target_m>},
    {{.name = "--up", .argument = "X,Y,Z", .help = "Direction that is up in the picture",
      .fallback = "0,1,0"},
     text_at<&A::up>, parsed_at<parse_point, &R::camera, &C::up>},
    {{.name = "--fov", .argument = "DEG",  // its range depends on the model: read_fov()
      .help = "Vertical angle of view, 0.01 to 179; of a fisheye the whole circle's, up to 360",
      .fallback = "the camera's, or 35; 180"},
     text_at<&A::fov>},
    {{.name = "--camera-model", .argument = "NAME",
      .help = "orthographic shows what the angle shows at the target. One of:",
      .fallback = "the camera's, or what the options below mean, or pinhole"},
     text_at<&A::camera_model>, choice_at<camera_model_names, &R::camera, &C::model>}};

constexpr Entry light[] = {
    {{.name = "--env", .argument = "FILE|NAME",
      .help = "Latitude-longitude environment, .hdr or .exr, beside the file's lamps; or studio; "
              "neutral or white, the same from all sides; or sky:ELEVATION,AZIMUTH, a clear sky "
              "with its sun there, in degrees. A file of such a name is ./studio",
      .fallback = "the file's own, else a neutral studio if the scene has no light",
      .files = "hdr exr"},
     text_at<&A::env>, {.read = read_environment_choice}},
    {{.name = "--env-intensity", .argument = "X", .help = "Multiplies the environment",
      .range = {0, 1e9}},
     text_at<&A::env_intensity>, number_at<&R::environment_intensity>},
    {{.name = "--env-rotation", .argument = "DEG|camera",
      .help = "Turns it about +Y, counter-clockwise from above. camera turns it with the view: "
              "from every azimuth the light comes from where it does from the front; camera+30 "
              "adds to that",
      .range = {-36000, 36000}},
     text_at<&A::env_rotation>, environment_rotation},
    {{.name = "--occlusion", .argument = "KIND",
      .help = "What occlusion textures do: off, or ambient, as in viewers: they dim the "
              "environment's light, for assets whose crevices are in the texture alone"},
     text_at<&A::occlusion>, choice_at<occlusions, &R::load, &L::occlusion>}};

constexpr Entry display[] = {
    {{.name = "--exposure", .argument = "EV|auto[:GROUP]",
      .help = "Brighter by this many stops. auto, for scenes, meters the light on what is seen: "
              "one exposure for all of the command; of a job, for the pictures of a look or GROUP",
      .range = {-50, 50}},
     text_at<&A::exposure>, exposure},
    {{.name = "--view", .argument = "NAME",
      .help = "View of the OpenColorIO display. Built in: \"ACES 1.0 SDR\", \"Un-tone-mapped\", "
              "\"Khronos PBR Neutral\", Raw",
      .fallback = "ACES 1.0 SDR"},
     text_at<&A::view>, name_at<&R::display, &D::view>},
    {{.name = "--display", .argument = "NAME", .help = "OpenColorIO display", .fallback = "sRGB"},
     text_at<&A::display>, name_at<&R::display, &D::display>},
    {{.name = "--ocio", .argument = "FILE", .help = "OpenColorIO config",
      .fallback = "$OCIO, else built in", .files = "ocio"},
     text_at<&A::ocio>, name_at<&R::display, &D::ocio_file>},
    {{.name = "--page", .argument = "NAME|#RRGGBB|R,G,B",
      .help = "A colour behind the finished image, after the view: white, black, grey, #RRGGBB or "
              "R,G,B from 0 to 1. Without --background the image is transparent around the scene"},
     text_at<&A::page>, page},
    {{.name = "--bits", .argument = "N", .help = "Of a channel in PNG and TIFF:"},
     text_at<&A::bits>, choice_at<bit_depths, &R::encoding, &E::bits>},
    {{.name = "--quality", .argument = "N",
      .help = "Of JPEG, WebP and AVIF; at 100 a WebP loses nothing", .range = {1, 100},
      .fallback = "JPEG 95, others 90"},
     text_at<&A::quality>, number_at<&R::encoding, &E::quality>},
    {{.name = "--no-dither",
      .help = "Round 8-bit colours to the nearest code: smooth areas may show bands"},
     text_at<&A::no_dither>, parsed_at<parse_off, &R::encoding, &E::dither>}};

constexpr Entry faults[] = {
    {{.name = "--strict",
      .help = "Refuse what would silently change the picture, such as a texture that cannot be "
              "read; every problem is listed before anything is rendered. This is the default",
      .excludes = {"--lenient"}},
     text_at<&A::strict>},
    {{.name = "--lenient",
      .help = "Make do instead, with a warning each: magenta textures, skipped primitives, dropped "
              "triangles"},
     text_at<&A::lenient>, flag_at<&R::load, &L::lenient>},
    {{.name = "--check",
      .help = "Load and report only: nothing is rendered or written; the exit code is the one that "
              "rendering would begin with"},
     text_at<&A::check>, flag_at<&R::check>}};

constexpr Entry program[] = {
    {{.name = "--scene", .argument = "NAME|INDEX", .help = "Scene of a file that holds several",
      .fallback = "the file's default"},
     text_at<&A::scene>},
    {{.name = "--variant", .argument = "NAME",
      .help = "Look of a product, as `obscura info` lists them",
      .fallback = "the file's own materials"},
     text_at<&A::variant>},
    {{.name = "--threads", .argument = "N",
      .help = "Threads; 0 is every core that the process may use", .range = {0, 1024}},
     text_at<&A::threads>, number_at<&R::threads>},
    {{.name = "--priority", .argument = "NAME",
      .help = "low lets other programs go first: nice 10, and Linux's class for batch jobs. One "
              "of:"},
     text_at<&A::priority>, choice_at<priorities, &R::gives_way>},
    {{.name = "--max-memory", .argument = "SIZE",
      .help = "Memory that the process may take: 512M, 4G, a number of bytes, or a share of what "
              "there is: the least of the machine's, its container's and the shell's limit",
      .fallback = "80%"},
     text_at<&A::max_memory>, parsed_at<parse_memory_size, &R::max_memory>},
    {{.name = "--texture-memory", .argument = "SIZE",
      .help = "Memory for textures: when they take more, their texels lie in files of "
              "--texture-cache and come into memory where rays look at them. Same picture",
      .fallback = "all textures"},
     text_at<&A::texture_memory>, parsed_at<parse_memory_size, &R::texture_memory>},
    {{.name = "--texture-cache", .argument = "DIR",
      .help = "Folder of these files, made once for equal images",
      .fallback = "obscura/textures in $XDG_CACHE_HOME or ~/.cache", .files = "/",
      .needs = {"--texture-memory"}},
     text_at<&A::texture_cache>, name_at<&R::texture_cache>},
    {{.name = "--isa", .argument = "NAME", .help = "Instruction set:"},
     text_at<&A::isa>, choice_at<instruction_sets, &R::isa>},
    {{.name = "--tile-size", .argument = "N",
      .help = "Side of a tile in pixels, at least 32 for AOVs; does not change the picture",
      .range = {1, 256}},
     text_at<&A::tile_size>, number_at<&R::options, &O::tile_size>},
    {{.name = "--stats", .argument = "FILE.json",
      .help = "Write times, rays, memory and warnings as JSON", .files = "json"},
     text_at<&A::stats>, name_at<&R::statistics>},
    {{.name = "--display-server", .argument = "HOST[:PORT]",
      .help = "Show the picture in the viewer tev while it is rendered: pass after pass, and at "
              "last as files have it, before the view. Where no viewer answers, a warning says so. "
              "Only this option makes the program use the network",
      .fallback = "none; port 14158", .excludes = {"--check"}},
     text_at<&A::display_server>, parsed_at<parse_display_address, &R::display_server>},
    {{.name = "--write-retries", .argument = "N",
      .help = "Try so many times more to write an image that cannot be written, after 1, 2, 4 ... "
              "seconds. In the end a copy goes to $TMPDIR",
      .range = {0, 20}},
     text_at<&A::write_retries>, number_at<&R::write_retries>},
    {{.name = "--quiet", .help = "Print errors only", .excludes = {"--verbose"}},
     text_at<&A::quiet>},
    {{.name = "--verbose", .help = "Print more notes"},
     text_at<&A::verbose>}};
// clang-format on

}  // namespace

const std::vector<RenderOptionGroup>& render_option_groups() {
    static const std::vector<RenderOptionGroup> all = [] {
        std::vector<RenderOptionGroup> groups = {{"", scene_file},
                                                 {"Picture", image},
                                                 overscan_group(),
                                                 layer_group(),
                                                 denoising_group(),
                                                 segmentation_group(),
                                                 time_group(),
                                                 list_group(),
                                                 {"Sampling", sampling},
                                                 adaptive_group(),
                                                 fireflies_group(),
                                                 {"Camera", camera},
                                                 framing_group()};
        const auto lens = lens_option_groups();
        groups.insert(groups.end(), lens.begin(), lens.end());
        const std::initializer_list<RenderOptionGroup> rest = {{"Light", light},
                                                               light_choice_group(),
                                                               part_group(),
                                                               color_group(),
                                                               {"Display (all but EXR)", display},
                                                               {"Faulty scenes", faults},
                                                               part_of_work_group(),
                                                               long_run_group(),
                                                               {"Program", program}};
        groups.insert(groups.end(), rest);
        return groups;
    }();
    return all;
}

Command render_command(RenderArguments& arguments) {
    Command command{"render", "Render a scene to EXR, PNG, JPEG, TIFF, WebP or AVIF", notes};
    command.options = bind_all(std::span(render_option_groups()), arguments);
    command.run = [&arguments] { return run_render(arguments, nullptr); };
    return command;
}

void add_render_group(Command& command, RenderArguments& arguments, const char* heading) {
    for (const RenderOptionGroup& group : render_option_groups()) {
        if (std::strcmp(group.heading, heading) != 0) continue;
        for (const Entry& entry : group.entries)
            command.options.push_back(bind(entry, arguments, heading));
    }
}

void add_lens_groups(Command& command, RenderArguments& arguments) {
    for (const RenderOptionGroup& group : lens_option_groups())
        add_render_group(command, arguments, group.heading);
}

BoundOption& add_render_option(Command& command,
                               RenderArguments& arguments,
                               const char* name,
                               const char* heading) {
    for (const RenderOptionGroup& group : render_option_groups()) {
        for (const Entry& entry : group.entries) {
            if (std::strcmp(entry.info.name, name) != 0) continue;
            command.options.push_back(bind(entry, arguments, *heading ? heading : group.heading));
        }
    }
    return command.options.back();
}

}  // namespace obscura::app
