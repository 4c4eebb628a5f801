// serve/drake_image.cpp - makes the images that Drake's render client asks for.
// SPDX-License-Identifier: Apache-2.0
#include "serve/drake_image.h"

#include "base/memory_budget.h"
#include "base/parallel.h"
#include "image/encode.h"
#include "session/outputs.h"

#include "dataset/ray_labels.h"
#include "serve/guarded.h"

namespace obscura::serve {

namespace {

using Bytes = std::vector<std::byte>;

/// The scene as this request sees it.
struct Look {
    AssetRenderer& renderer;
    const ChosenCamera& camera;
    const RenderRequest& request;
    const std::atomic<bool>& stop;
};

/// The labels of an image, within the budget of memory until they are written.
struct ChargedLabels {
    MemoryCharge charge;
    dataset::RayLabels rays;
};

Result<Bytes> stopped() {
    return fail(ExitCode::stopped_early, "E-STOPPED", "render", "stopped on request");
}

Result<ChargedLabels> trace(const Look& look) {
    constexpr uint64_t pixel_bytes = 20;  // three words, and what is written
    const RenderOptions& options = look.request.options;
    const uint64_t pixels =
        static_cast<uint64_t>(options.width) * static_cast<uint64_t>(options.height);
    Result<MemoryCharge> charge =
        charge_memory(MemoryUse::film,
                      std::to_string(options.width) + "x" + std::to_string(options.height),
                      pixels * pixel_bytes);
    if (!charge) return fail(std::move(charge.error()));
    ChargedLabels out{std::move(*charge), {}};
    out.rays = dataset::trace_labels(
        look.renderer.prepared(), look.camera.camera, options, dataset::Depth::nearest, &look.stop);
    if (look.stop) return fail(stopped().error());
    return out;
}

Result<Bytes> color_image(const Look& look, const DrakeJob& job, Log& log) {
    const RenderHooks hooks{{}, &job.stop, nullptr};
    const Result<FinishedImage> image = look.renderer.render(look.request, look.camera, hooks, log);
    if (!image) return fail(image.error());
    Result<std::optional<DisplayTransform>> display = make_display(look.request, log);
    if (!display) return fail(display.error());
    if (auto exposed = expose_display(look.camera, look.request, *display, log); !exposed)
        return fail(exposed.error());
    Result<EncodedFile> file =
        encode_output(look.request, *image, {OutputFormat::png, "color"}, *display);
    if (!file) return fail(file.error());
    return std::move(file->bytes);
}

Result<Bytes> depth_image(const Look& look, const DrakeJob& job) {
    Result<ChargedLabels> labels = trace(look);
    if (!labels) return fail(labels.error());
    dataset::RayLabels& rays = labels->rays;
    for (float& depth_m : rays.depth_m)
        depth_m = sensed_depth(depth_m, job.wanted.depth_range_m);
    return encode_exact({OutputFormat::tiff, "depth"},
                        {rays.width, rays.height, 1, OiioType::float32, rays.depth_m.data()});
}

Result<Bytes> label_image(const Look& look, const DrakeJob& job) {
    const Result<ChargedLabels> labels = trace(look);
    if (!labels) return fail(labels.error());
    const dataset::RayLabels& rays = labels->rays;
    std::vector<uint8_t> colors;
    std::vector<uint16_t> numbers;
    const bool in_numbers = job.labels == LabelEncoding::number;
    const Scene& scene = look.renderer.scene();
    for (const int32_t material : rays.material) {
        const bool is_empty = material < 0;
        const auto color =
            is_empty ? empty_label_color
                     : label_color(scene.materials[static_cast<size_t>(material)].base_color);
        if (in_numbers) {
            numbers.push_back(is_empty ? empty_label_number : label_number(color));
        } else {
            colors.insert(colors.end(), color.begin(), color.end());
        }
    }
    const OutputTarget target{OutputFormat::png, "label"};
    if (in_numbers)
        return encode_exact(target, {rays.width, rays.height, 1, OiioType::uint16, numbers.data()});
    return encode_exact(target, {rays.width, rays.height, 3, OiioType::uint8, colors.data()});
}

/// With the scene's mutex locked.
Result<Bytes> make_image(OpenAsset& asset, const DrakeJob& job) {
    Log log;
    RenderRequest request = job.request;
    apply(job.wanted, request);
    if (auto loaded = asset.load_as(request.load, log); !loaded) return fail(loaded.error());
    const Result<ChosenCamera> camera = asset.prepare(request, {}, log);
    if (!camera) return fail(camera.error());
    if (!camera->of_file) {  // it would be framed
        return fail(ExitCode::bad_data,
                    "E-DRAKE-CAMERA",
                    "scene",
                    "it has no camera; expected one, at the pose of the image");
    }
    const Look look{asset.renderer(), *camera, request, job.stop};
    switch (job.wanted.image) {
        case DrakeImage::depth:
            return depth_image(look, job);
        case DrakeImage::label:
            return label_image(look, job);
        case DrakeImage::color:
            break;
    }
    return color_image(look, job, log);
}

}  // namespace

Result<Bytes> make_drake_image(SentScene& scene, const DrakeJob& job) {
    return guarded<Bytes>([&]() -> Result<Bytes> {
        constexpr std::chrono::milliseconds interval(100);
        std::unique_lock lock(scene.mutex, std::defer_lock);
        while (!lock.try_lock_for(interval)) {
            if (job.stop) return stopped();
        }
        if (job.stop) return stopped();
        const ThreadArena threads(job.request.threads);
        return make_image(scene.asset, job);
    });
}

}  // namespace obscura::serve
