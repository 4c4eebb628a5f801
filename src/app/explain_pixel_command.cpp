// app/explain_pixel_command.cpp - the subcommand `obscura explain-pixel`: load, explain, print.
// SPDX-License-Identifier: Apache-2.0
#include "app/explain_pixel_command.h"

#include "app/explain_pixel_options.h"
#include "app/memory_option.h"
#include "app/numbers.h"
#include "app/outcome.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "explain/explain_pixel.h"
#include "gltf/load.h"
#include "session/focus.h"
#include "session/lighting.h"
#include "session/requested_camera.h"

#include <span>

namespace obscura::app {

namespace {

/// Reads X,Y, once the image's size is known.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE it is not in the image
Result<PixelPlace> parse_place(const std::string& text, const RenderOptions& options) {
    const Result<std::array<int, 2>> pixel = parse_pixel(text, "PIXEL");
    if (!pixel && pixel.error().id != "E-USAGE-RANGE") return fail(pixel.error());
    if (pixel && (*pixel)[0] < options.width && (*pixel)[1] < options.height) {
        return PixelPlace{(*pixel)[0], (*pixel)[1], options.width, options.height};
    }
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                "PIXEL",
                "the pixel is outside the picture of " + std::to_string(options.width) + "x" +
                    std::to_string(options.height) + "; expected X from 0 to " +
                    std::to_string(options.width - 1) + " and Y from 0 to " +
                    std::to_string(options.height - 1));
}

Result<void> check_drawing(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (ending == ".svg") return check_file_can_be_written(file);
    return fail(ExitCode::usage,
                "E-OUT-FORMAT",
                file.string(),
                "a pixel is drawn as SVG; expected a name that ends in .svg");
}

Result<ExplainRequest> make_request(const ExplainPixelArguments& arguments, Log& log) {
    ExplainRequest request;
    ExplainPixelArguments texts = arguments;
    const auto table = explain_pixel_option_groups();
    if (auto read = read_options(table, texts, request); !read) return fail(read.error());
    RenderArguments render = arguments.render;
    render.writes_images = false;
    if (arguments.output) render.outputs = {*arguments.output};  // must not overwrite inputs
    Result<RenderRequest> made = make_render_request(render);
    if (!made) return fail(made.error());
    request.render = std::move(*made);
    if (request.render.shutter) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    "--shutter",
                    "one ray is explained, at one time; leave it out, or give --time");
    }
    request.render.load.keeps_uv = true;
    if (auto loaded = load_requested_camera(request.render, log); !loaded) {
        return fail(loaded.error());
    }
    const Result<PixelPlace> pixel = parse_place(arguments.pixel, request.render.options);
    if (!pixel) return fail(pixel.error());
    request.pixel = *pixel;
    if (!arguments.output) return request;
    request.output = *arguments.output;
    if (auto sound = check_drawing(*request.output); !sound) return fail(sound.error());
    return request;
}

Result<PixelReport> explain(const ExplainRequest& request, Log& log) {
    const RenderRequest& render = request.render;
    Result<Scene> scene = gltf::load_gltf(render.scene, render.load, log);
    if (!scene) return fail(scene.error());
    Result<ChosenCamera> camera = choose_unfocused_camera(*scene, render, log);
    if (!camera) return fail(camera.error());
    if (has_points_lines(*scene)) size_points_lines(render.points_lines, camera->camera, *scene);
    Result<LightingOptions> lighting = load_lighting(render, log);
    if (!lighting) return fail(lighting.error());
    if (render.environment_follows_camera) {
        lighting->environment_rotation_deg += camera_azimuth_deg(camera->basis.world_from_camera);
    }
    const Result<PreparedScene> prepared =
        PreparedScene::create(std::move(*scene), *lighting, render.isa, log);
    if (!prepared) return fail(prepared.error());
    if (auto focused = focus(*prepared, render, log, *camera); !focused) {
        return fail(focused.error());
    }
    PixelTask task;
    task.scene = &*prepared;
    task.camera = camera->camera;
    task.options = render.options;
    task.pixel = request.pixel;
    task.file = render.scene.filename().string();
    task.camera_name = camera->description;
    task.max_objects = request.max_objects;
    task.draws = request.output.has_value();
    return explain_pixel(task);
}

Result<void> execute(const ExplainRequest& request, Log& log) {
    const ThreadLimit threads(request.render.threads);
    if (auto begun = start_threads_ahead(); !begun) return begun;
    const Result<PixelReport> report = explain(request, log);
    if (!report) return fail(report.error());
    const Result<void> printed =
        print_output(request.json ? pixel_json(*report) : pixel_text(*report));
    if (!printed || !request.output) return printed;
    return write_file_atomically(*request.output, std::as_bytes(std::span(report->drawing)));
}

}  // namespace

int run_explain_pixel(const ExplainPixelArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    const Result<ExplainRequest> request = make_request(arguments, log);
    if (!request) return report_failure(request.error(), log);
    const Result<void> done = execute(*request, log);
    if (!done) return report_failure(done.error(), log);
    return report_success(request->render.scene.string(), log);
}

}  // namespace obscura::app
