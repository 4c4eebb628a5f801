// session/outputs.cpp - the files that a rendering leaves.
// SPDX-License-Identifier: Apache-2.0
#include "session/outputs.h"

#include "base/atomic_file.h"
#include "base/text.h"
#include "camera/exposure.h"
#include "camera/matrices.h"
#include "camera/names.h"
#include "render/integrators.h"

#include "session/camera_parameters.h"
#include "session/preview.h"
#include "session/statistics.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace obscura {

namespace {

bool is_exr(const std::filesystem::path& file) {
    return output_format_of(file) == OutputFormat::exr;
}

/// One file's content: the image itself, or what one can look at in its place.
Result<std::vector<std::byte>> encode_output(const OutputTarget& target,
                                             const RenderRequest& request,
                                             const FinishedImage& finished,
                                             const DisplayTransform* display) {
    const Integrator integrator = request.options.integrator;
    const ExrDepth depth = is_aov(integrator) ? ExrDepth::float32 : request.exr_depth;
    DisplayEncoding encoding = request.encoding;
    if (!needs_preview(integrator) || target.format == OutputFormat::exr) {
        encoding.transform = display;
        return encode_image(target, finished.image, finished.metadata, depth, encoding);
    }
    ImageMetadata metadata = finished.metadata;
    metadata.is_color = false;
    const OutputImage preview = preview_image(whole_image(finished.image), integrator);
    return encode_image(target, preview, metadata, depth, encoding);
}

}  // namespace

Result<void> check_outputs(const RenderRequest& request) {
    // All files of a sequence lie in one folder: those of the first frame stand for all.
    const MovieFrame first = frames_of(request).front();
    const RenderOptions& options = request.options;
    const auto fits = [&](const OutputTarget& target) {
        return check_encoding(target, request.encoding, options.width, options.height);
    };
    for (const std::filesystem::path& output : first.outputs) {
        const Result<OutputTarget> target = check_output(output);
        if (!target) return fail(target.error());
        if (auto done = fits(*target); !done) return done;
    }
    if (request.standard_output) {
        if (auto done = fits({*request.standard_output, standard_output_name}); !done) return done;
    }
    if (request.statistics) return check_file_can_be_written(*request.statistics);
    return {};
}

Result<std::optional<DisplayTransform>> make_display(const RenderRequest& request, Log& log) {
    const bool all_exr = std::all_of(request.outputs.begin(), request.outputs.end(), is_exr) &&
                         request.standard_output.value_or(OutputFormat::exr) == OutputFormat::exr;
    if (all_exr || needs_preview(request.options.integrator))
        return std::optional<DisplayTransform>();
    Result<DisplayTransform> display = DisplayTransform::create(request.display, log);
    if (!display) return fail(display.error());
    return std::optional<DisplayTransform>(std::move(*display));
}

Result<void> expose_display(const ChosenCamera& chosen,
                            const RenderRequest& request,
                            std::optional<DisplayTransform>& display,
                            Log& log) {
    if (!chosen.ev100 || !display) return {};
    DisplayOptions options = request.display;
    options.exposure_ev += std::log2(exposure_scale(*chosen.ev100));
    Result<DisplayTransform> exposed = DisplayTransform::create(options, log);
    if (!exposed) return fail(exposed.error());
    display = std::move(*exposed);
    return {};
}

ImageMetadata make_metadata(const RenderRequest& request,
                            const PreparedScene& prepared,
                            const ChosenCamera& chosen,
                            double render_seconds,
                            const Log& log) {
    const RenderOptions& options = request.options;
    const AssetInfo& info = prepared.scene().info;
    ImageMetadata metadata;
    metadata.software = "Obscura " OBSCURA_VERSION;
    metadata.asset = info.file_name;
    metadata.copyright = info.copyright;
    metadata.samples_per_pixel = samples_taken(options);
    metadata.seed = options.seed;
    metadata.render_seconds = render_seconds;
    metadata.is_color =
        !needs_preview(options.integrator) || options.integrator == Integrator::albedo;
    const CameraMatrices matrices = camera_matrices(chosen.camera, chosen.znear_m, chosen.zfar_m);
    std::copy_n(matrices.world_to_camera, 16, metadata.world_to_camera);
    metadata.has_ndc = matrices.has_ndc;
    std::copy_n(matrices.world_to_ndc, 16, metadata.world_to_ndc);
    metadata.extra = {{"integrator", entry_of(options.integrator).name},
                      {"camera", chosen.description},
                      {"cameraModel", name_of(camera_model_names, chosen.camera.model)},
                      {"cameraParameters", camera_parameters(chosen.camera)},
                      {"isa", prepared.isa_name()},
                      {"embree", prepared.embree_version()},
                      {"warnings", std::to_string(log.warnings().size())}};
    if (!info.xmp.empty()) metadata.extra.emplace_back("xmp", info.xmp);
    if (info.time_s) metadata.extra.emplace_back("timeSeconds", shortest(*info.time_s));
    if (!info.variant.empty()) metadata.extra.emplace_back("variant", info.variant);
    if (chosen.ev100) {
        metadata.extra.emplace_back("ev100", shortest(*chosen.ev100));
        metadata.extra.emplace_back("exposureScale", shortest(exposure_scale(*chosen.ev100)));
    }
    return metadata;
}

std::string degraded_text(const gltf::Degraded& degraded) {
    return fmt::format("textures={} primitives={} triangles={}",
                       degraded.textures,
                       degraded.primitives,
                       degraded.triangles);
}

Result<void> write_outputs(const RenderRequest& request,
                           const FinishedImage& finished,
                           const std::optional<DisplayTransform>& display,
                           const std::atomic<bool>& stop) {
    const DisplayTransform* const transform = display ? &*display : nullptr;
    const auto stopped = [](const std::string& name) {
        return fail(ExitCode::stopped_early, "E-STOPPED", name, "stopped");
    };
    for (const std::filesystem::path& output : request.outputs) {
        if (stop) return stopped(output.string());
        const std::optional<OutputFormat> format = output_format_of(output);
        if (!format) return fail(check_output(output).error());
        const OutputTarget target{*format, output.string()};
        const auto bytes = encode_output(target, request, finished, transform);
        if (!bytes) return fail(bytes.error());
        if (auto written = write_file_atomically(output, *bytes); !written) return written;
    }
    if (!request.standard_output) return {};
    if (stop) return stopped(standard_output_name);
    const OutputTarget target{*request.standard_output, standard_output_name};
    const auto bytes = encode_output(target, request, finished, transform);
    if (!bytes) return fail(bytes.error());
    return write_fully(STDOUT_FILENO, *bytes, standard_output_name);
}

}  // namespace obscura
