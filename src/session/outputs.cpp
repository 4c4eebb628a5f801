// session/outputs.cpp - the files that a rendering leaves.
// SPDX-License-Identifier: Apache-2.0
#include "session/outputs.h"

#include "base/atomic_file.h"
#include "base/rescued_file.h"
#include "base/setting_names.h"
#include "camera/exposure.h"
#include "camera/matrices.h"
#include "camera/names.h"
#include "image/oiio.h"
#include "render/integrators.h"
#include "session/built_in_environment.h"
#include "session/camera_parameters.h"
#include "session/image_names.h"
#include "session/image_parts.h"
#include "session/preview.h"
#include "session/statistics.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <span>
#include <system_error>
#include <unistd.h>

namespace obscura {

namespace {

bool is_exr(const std::filesystem::path& file) {
    return output_format_of(file) == OutputFormat::exr;
}

/// What an output is made of.
struct Content {
    const OutputImage& image;
    const ImageMetadata& metadata;
    ExrOptions exr;
    DisplayEncoding encoding;
};

/// Calls `write` with the image itself, or with what one can look at in its place.
template <typename Write>
auto with_content(const RenderRequest& request,
                  const FinishedImage& finished,
                  bool exr,
                  const DisplayTransform* display,
                  const Write& write) {
    const Integrator integrator = request.options.integrator;
    ExrOptions options = request.exr;
    if (is_aov(integrator)) options.depth = ExrDepth::float32;
    DisplayEncoding encoding = request.encoding;
    if (exr || !needs_preview(integrator)) {
        encoding.transform = display;
        return write(Content{finished.image, finished.metadata, options, encoding});
    }
    ImageMetadata metadata = finished.metadata;
    metadata.is_color = false;
    OutputImage whole = whole_image(finished.image);
    const bool is_albedo = integrator == Integrator::albedo;
    if (is_albedo && request.display.rec709_from_scene) {
        convert_colors(*request.display.rec709_from_scene, whole.pixels, whole.channels.size());
    }
    const OutputImage preview = preview_image(whole, integrator);
    return write(Content{preview, metadata, options, encoding});
}

/// True when an image has two eyes, the left one above the right one.
bool is_stereo(const Camera& camera) {
    return camera.model == CameraModel::environment && camera.environment.half_eyes_m > 0;
}

/// True when the image, or each of two eyes in parts of their own, is one whole sphere, as
/// OpenEXR's envmap attribute says: twice as wide as high.
bool is_latlong(const RenderRequest& request, const Camera& camera) {
    const RenderOptions& options = request.options;
    if (camera.model != CameraModel::environment || options.crop) return false;
    if (camera.environment.projection != EnvironmentProjection::latlong) return false;
    if (!is_stereo(camera)) return options.width == 2 * options.height;
    return request.exr.layout == ExrLayout::multipart && options.width == options.height;
}

/// The time of a frame in hours, minutes, seconds and frames of 24, 25 or 30 (also over 1.001) a
/// second; none: a time code does not count other rates, or more than a day.
std::optional<TimeCode> time_code(int frame, double fps) {
    const int whole = static_cast<int>(std::lround(std::min(fps, 1e6)));
    const bool is_counted = whole == 24 || whole == 25 || whole == 30;
    const bool is_exact = std::abs(fps - whole) < 1e-6 || std::abs(fps * 1.001 - whole) < 1e-3;
    if (frame < 0 || !is_counted || !is_exact) return {};
    const int seconds = frame / whole;
    if (seconds >= 24 * 3600) return {};
    return TimeCode{seconds / 3600, seconds / 60 % 60, seconds % 60, frame % whole};
}

/// What the lens and the shutter were set to, where that had a meaning for the image.
void add_photographic(const RenderRequest& request,
                      const ChosenCamera& chosen,
                      StandardAttributes& out) {
    const CameraSettings& settings = chosen.settings;
    const bool is_lens = chosen.camera.model == CameraModel::thin_lens;
    const auto narrow = [](double value) { return static_cast<float>(value); };
    if (settings.fstop && (is_lens || settings.shutter_s)) out.fstop = narrow(*settings.fstop);
    if (is_lens) out.focus_m = 1 / chosen.camera.thin_lens.inverse_focus;
    if (settings.shutter_s) {
        out.exposure_s = narrow(*settings.shutter_s);
        out.iso = narrow(settings.iso.value_or(100));
    } else if (request.shutter) {
        out.exposure_s = narrow((request.shutter->close - request.shutter->open) / request.fps);
    }
}

StandardAttributes standard_attributes(const RenderRequest& request, const ChosenCamera& chosen) {
    const RenderOptions& options = request.options;
    StandardAttributes out;
    const CameraMatrices matrices = camera_matrices(chosen.camera, chosen.znear_m, chosen.zfar_m);
    out.world_to_camera = matrices.world_to_camera;
    out.world_to_ndc = matrices.world_to_ndc;
    if (matrices.screen_window) {
        out.screen_window_width = matrices.screen_window->width;
        out.screen_window_center = {matrices.screen_window->center_x,
                                    matrices.screen_window->center_y};
    }
    add_photographic(request, chosen, out);
    const Integrator integrator = options.integrator;
    const bool is_in_nits = integrator == Integrator::path || integrator == Integrator::direct ||
                            integrator == Integrator::raycast;
    if (is_in_nits) out.white_luminance = 1.0f;
    out.is_latlong = is_latlong(request, chosen.camera);
    if (is_stereo(chosen.camera)) out.views = {"left", "right"};
    if (request.frames) {
        out.frame_rate_hz = request.frames->fps;
        if (request.frame) out.time_code = time_code(*request.frame, request.frames->fps);
    }
    return out;
}

/// What is asked for against fireflies at the price of a bias; nothing where there is none.
void add_bias(const RenderOptions& options, std::vector<ImageAttribute>& extra) {
    if (options.clamp_direct > 0) extra.push_back({"obscura:clampDirect", options.clamp_direct});
    if (options.clamp_indirect > 0)
        extra.push_back({"obscura:clampIndirect", options.clamp_indirect});
    if (!options.caustics) extra.push_back({"obscura:caustics", "off"});
    if (options.regularize) extra.push_back({"obscura:regularize", "on"});
}

/// The formats of all files that hold images; a part of an image has a form of its own.
std::vector<OutputFormat> written_formats(const RenderRequest& request) {
    if (is_part_of_image(request)) return {};
    std::vector<OutputFormat> formats = formats_of(request);
    if (request.segmentation) formats.push_back(OutputFormat::png);
    return formats;
}

/// OpenEXRs are read otherwise, and built-in environments are not read at all.
bool may_be_read_by_oiio(const std::filesystem::path& environment) {
    const auto built_in = parse_built_in_environment(environment.string());
    return built_in && !*built_in && output_format_of(environment) != OutputFormat::exr;
}

/// The folders of an image's files that are made where they are missing.
std::vector<std::filesystem::path> made_folders(const RenderRequest& request,
                                                const ListedImage& image) {
    std::vector<std::filesystem::path> folders;
    const auto add = [&](const std::filesystem::path& pattern, const std::filesystem::path& file) {
        const bool is_made = has_fields(pattern) || request.lists.makes_folders;
        if (is_made && file.has_parent_path()) folders.push_back(file.parent_path());
    };
    for (size_t i = 0; i < image.outputs.size(); ++i)
        add(request.outputs[i], image.outputs[i]);
    if (image.segmentation) add(*request.segmentation, *image.segmentation);
    add(request.long_run.checkpoint, image.checkpoint);
    return folders;
}

/// Makes them; where that fails, writing will say why.
void make_folders(const RenderRequest& request, const ListedImage& image) {
    std::error_code ignored;
    for (const std::filesystem::path& folder : made_folders(request, image))
        std::filesystem::create_directories(folder, ignored);
}

bool lacks_folder(const std::filesystem::path& file) {
    std::error_code ignored;
    return file.has_parent_path() && !std::filesystem::exists(file.parent_path(), ignored);
}

/// Whether the folder that a file lacks could be made.
///
/// Errors  73 E-OUT-CREATE
Result<void> check_folder_can_be_made(const std::filesystem::path& file) {
    std::error_code ignored;
    std::filesystem::path there = file.parent_path();
    while (there.has_parent_path() && there.has_relative_path() &&
           !std::filesystem::exists(there, ignored))
        there = there.parent_path();
    if (!std::filesystem::exists(there, ignored)) there = ".";
    const bool is_folder = std::filesystem::is_directory(there, ignored);
    if (is_folder && ::access(there.c_str(), W_OK | X_OK) == 0) return {};
    return fail(ExitCode::cannot_create,
                "E-OUT-CREATE",
                file.string(),
                "its folder cannot be made: '" + there.string() +
                    (is_folder ? "' cannot be written" : "' is no folder"));
}

Result<void> check_files_of(const RenderRequest& request, const ListedImage& image) {
    const RenderOptions& options = request.options;
    std::vector<std::filesystem::path> made;
    if (request.check) made = made_folders(request, image);
    const auto is_to_be_made = [&](const std::filesystem::path& file) {
        return lacks_folder(file) &&
               std::find(made.begin(), made.end(), file.parent_path()) != made.end();
    };
    for (const std::filesystem::path& output : image_files(request, image)) {
        const bool is_made = is_to_be_made(output);
        if (is_made) {
            if (auto can_be = check_folder_can_be_made(output); !can_be) return can_be;
        }
        const Result<OutputTarget> target = is_made ? output_target(output) : check_output(output);
        if (!target) return fail(target.error());
        auto fits = check_encoding(*target, request.encoding, options.width, options.height);
        if (!fits) return fits;
    }
    if (!image.segmentation) return {};
    for (const std::filesystem::path& file : segmentation_files(*image.segmentation)) {
        auto writable =
            is_to_be_made(file) ? check_folder_can_be_made(file) : check_file_can_be_written(file);
        if (!writable) return writable;
    }
    return {};
}

}  // namespace

std::vector<std::filesystem::path> all_files(const RenderRequest& request,
                                             const ListedImage& image) {
    std::vector<std::filesystem::path> files = image_files(request, image);
    if (!image.segmentation) return files;
    for (const std::filesystem::path& file : segmentation_files(*image.segmentation))
        files.push_back(file);
    return files;
}

Result<void> check_outputs(const RenderRequest& request) {
    const RenderOptions& options = request.options;
    if (request.standard_output) {
        const OutputTarget target{*request.standard_output, standard_output_name};
        auto fits = check_encoding(target, request.encoding, options.width, options.height);
        if (!fits) return fits;
    }
    for (const auto* file :
         {&request.crypto_manifest, &request.statistics, &request.lists.manifest}) {
        if (!*file) continue;
        const bool is_made = file == &request.lists.manifest && lacks_folder(**file);
        auto writable =
            is_made ? check_folder_can_be_made(**file) : check_file_can_be_written(**file);
        if (!writable) return writable;
    }
    return {};
}

Result<void> check_image_files(const RenderRequest& request,
                               const std::vector<ListedImage>& images) {
    std::set<std::filesystem::path> seen;
    std::optional<Error> first;
    bool any = false;
    for (const ListedImage& image : images) {
        bool is_new = false;
        for (const std::filesystem::path& output : image.outputs)
            is_new = seen.insert(output.parent_path()).second || is_new;
        if (image.segmentation)
            is_new = seen.insert(image.segmentation->parent_path()).second || is_new;
        if (request.long_run.has_checkpoint)
            is_new = seen.insert(image.checkpoint.parent_path()).second || is_new;
        if (!is_new) continue;
        if (!request.check) make_folders(request, image);
        const Result<void> writable = check_files_of(request, image);
        any = any || writable;
        if (!writable && !first) first = writable.error();
        if (first && !request.lists.is_asked()) break;
    }
    // Of a list, images that can be written are.
    const bool goes_on = any && request.lists.is_asked();
    if (first && !goes_on) return fail(std::move(*first));
    return {};
}

void open_writers_ahead(const RenderRequest& request) {
    const std::vector<OutputFormat> formats = written_formats(request);
    const bool reads = request.environment && may_be_read_by_oiio(*request.environment);
    if (reads || std::any_of(formats.begin(), formats.end(), is_written_by_oiio)) open_oiio_ahead();
}

Result<void> check_writers(const RenderRequest& request) {
    for (const OutputFormat format : written_formats(request)) {
        if (auto there = check_writer(format); !there) return there;
    }
    return {};
}

void warn_of(const WriteReport& report, const std::string& file, Log& log) {
    if (report.clamped_values > 0) {
        log.warn(
            file,
            fmt::format("{} values beyond {:.0f}, the largest of 16 bits{}, are clamped; {} keeps "
                        "them{}",
                        report.clamped_values,
                        report.largest_half,
                        report.largest_half < 65504 ? " that the codec keeps finite" : "",
                        setting("float"),
                        report.largest_half < 65504 ? " with another codec" : ""));
    }
    if (report.half_instead) {
        log.warn(file,
                 fmt::format("its colours have 16 bits in spite of {}: dwaa and dwab keep no more; "
                             "choose another codec",
                             setting("float")));
    }
    if (report.lossless_instead) {
        log.warn(file,
                 "its colours are compressed by ZIP: the codec would round the data beside them; "
                 "give layers parts or files of their own");
    }
}

void warn_of_lost_alpha(const RenderRequest& request, Log& log) {
    if (request.options.background != BackgroundKind::transparent || request.encoding.page) return;
    const auto check = [&](OutputFormat format, const std::string& name) {
        if (entry_of(format).has_alpha) return;
        log.warn(name,
                 fmt::format("{} has no alpha, so what is transparent becomes black; {} white lays "
                             "the image over white",
                             entry_of(format).name,
                             setting("page")));
    };
    for (const std::filesystem::path& output : request.outputs) {
        if (const auto format = output_format_of(output)) check(*format, output.string());
    }
    if (request.standard_output) check(*request.standard_output, standard_output_name);
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
                            const Log& log) {
    const RenderOptions& options = request.options;
    const AssetInfo& info = prepared.scene().info;
    ImageMetadata metadata;
    metadata.software = "Obscura " OBSCURA_VERSION;
    metadata.asset = info.file_name;
    metadata.copyright = info.copyright;
    metadata.samples_per_pixel = samples_taken(options);
    metadata.seed = options.seed;
    metadata.space = request.space;
    metadata.is_color =
        !needs_preview(options.integrator) || options.integrator == Integrator::albedo;
    metadata.standard = standard_attributes(request, chosen);
    metadata.extra = {{"obscura:integrator", entry_of(options.integrator).name},
                      {"obscura:camera", chosen.description},
                      {"obscura:projection", name_of(camera_model_names, chosen.camera.model)},
                      {"obscura:cameraParameters", camera_parameters(chosen.camera)},
                      {"obscura:isa", prepared.isa_name()},
                      {"obscura:embree", prepared.embree_version()},
                      {"obscura:warnings", static_cast<int>(log.warnings().size())},
                      {"obscura:xmp", info.xmp},
                      {"obscura:variant", info.variant}};
    if (info.time_s) metadata.extra.push_back({"obscura:timeSeconds", *info.time_s});
    if (has_catchers(options.integrator)) add_bias(options, metadata.extra);
    if (chosen.ev100) {
        metadata.extra.push_back({"obscura:ev100", *chosen.ev100});
        metadata.extra.push_back({"obscura:exposureScale", exposure_scale(*chosen.ev100)});
    }
    return metadata;
}

void add_samples_taken(const AdaptiveOptions& asked,
                       const SamplesTaken& taken,
                       ImageMetadata& metadata) {
    const std::initializer_list<ImageAttribute> added = {
        {"obscura:noiseTarget", asked.noise_target},
        {"obscura:samplesMin", taken.least},
        {"obscura:samplesMax", taken.most},
        {"obscura:samplesMean", taken.mean()},
        {"obscura:samplesTotal", static_cast<double>(taken.total)}};
    metadata.extra.insert(metadata.extra.end(), added);
    if (taken.noise) metadata.extra.push_back({"obscura:noise", *taken.noise});
}

std::string degraded_text(const gltf::Degraded& degraded) {
    return fmt::format("textures={} primitives={} triangles={}",
                       degraded.textures,
                       degraded.primitives,
                       degraded.triangles);
}

Result<EncodedFile> encode_output(const RenderRequest& request,
                                  const FinishedImage& finished,
                                  const OutputTarget& target,
                                  const std::optional<DisplayTransform>& display) {
    const bool exr = target.format == OutputFormat::exr;
    const DisplayTransform* const transform = display ? &*display : nullptr;
    return with_content(request, finished, exr, transform, [&](const Content& content) {
        return encode_image(target, content.image, content.metadata, content.exr, content.encoding);
    });
}

DisplayedImage displayed_image(const RenderRequest& request,
                               const FinishedImage& finished,
                               const std::optional<DisplayTransform>& display) {
    const DisplayTransform* const transform = display ? &*display : nullptr;
    return with_content(request, finished, false, transform, [](const Content& content) {
        std::optional<OutputImage> whole;
        if (content.image.part_of) whole = whole_image(content.image);
        const OutputImage& image = whole ? *whole : content.image;
        DisplayEncoding encoding = content.encoding;
        if (!content.metadata.is_color) encoding.transform = nullptr;
        DisplayedImage out{image.width, image.height, 0, {}};
        out.codes = display_codes<uint8_t>(image, true, encoding);
        const size_t pixels = static_cast<size_t>(out.width) * static_cast<size_t>(out.height);
        out.channels = static_cast<int>(out.codes.size() / pixels);
        return out;
    });
}

Result<void> write_outputs(const RenderRequest& request,
                           const FinishedImage& finished,
                           const std::optional<DisplayTransform>& display,
                           const std::atomic<bool>& stop,
                           Log& log) {
    const auto stopped = [](const std::string& name) {
        return fail(ExitCode::stopped_early, "E-STOPPED", name, "stopped");
    };
    const WriteRescue rescue{.retries = request.write_retries, .stop = &stop};
    const auto write_file = [&](const std::filesystem::path& path,
                                std::span<const std::byte> bytes) {
        return write_or_rescue(path, bytes, rescue);
    };
    // Before the images that name it.
    if (request.crypto_manifest && !finished.crypto_manifest.empty()) {
        const auto bytes = std::as_bytes(std::span(finished.crypto_manifest));
        const auto written = write_file(*request.crypto_manifest, bytes);
        if (!written) return written;
    }
    if (request.segmentation && finished.segmentation) {
        const auto written =
            write_segmentation(*request.segmentation, *finished.segmentation, finished.metadata);
        if (!written) return written;
    }
    const DisplayTransform* const transform = display ? &*display : nullptr;
    for (const std::filesystem::path& output : request.outputs) {
        if (stop) return stopped(output.string());
        const auto write = [&](const Content& content) {
            return write_image_file({output, write_file},
                                    content.image,
                                    content.metadata,
                                    content.exr,
                                    content.encoding);
        };
        const bool exr = is_exr(output);
        const Result<WriteReport> written = with_content(request, finished, exr, transform, write);
        if (!written) return fail(written.error());
        warn_of(*written, output.string(), log);
    }
    if (!request.standard_output) return {};
    if (stop) return stopped(standard_output_name);
    const OutputTarget target{*request.standard_output, standard_output_name};
    const Result<EncodedFile> encoded = encode_output(request, finished, target, display);
    if (!encoded) return fail(encoded.error());
    warn_of(encoded->report, target.name, log);
    return write_fully(STDOUT_FILENO, encoded->bytes, standard_output_name);
}

}  // namespace obscura
