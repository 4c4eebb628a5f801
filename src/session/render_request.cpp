// session/render_request.cpp - lists the images of a request and checks the part to render.
// SPDX-License-Identifier: Apache-2.0
#include "session/render_request.h"

#include "base/setting_names.h"
#include "film/layers.h"
#include "render/integrators.h"
#include "session/image_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace obscura {

bool shows_early(const RenderRequest& request) {
    const LongRun& run = request.long_run;
    return run.time_limit_s || run.snapshot_interval_s || request.display_server;
}

bool is_followed(const RenderRequest& request) {
    return request.long_run.has_checkpoint || shows_early(request) || is_part_of_samples(request);
}

bool takes_passes(const RenderRequest& request) {
    const bool adds_parts = request.part_by == PartBy::samples;
    return (is_followed(request) || adds_parts) && !is_aov(request.options.integrator);
}

std::vector<OutputFormat> formats_of(const RenderRequest& request) {
    std::vector<OutputFormat> out;
    for (const std::filesystem::path& file : request.outputs) {
        if (const auto format = output_format_of(file)) out.push_back(*format);
    }
    if (request.standard_output) out.push_back(*request.standard_output);
    return out;
}

std::vector<std::filesystem::path> image_files(const RenderRequest& request,
                                               const ListedImage& image) {
    std::vector<std::filesystem::path> files = image.outputs;
    if (request.exr.layout != ExrLayout::separate) return files;
    for (const std::filesystem::path& output : image.outputs) {
        if (output_format_of(output) != OutputFormat::exr) continue;
        for (const Layer& layer : request.options.layers)
            files.push_back(layer_file(output, layer.name));
    }
    return files;
}

std::optional<PixelRect> rendered_part(const RenderRequest& request) {
    const RenderOptions& options = request.options;
    if (!request.overscan) return options.crop;
    const Overscan& overscan = *request.overscan;
    const auto pixels = [&](int side) {
        const double amount = overscan.is_fraction ? overscan.amount * side : overscan.amount;
        return static_cast<int>(std::ceil(amount));
    };
    const int x = pixels(options.width);
    const int y = pixels(options.height);
    return PixelRect{-x, -y, options.width + 2 * x, options.height + 2 * y};
}

Result<void> use_color_space(RenderRequest& request, Log& log) {
    if (request.color_space.empty()) return {};
    Result<RenderingSpace> space =
        find_rendering_space(request.color_space, request.display.ocio_file, log);
    if (!space) return fail(space.error());
    request.space = std::move(*space);
    if (!request.space.from_rec709) return {};
    const Matrix3& matrix = *request.space.from_rec709;
    request.load.from_rec709 = matrix;
    request.display.rec709_from_scene = inverse(matrix);
    convert_colors(matrix, request.options.background_color);
    return {};
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

Result<void> check_adaptive(const RenderOptions& options) {
    if (!options.adaptive) return {};
    const IntegratorEntry& integrator = entry_of(options.integrator);
    if (!takes_samples(integrator.value)) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    setting("noise-target"),
                    setting("integrator") + " " + integrator.name +
                        " has no noise to lower; use path, direct or ao");
    }
    if (options.samples_per_pixel < 2) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    setting("noise-target"),
                    "it compares two halves of a pixel's samples; " + setting("spp") +
                        " must be 2 or more");
    }
    if (options.adaptive->min_samples <= options.samples_per_pixel) return {};
    return fail(ExitCode::usage,
                "E-USAGE-CONFLICT",
                setting("spp-min"),
                std::to_string(options.adaptive->min_samples) +
                    " is more than the most samples of a pixel, which are " +
                    std::to_string(options.samples_per_pixel) + "; lower it or raise those");
}

Result<void> choose_layers(std::span<const std::string> names, RenderRequest& request) {
    Result<std::vector<Layer>> layers = layers_of(names, request.crypto_levels);
    if (!layers) return fail(layers.error());
    request.options.layers = std::move(*layers);
    return check_layers(request, setting("aov"));
}

Result<void> check_layers(const RenderRequest& request, const std::string& asked_by) {
    const RenderOptions& options = request.options;
    const auto conflict = [&](const std::string& message) {
        return fail(ExitCode::usage, "E-USAGE-CONFLICT", asked_by, message);
    };
    if (options.layers.empty() && options.light_groups.empty()) return {};
    const IntegratorEntry& integrator = entry_of(options.integrator);
    const std::string chosen = setting("integrator") + " " + integrator.name;
    if (!has_layers(integrator.value)) {
        return conflict("layers stand beside light; " + chosen +
                        " computes none. Use path, direct, raycast or ao");
    }
    const bool has_light = has_light_layers(options.layers) || !options.light_groups.empty();
    if (has_light && integrator.kind != WavefrontKind::path) {
        return conflict("shares of the light come from paths; " + chosen +
                        " follows none. Use path or direct");
    }
    return {};
}

bool has_layer(const RenderOptions& options, Aov wanted) {
    return std::any_of(options.layers.begin(), options.layers.end(), [&](const Layer& one) {
        const Aov* aov = std::get_if<Aov>(&one.source);
        return aov != nullptr && *aov == wanted;
    });
}

bool wants_uv(const RenderOptions& options) {
    return has_layer(options, Aov::uv) || options.integrator == Integrator::uv;
}

}  // namespace obscura
