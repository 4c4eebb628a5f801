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

namespace obscura {

namespace {

/// .exr in upper or lower case, as write_image_file recognises formats.
bool is_exr(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return extension == ".exr";
}

}  // namespace

Result<void> check_outputs(const RenderRequest& request) {
    // All files of a sequence lie in one folder: those of the first frame stand for all.
    const MovieFrame first = frames_of(request).front();
    for (const std::filesystem::path& output : first.outputs) {
        if (auto writable = check_output(output); !writable) return writable;
    }
    if (request.statistics) return check_file_can_be_written(*request.statistics);
    return {};
}

Result<std::optional<DisplayTransform>> make_display(const RenderRequest& request, Log& log) {
    const bool wanted = !needs_preview(request.options.integrator) &&
                        !std::all_of(request.outputs.begin(), request.outputs.end(), is_exr);
    if (!wanted) return std::optional<DisplayTransform>();
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
    const Integrator integrator = request.options.integrator;
    const ExrDepth depth = is_aov(integrator) ? ExrDepth::float32 : request.exr_depth;
    for (const std::filesystem::path& output : request.outputs) {
        if (stop) return fail(ExitCode::stopped_early, "E-STOPPED", output.string(), "stopped");
        Result<void> written;
        if (needs_preview(integrator) && !is_exr(output)) {
            ImageMetadata metadata = finished.metadata;
            metadata.is_color = false;
            const OutputImage preview = preview_image(whole_image(finished.image), integrator);
            written = write_image_file(output, preview, metadata, depth, nullptr);
        } else {
            written = write_image_file(
                output, finished.image, finished.metadata, depth, display ? &*display : nullptr);
        }
        if (!written) return written;
    }
    return {};
}

}  // namespace obscura
