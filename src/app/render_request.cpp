// app/render_request.cpp - turns the option texts of `obscura render` into a request.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_request.h"

#include "app/delivery_options.h"
#include "app/distinct_files.h"
#include "app/frames.h"
#include "app/lens_request.h"
#include "app/list_options.h"
#include "app/long_run_options.h"
#include "app/memory_option.h"
#include "app/numbers.h"
#include "app/product_options.h"
#include "app/render_options.h"
#include "app/scene_choice.h"
#include "film/layers.h"
#include "math/warp.h"
#include "session/image_names.h"
#include "session/model_settings.h"
#include "session/requested_camera.h"
#include "session/segmentation.h"
#include "session/views_file.h"

#include <algorithm>
#include <variant>

namespace obscura::app {

namespace {

tl::unexpected<Error> usage(const char* id, const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, id, where, message);
}

/// --fov: its range depends on the camera model.
Result<void> read_fov(const OptionText& text, CameraRequest& camera) {
    if (!text) return {};
    const Result<double> degrees =
        parse_real(*text, "--fov", 0.01, max_fov_deg(camera.model, camera.settings));
    if (!degrees) return fail(degrees.error());
    camera.yfov_rad = *degrees * radians_per_degree;
    return {};
}

/// Checks the options of frames together.
Result<void> complete_time(const RenderArguments& arguments, RenderRequest& request) {
    const bool has_motion = has_layer(request.options, Aov::motion);
    if (arguments.fps && !request.frames && !request.shutter && !has_motion) {
        return conflict("--fps",
                        "it is for --frames, --shutter OPEN,CLOSE and --aov motion; leave it out "
                        "or add one of them");
    }
    if (has_motion) request.load.frame_step_s = 1 / request.fps;
    if (!request.frames) return {};
    if (request.standard_output) {
        return conflict("--output", "- takes one image; with --frames give files shot.####.png");
    }
    request.frames->fps = request.fps;
    std::vector<std::filesystem::path> patterns = request.outputs;
    if (request.segmentation) patterns.push_back(*request.segmentation);
    return check_frame_patterns(patterns);
}

std::filesystem::path output_of(const RenderArguments& arguments, const std::string& ending) {
    if (!arguments.asset.empty()) return arguments.asset + ending;
    return std::filesystem::path(arguments.scene_file).stem().concat(ending);
}

/// A picture in place of a scene, whose own name the output would have.
tl::unexpected<Error> no_scene(const std::filesystem::path& file) {
    return fail(ExitCode::bad_data,
                "E-GLB-FORMAT",
                file.string(),
                "by its name this is a picture, and no scene; accepted are .gltf and .glb files. "
                "`obscura denoise` takes EXRs");
}

Result<void> choose_outputs(const RenderArguments& arguments, RenderRequest& request) {
    for (const std::string& output : arguments.outputs) {
        if (output != "-") {
            request.outputs.emplace_back(output);
        } else if (request.standard_output) {
            return usage("E-USAGE-SAMEFILE", "--output", "- is given twice; give it once");
        } else {
            request.standard_output = OutputFormat::png;
        }
    }
    if (arguments.format && !request.standard_output) {
        return conflict("--format", "it is for -o -; other outputs' names tell their formats");
    }
    if (request.outputs.empty() && !request.standard_output && arguments.writes_images &&
        !arguments.check) {
        if (output_format_of(request.scene)) return no_scene(request.scene);
        const std::string ending = (arguments.frames ? ".####" : "") + arguments.default_ending;
        request.outputs.push_back(arguments.list.is_asked()
                                      ? std::filesystem::path(listed_output(arguments))
                                      : output_of(arguments, ending));
    }
    const bool unnamed = std::any_of(request.outputs.begin(),
                                     request.outputs.end(),
                                     [](const auto& output) { return output.empty(); });
    if (!unnamed) return {};
    return conflict("--output", "the name is empty; give one or leave out the option");
}

bool is_exr(const std::filesystem::path& file) {
    return output_format_of(file) == OutputFormat::exr;
}

/// Layers need an EXR, and those in files of their own one that has a name.
///
/// In      asked_by: an option that asks for layers, for messages
Result<void> check_layer_outputs(const RenderRequest& request, const char* asked_by) {
    const bool to_pipe = request.standard_output == OutputFormat::exr;
    const std::vector<std::filesystem::path>& files = request.outputs;
    const bool has_output = !files.empty() || request.standard_output;
    const bool has_exr = to_pipe || std::any_of(files.begin(), files.end(), is_exr);
    const bool has_layers =
        !request.options.layers.empty() || !request.options.light_groups.empty();
    if (has_layers && has_output && !has_exr) {
        return conflict(asked_by, "only EXRs hold layers; give an output that ends in .exr");
    }
    if (to_pipe && request.exr.layout == ExrLayout::separate) {
        return conflict("--exr-layout",
                        "with -o - there are no files beside the image's; use single or multipart");
    }
    return {};
}

/// --crypto-manifest: images name it as a file in their own folder, as the specification of
/// Cryptomatte wants.
Result<void> check_manifest(const RenderRequest& request) {
    if (!request.crypto_manifest) return {};
    const std::string option = "--crypto-manifest";
    const std::vector<Layer>& layers = request.options.layers;
    if (std::none_of(layers.begin(), layers.end(), is_cryptomatte)) {
        return conflict(option, "it is for Cryptomatte; add a layer such as --aov crypto_object");
    }
    if (request.standard_output == OutputFormat::exr) {
        return conflict(option, "what -o - writes is in no folder; leave out one of them");
    }
    if (request.crypto_manifest->filename().string().find('\\') != std::string::npos) {
        return conflict(option, "Cryptomatte has no names with \\; give another");
    }
    const auto folder = [](const std::filesystem::path& file) {
        return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    };
    for (const std::filesystem::path& output : request.outputs) {
        if (!is_exr(output) || same_file(folder(output), folder(*request.crypto_manifest)))
            continue;
        return conflict(option,
                        "it must lie in the folder of " + output.string() + ", which names it");
    }
    return {};
}

/// --page: the rest of the file is the page unless another background is asked for.
Result<void> complete_page(const RenderArguments& arguments, RenderRequest& request) {
    if (!request.encoding.page) return {};
    if (!arguments.background) request.options.background = BackgroundKind::transparent;
    if (request.options.background != BackgroundKind::color) return {};
    return conflict("--page",
                    "a --background of one colour hides it; give one or the other, or --background "
                    "transparent");
}

/// --noise-target and --spp auto: how many samples a pixel may have.
Result<void> complete_sampling(const RenderArguments& arguments, RenderOptions& options) {
    if (!options.adaptive) return {};
    int& least = options.adaptive->min_samples;
    if (arguments.spp.value_or("auto") == "auto") {
        options.samples_per_pixel = std::max(default_max_samples, least);
    } else if (!arguments.spp_min) {
        least = std::clamp(options.samples_per_pixel, 2, least);
    }
    return check_adaptive(options);
}

/// Values that depend on several options, which an entry of the table cannot express.
Result<void> complete(const RenderArguments& arguments, RenderRequest& request) {
    if (auto done = complete_lens(arguments.lens, request.camera.model, request.camera.settings);
        !done) {
        return done;
    }
    if (auto done = read_fov(arguments.fov, request.camera); !done) return done;
    if (auto done = complete_framing(arguments.product, arguments.camera, request.camera); !done) {
        return done;
    }
    if (auto fits = complete_sampling(arguments, request.options); !fits) return fits;
    if (auto fits = check_catchers(arguments.product, request); !fits) return fits;
    // Without --size, --camera-json may set the image size; it is checked later.
    const bool size_is_known = request.size_is_given || !request.camera_json;
    if (auto fits = check_crop(request.options); size_is_known && !fits) return fits;
    if (auto chosen = read_layers(arguments, request); !chosen) return chosen;
    if (auto fit = check_layer_outputs(request, layer_option_of(arguments)); !fit) return fit;
    if (auto fit = check_manifest(request); !fit) return fit;
    if (auto fit = check_segmentation_request(request); !fit) return fit;
    request.load.keeps_uv = wants_uv(request.options);
    request.verbosity = verbosity_of(arguments);
    if (auto done = complete_page(arguments, request); !done) return done;
    if (auto done = complete_time(arguments, request); !done) return done;
    if (auto done = complete_list(arguments, request); !done) return done;
    if (auto done = complete_texture_limit(request); !done) return done;
    if (auto done = complete_part(arguments.part, request); !done) return done;
    return complete_long_run(request);
}

}  // namespace

Result<void> read_named_files(RenderRequest& request, Log& log) {
    if (auto loaded = load_requested_camera(request, log); !loaded) return loaded;
    if (auto read = load_views(request, log); !read) return read;
    return use_color_space(request, log);
}

Verbosity verbosity_of(const RenderArguments& arguments) {
    return arguments.quiet     ? Verbosity::quiet
           : arguments.verbose ? Verbosity::verbose
                               : Verbosity::normal;
}

Result<RenderRequest> make_render_request(const RenderArguments& arguments) {
    RenderRequest request;
    request.scene = arguments.scene_file;
    if (request.scene.empty()) {
        return conflict("SCENE", "the name is empty; expected a glTF file");
    }
    if (auto chosen = choose_outputs(arguments, request); !chosen) return fail(chosen.error());
    Result<gltf::LoadOptions> load = choose_scene(arguments.scene, arguments.variant);
    if (!load) return fail(load.error());
    request.load = std::move(*load);
    RenderArguments texts = arguments;
    const std::span table(render_option_groups());
    if (auto read = read_options(table, texts, request); !read) return fail(read.error());
    if (auto fit = check_combinations(bind_all(table, texts)); !fit) return fail(fit.error());
    if (auto done = complete(arguments, request); !done) return fail(done.error());
    // Where the images are not known yet, the command's other files are.
    const bool is_known = !request.lists.needs_asset() && !request.lists.views_file;
    const Result<ImageList> list =
        is_known ? list_images(request, {}) : Result<ImageList>(ImageList{});
    if (!list) return fail(list.error());
    auto distinct = check_distinct_files(request, list->images);
    if (!distinct) return fail(distinct.error());
    return request;
}

}  // namespace obscura::app
