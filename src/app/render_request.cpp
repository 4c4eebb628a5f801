// app/render_request.cpp - from the texts of the command line to a checked request.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_request.h"

#include "app/lens_request.h"
#include "app/numbers.h"
#include "app/option_steps.h"
#include "app/scene_choice.h"
#include "camera/names.h"
#include "render/integrators.h"

#include <algorithm>
#include <array>
#include <system_error>

namespace obscura {

namespace {

using Text = OptionText;
using Steps = OptionSteps;

constexpr double degree = 3.14159265358979323846 / 180.0;

tl::unexpected<Error> usage(const char* id, const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, id, where, message);
}

template <typename T>
struct Choice {
    const char* name;
    T value;
};

constexpr std::array<Choice<PixelFilter>, 3> filters = {
    {{"box", PixelFilter::box},
     {"gaussian", PixelFilter::gaussian},
     {"blackman-harris", PixelFilter::blackman_harris}}};
constexpr std::array<Choice<bool>, 2> occlusions = {{{"off", false}, {"ambient", true}}};
constexpr std::array<Choice<Isa>, 4> instruction_sets = {{{"auto", Isa::automatic},
                                                          {"baseline", Isa::baseline},
                                                          {"avx2", Isa::avx2},
                                                          {"avx512", Isa::avx512}}};

void parse_picture(const RenderArguments& arguments, RenderOptions& options, Steps& steps) {
    const auto integer = [](const char* name, int64_t low, int64_t high) {
        return [=](const std::string& text) { return parse_integer(text, name, low, high); };
    };
    const auto into = [](int& target) {
        return [&target](int64_t number) { target = static_cast<int>(number); };
    };
    steps.option(
        arguments.size,
        [](const std::string& text) { return parse_size(text, "--size"); },
        [&](const std::array<int, 2>& size) {
            options.width = size[0];
            options.height = size[1];
        });
    steps.option(
        arguments.spp, integer("--spp", 1, int64_t{1} << 20), into(options.samples_per_pixel));
    steps.option(arguments.depth, integer("--depth", 0, 1000), into(options.max_bounces));
    steps.option(arguments.tile_size, integer("--tile-size", 1, 256), into(options.tile_size));
    steps.option(
        arguments.seed,
        [](const std::string& text) { return parse_unsigned(text, "--seed"); },
        [&](uint64_t seed) { options.seed = seed; });
    steps.option(
        arguments.crop,
        [](const std::string& text) { return parse_rectangle(text, "--crop"); },
        [&](const std::array<int, 4>& r) {
            options.crop = PixelRect{r[0], r[1], r[2], r[3]};
        });
    // Without --size, --camera-json may say how large the picture is; then it is checked later.
    const bool size_is_known = arguments.size || !arguments.lens.camera_json;
    const Result<void> fits = check_crop(options);
    steps.refuse(size_is_known && !fits, "--crop", fits ? "" : fits.error().message);
}

Result<RenderOptions> parse_background(const std::string& text, RenderOptions options) {
    if (text == "env") {
        options.background = BackgroundKind::environment;
    } else if (text == "transparent") {
        options.background = BackgroundKind::transparent;
    } else {
        const Result<std::array<float, 3>> color = parse_color(text, "--background");
        if (!color) return fail(color.error());
        options.background = BackgroundKind::color;
        std::copy(color->begin(), color->end(), options.background_color);
    }
    return options;
}

void parse_transport(const RenderArguments& arguments, RenderOptions& options, Steps& steps) {
    steps.option(
        arguments.integrator,
        [](const std::string& text) {
            return choose_option(text, "--integrator", integrator_rows);
        },
        [&](Integrator integrator) { options.integrator = integrator; });
    steps.option(
        arguments.filter,
        [](const std::string& text) { return choose_option(text, "--filter", filters); },
        [&](PixelFilter filter) { options.filter = filter; });
    steps.option(
        arguments.background,
        [&](const std::string& text) { return parse_background(text, options); },
        [&](const RenderOptions& changed) { options = changed; });
    steps.option(
        arguments.ao_distance,
        [](const std::string& text) { return parse_real(text, "--ao-distance", 1e-9, 1e12); },
        [&](double distance) { options.ao_distance_m = distance; });
    steps.option(
        arguments.wire_width,
        [](const std::string& text) { return parse_real(text, "--wire-width", 0.01, 1000); },
        [&](double width) { options.wire_width_px = width; });
    steps.refuse(arguments.wire_width && options.integrator != Integrator::wireframe,
                 "--wire-width",
                 "it is for --integrator wireframe; leave it out or add that");
    steps.refuse(arguments.ao_distance && options.integrator != Integrator::ao,
                 "--ao-distance",
                 "it is for --integrator ao; leave it out or add that");
}

void parse_strokes(const RenderArguments& arguments, StrokeSizes& strokes, Steps& steps) {
    const auto length = [](const char* name) {
        return [=](const std::string& text) { return parse_length(text, name); };
    };
    const auto into = [](StrokeSize& size) {
        return [&size](const ParsedLength& parsed) {
            size = {parsed.value, parsed.pixels ? LengthUnit::pixels : LengthUnit::metres};
        };
    };
    steps.option(arguments.point_size, length("--point-size"), into(strokes.points));
    steps.option(arguments.line_width, length("--line-width"), into(strokes.lines));
}

void parse_camera(const RenderArguments& arguments, CameraRequest& camera, Steps& steps) {
    const auto point = [](const char* name) {
        return [=](const std::string& text) { return parse_point(text, name); };
    };
    const auto into = [](std::optional<Vec3d>& target) {
        return [&target](const Vec3d& value) { target = value; };
    };
    camera.choice = arguments.camera.value_or("");
    steps.option(arguments.eye, point("--eye"), into(camera.eye_m));
    steps.option(arguments.target, point("--target"), into(camera.target_m));
    steps.option(arguments.up, point("--up"), into(camera.up));
    steps.option(
        arguments.camera_model,
        [](const std::string& text) {
            return choose_option(text, "--camera-model", camera_model_names);
        },
        [&](CameraModel model) { camera.model = model; });
    steps.take(parse_lens(arguments.lens, camera.model),
               [&](const CameraSettings& settings) { camera.settings = settings; });
    const bool fisheye =
        camera.model.value_or(implied_model(camera.settings).value_or(CameraModel::pinhole)) ==
        CameraModel::fisheye;
    steps.option(
        arguments.fov,
        [&](const std::string& text) {
            return parse_real(text, "--fov", 0.01, fisheye ? 360 : 179);
        },
        [&](double degrees) { camera.yfov_rad = degrees * degree; });
    steps.option(
        arguments.lens.focus_on,
        [](const std::string& text) { return parse_pixel(text, "--focus-on"); },
        [&](const std::array<int, 2>& pixel) { camera.focus_on_px = pixel; });
    steps.refuse(arguments.lens.camera_json &&
                     (arguments.camera || arguments.eye || arguments.target || arguments.up),
                 "--camera-json",
                 "it places the camera; it cannot go together with --camera, --eye, --target or "
                 "--up");
    steps.refuse(arguments.camera && (arguments.eye || arguments.target || arguments.up),
                 "--camera",
                 "it cannot go together with --eye, --target or --up; give one or the other");
}

void parse_light_and_display(const RenderArguments& arguments,
                             RenderRequest& request,
                             Steps& steps) {
    if (arguments.env) request.environment = *arguments.env;
    steps.option(
        arguments.env_intensity,
        [](const std::string& text) { return parse_real(text, "--env-intensity", 0, 1e9); },
        [&](double intensity) { request.environment_intensity = intensity; });
    steps.option(
        arguments.env_rotation,
        [](const std::string& text) { return parse_real(text, "--env-rotation", -36000, 36000); },
        [&](double degrees) { request.environment_rotation_deg = degrees; });
    steps.option(
        arguments.exposure,
        [](const std::string& text) { return parse_real(text, "--exposure", -50, 50); },
        [&](double ev) { request.display.exposure_ev = ev; });
    request.display.ocio_file = arguments.ocio.value_or("");
    request.display.display = arguments.display.value_or("");
    request.display.view = arguments.view.value_or("");
}

void parse_time(const RenderArguments& arguments, RenderRequest& request, Steps& steps) {
    request.load.animation = arguments.animation;
    steps.option(
        arguments.time,
        [](const std::string& text) { return parse_real(text, "--time", -1e6, 1e6); },
        [&](double seconds) { request.load.time_s = seconds; });
    steps.option(
        arguments.frames,
        [](const std::string& text) { return parse_frames(text, "--frames"); },
        [&](const FrameRange& frames) { request.frames = frames; });
    steps.refuse(arguments.frames && arguments.time,
                 "--frames",
                 "it cannot go together with --time; give one or the other");
    const Text& shutter = arguments.lens.shutter;
    if (shutter && is_shutter_interval(*shutter)) {
        steps.option(shutter, parse_shutter_interval, [&](const ShutterFractions& fractions) {
            request.shutter = fractions;
        });
    }
    steps.refuse(arguments.fps && !arguments.frames && !request.shutter,
                 "--fps",
                 "it is for --frames and --shutter OPEN,CLOSE; leave it out or add one of them");
    steps.option(
        arguments.fps,
        [](const std::string& text) { return parse_real(text, "--fps", 1e-3, 1e5); },
        [&](double fps) {
            request.fps = fps;
            if (request.frames) request.frames->fps = fps;
        });
    for (const std::filesystem::path& output : request.outputs) {
        steps.refuse(request.frames && !frame_file(output, 0),
                     output.string(),
                     "with --frames a file's name must say where the frame's number goes; expected "
                     "one run of #, such as shot.####.exr");
    }
}

void parse_program(const RenderArguments& arguments, RenderRequest& request, Steps& steps) {
    steps.option(
        arguments.threads,
        [](const std::string& text) { return parse_integer(text, "--threads", 0, 1024); },
        [&](int64_t threads) { request.threads = static_cast<int>(threads); });
    steps.option(arguments.isa, parse_isa, [&](Isa isa) { request.isa = isa; });
    steps.refuse(arguments.quiet && arguments.verbose,
                 "--quiet",
                 "it cannot go together with --verbose; give one or the other");
    request.verbosity = verbosity_of(arguments);
    steps.refuse(arguments.strict && arguments.lenient,
                 "--strict",
                 "it cannot go together with --lenient; give one or the other");
    request.load.lenient = arguments.lenient;
    request.check = arguments.check;
}

/// Names of things and files; an empty one is most likely an unset variable of a script.
void refuse_empty_names(const RenderArguments& arguments, Steps& steps) {
    const std::array<std::pair<const char*, const Text*>, 9> names = {
        {{"--animation", &arguments.animation},
         {"--camera", &arguments.camera},
         {"--camera-json", &arguments.lens.camera_json},
         {"--aperture", &arguments.lens.aperture},
         {"--env", &arguments.env},
         {"--view", &arguments.view},
         {"--display", &arguments.display},
         {"--ocio", &arguments.ocio},
         {"--stats", &arguments.stats}}};
    const std::string message = "the name is empty; give one or leave out the option";
    for (const auto& [name, text] : names) {
        steps.refuse(*text && (*text)->empty(), name, message);
    }
    for (const std::string& output : arguments.outputs) {
        steps.refuse(output.empty(), "--output", message);
    }
    steps.refuse(arguments.scene_file.empty(), "SCENE", "the name is empty; expected a glTF file");
}

/// No output may replace something that is read, nor another output.
Result<void> check_distinct_files(const RenderRequest& request) {
    std::vector<std::filesystem::path> written;
    for (const MovieFrame& frame : frames_of(request))
        written.insert(written.end(), frame.outputs.begin(), frame.outputs.end());
    if (request.statistics) written.push_back(*request.statistics);
    std::vector<std::filesystem::path> read = {request.scene};
    if (request.camera_json) read.push_back(*request.camera_json);
    if (request.camera.settings.aperture_file)
        read.push_back(*request.camera.settings.aperture_file);
    if (request.environment) read.push_back(*request.environment);
    if (!request.display.ocio_file.empty()) read.push_back(request.display.ocio_file);
    for (size_t i = 0; i < written.size(); ++i) {
        const auto clashes = [&](const auto& other) { return same_file(written[i], other); };
        if (std::any_of(read.begin(), read.end(), clashes)) {
            return usage("E-USAGE-SAMEFILE",
                         written[i].string(),
                         "this output would replace a file that is read; give another name");
        }
        if (std::any_of(written.begin(), written.begin() + static_cast<long>(i), clashes)) {
            return usage("E-USAGE-SAMEFILE",
                         written[i].string(),
                         "two outputs are the same file; give different names");
        }
    }
    return {};
}

}  // namespace

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

Result<void> check_crop(const RenderOptions& options) {
    const PixelRect crop = options.crop.value_or(PixelRect{});
    if (crop.x + crop.width <= options.width && crop.y + crop.height <= options.height) return {};
    return usage("E-USAGE-CONFLICT",
                 "--crop",
                 "the part reaches beyond the picture; expected one within " +
                     std::to_string(options.width) + "x" + std::to_string(options.height));
}

Result<Isa> parse_isa(const std::string& text) {
    return choose_option(text, "--isa", instruction_sets);
}

Verbosity verbosity_of(const RenderArguments& arguments) {
    return arguments.quiet     ? Verbosity::quiet
           : arguments.verbose ? Verbosity::verbose
                               : Verbosity::normal;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error) && !error) return true;
    const auto resolved = [&](const std::filesystem::path& file) {
        return std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    };
    const std::filesystem::path resolved_a = resolved(a);
    return !error && resolved_a == resolved(b) && !error;
}

Result<RenderRequest> make_render_request(const RenderArguments& arguments) {
    RenderRequest request;
    Steps steps;
    request.scene = arguments.scene_file;
    refuse_empty_names(arguments, steps);
    request.outputs.assign(arguments.outputs.begin(), arguments.outputs.end());
    if (request.outputs.empty() && arguments.writes_pictures && !arguments.check) {
        const char* ending = arguments.frames ? ".####.exr" : ".exr";
        request.outputs.push_back(request.scene.stem().concat(ending));
    }
    steps.take(choose_scene(arguments.scene, arguments.variant),
               [&](const LoadOptions& load) { request.load = load; });
    request.exr_depth = arguments.float32 ? ExrDepth::float32 : ExrDepth::half;
    if (arguments.stats) request.statistics = *arguments.stats;
    if (arguments.lens.camera_json) request.camera_json = *arguments.lens.camera_json;
    request.size_is_given = arguments.size.has_value();
    parse_picture(arguments, request.options, steps);
    parse_transport(arguments, request.options, steps);
    steps.option(
        arguments.occlusion,
        [](const std::string& text) { return choose_option(text, "--occlusion", occlusions); },
        [&](bool applied) { request.load.occlusion = applied; });
    request.load.keeps_uv = request.options.integrator == Integrator::uv;
    parse_strokes(arguments, request.strokes, steps);
    parse_camera(arguments, request.camera, steps);
    parse_light_and_display(arguments, request, steps);
    parse_program(arguments, request, steps);
    parse_time(arguments, request, steps);
    const Result<void> parsed = steps.done();
    if (!parsed) return fail(parsed.error());
    const Result<void> distinct = check_distinct_files(request);
    if (!distinct) return fail(distinct.error());
    return request;
}

}  // namespace obscura
