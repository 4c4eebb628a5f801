// session/library.cpp - the library's Session: opens assets, renders images, writes files.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "film/cryptomatte_names.h"
#include "render/film_rows.h"
#include "render/integrators.h"
#include "scene/node_primitives.h"
#include "session/library_asset.h"
#include "session/library_camera.h"
#include "session/library_image.h"
#include "session/library_request.h"
#include "session/outputs.h"
#include "session/requested_camera.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <obscura/obscura.h>

namespace obscura {

v0::Error library_error(const Error& error) {
    const auto spelled = [](const std::string& text) {
        return spell_settings(text, SettingNames::fields);
    };
    v0::Error out;
    out.id = error.id;
    out.place = spelled(error.where);
    out.text = spelled(error.message);
    out.code = static_cast<int>(error.code);
    for (const Error& other : error.also)
        out.also.push_back(library_error(other));
    return out;
}

LogSink library_sink(const v0::MessageSink& sink) {
    if (!sink) return {};
    return [sink](const LogMessage& message) {
        sink({message.is_warning, std::string(message.where), std::string(message.text)});
    };
}

namespace {

/// Runs a call; exceptions become errors.
template <typename T, typename Body>
v0::Result<T> guarded(const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return library_error({ExitCode::out_of_memory, "E-MEM", "", "out of memory"});
    } catch (const std::exception& error) {
        return library_error({ExitCode::internal, "E-INTERNAL", "", error.what()});
    } catch (...) {  // of callbacks, which may be of any language
        return library_error(
            {ExitCode::internal, "E-INTERNAL", "", "a callback threw what is no std::exception"});
    }
}

v0::AssetInfo info_of(const Scene& scene) {
    const AssetInfo& from = scene.info;
    v0::AssetInfo out;
    out.file = from.file_name;
    out.generator = from.generator;
    out.copyright = from.copyright;
    out.scenes = from.scenes;
    out.scene = from.scene;
    out.variants = from.variants;
    out.triangles = from.triangles_in_world;
    for (size_t i = 0; i < scene.material_numbers.size(); ++i) {
        const auto number = static_cast<size_t>(int64_t{scene.material_numbers[i]} + 1);
        if (out.materials.size() < number) out.materials.resize(number);
        if (number > 0) out.materials[number - 1] = scene.material_names[i];
    }
    for (const AnimationInfo& animation : from.animations)
        out.animations.push_back({animation.name, animation.end_s});
    for (const SceneCamera& camera : scene.cameras) {
        v0::CameraInfo& added = out.cameras.emplace_back();
        added.name = camera.name;
        added.orthographic = camera.type == SceneCameraType::orthographic;
        if (!added.orthographic) added.fov_deg = camera.yfov_rad * 180 / pi_d;
        for (size_t i = 0; i < 12; ++i)
            added.world_from_camera[i] = camera.world_from_camera.m[i / 4][i % 4];
    }
    out.is_empty = scene.bounds.empty();
    if (out.is_empty) return out;
    const Vec3f& low = scene.bounds.low;
    const Vec3f& high = scene.bounds.high;
    out.low = {low.x, low.y, low.z};
    out.high = {high.x, high.y, high.z};
    return out;
}

/// Lets an asset be changed.
template <typename Change>
v0::Result<void> change(const Change& made) {
    return guarded<void>([&]() -> v0::Result<void> {
        if (const Result<void> done = made(); !done) return library_error(done.error());
        return {};
    });
}

struct ToldProgress {
    std::mutex mutex;
    double share = 0;
};

/// The callbacks of a control, called by one thread at a time. A tile that is finished first may
/// come here second: the share does not fall because of it.
ProgressFunction watched_by(const v0::Control& control, ToldProgress& told) {
    if (!control.progress && !control.tile) return {};
    return [&](const FinishedTile& tile) {
        const std::lock_guard lock(told.mutex);
        if (control.tile) {
            const Film& film = *tile.film;
            const PixelRect& area = tile.area;
            control.tile(
                {{area.x, area.y, area.width, area.height},
                 film.channels,
                 film.pixels.data() + pixel_index(film, area.x, area.y) * film.channels.size(),
                 static_cast<size_t>(film.width) * film.channels.size()});
        }
        told.share = std::max(told.share, tile.done);
        if (control.progress) control.progress(told.share);
    };
}

}  // namespace

namespace v0 {

namespace {

obscura::Result<Image> render_image(Asset::Impl& asset,
                                    const View& view,
                                    const RenderRequest& asked,
                                    const Control& control) {
    const auto cancelled = [&] { return control.cancel != nullptr && *control.cancel; };
    const auto stopped = [] {
        return fail(ExitCode::stopped_early, "E-STOPPED", "render", "stopped on request");
    };
    if (cancelled()) return stopped();
    const ThreadArena threads(asked.threads);
    Log& log = asset.has_images ? asset.later.begin() : asset.log;
    asset.has_images = true;
    RenderRequest request = asked;
    request.load = asset.asset.load();
    const std::optional<std::string>& animation = request.load.animation;
    const bool plays = animation ? *animation != "none" : view.time_s.has_value();
    if (plays && !asset.info.animations.empty() && !request.load.frame_step_s &&
        has_layer(request.options, Aov::motion)) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    "aov",
                    "motion tells movement from frame to frame: open the asset with fps");
    }
    if (auto loaded = load_requested_camera(request, log); !loaded) return fail(loaded.error());
    if (auto placed = place_opencv(view, request.camera); !placed) return fail(placed.error());
    const obscura::Result<ChosenCamera> camera =
        asset.asset.prepare(request, {view.time_s, view.shutter_s}, log);
    if (!camera) return fail(camera.error());
    if (cancelled()) return stopped();
    ToldProgress told;
    const RenderHooks hooks{watched_by(control, told), control.cancel};
    auto finished = asset.asset.renderer().render(request, *camera, hooks, asset.log);
    if (!finished) return fail(finished.error());
    Image image = library_image(*finished, request, *camera);
    asset.asset.renderer().recycle(std::move(finished->image));
    ImageStatistics& statistics = image.statistics;
    statistics.render_seconds = finished->render_seconds;
    statistics.paths = finished->counters.paths;
    statistics.rays = total_rays(finished->counters);
    statistics.nonfinite_samples = finished->counters.nonfinite_samples;
    return image;
}

obscura::Result<void> write_image(const Image& image,
                                  const std::string& file,
                                  const WriteOptions& options,
                                  Log& log) {
    if (!image.source) {
        return fail(ExitCode::usage, "E-USAGE-CONFLICT", file, "the image was not rendered");
    }
    RenderRequest request;
    request.outputs = {file};
    request.options.integrator = image.source->integrator;
    request.exr.depth = options.float32 ? ExrDepth::float32 : ExrDepth::half;
    request.exr.layout = static_cast<obscura::ExrLayout>(options.exr_layout);
    const obscura::Result<DisplayEncoding> encoding = encoding_of(options);
    if (!encoding) return fail(encoding.error());
    request.encoding = *encoding;
    request.display = {options.ocio_config, options.display, options.view, options.exposure_ev};
    obscura::Result<std::optional<DisplayTransform>> display = make_display(request, log);
    if (!display) return fail(display.error());
    ChosenCamera camera;
    camera.ev100 = image.source->ev100;
    if (auto done = expose_display(camera, request, *display, log); !done) return done;
    const std::atomic<bool> never = false;
    return write_outputs(request, finished_image(image), *display, never, log);
}

}  // namespace

struct Session::Impl {
    MessageSink sink;
};

Session::Session(MessageSink sink) : impl_(new Impl{std::move(sink)}) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

Asset::Asset(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

const AssetInfo& Asset::info() const {
    return impl_->info;
}

std::vector<NodeInfo> Asset::nodes() const {
    std::vector<NodeInfo> out;
    for (std::string& path : node_paths(impl_->graph))
        out.push_back({std::move(path), mesh_name(impl_->graph, out.size())});
    return out;
}

Result<void> Asset::set(const std::string& pointer, const std::vector<double>& value) {
    return change([&] { return impl_->asset.set_value(pointer, value, impl_->log); });
}

Result<void> Asset::set_variant(const std::string& name) {
    return change([&] { return impl_->asset.set_variant(name, impl_->log); });
}

Result<void> Asset::assign_material(std::size_t node, std::size_t material) {
    return change([&] { return impl_->asset.assign_material(node, material, impl_->log); });
}

void Asset::reset() {
    impl_->asset.reset();
}

Result<Asset> Session::open(const std::string& file, const AssetOptions& options) {
    return guarded<Asset>([&]() -> Result<Asset> {
        if (const auto fits = check_asset_options(options); !fits)
            return library_error(fits.error());
        const ThreadArena threads(options.threads);
        auto asset = std::make_shared<Asset::Impl>(impl_->sink, file, load_options_of(options));
        if (auto opened = asset->asset.open(asset->log); !opened)
            return library_error(opened.error());
        const Scene& scene = asset->asset.renderer().scene();
        asset->info = info_of(scene);
        asset->graph.node_names = scene.info.node_names;
        asset->graph.node_parents = scene.info.node_parents;
        asset->graph.node_meshes = scene.info.node_meshes;
        asset->graph.meshes = scene.info.meshes;
        return Asset(std::move(asset));
    });
}

Result<Image> Session::render(const Asset& asset,
                              const View& view,
                              const Look& look,
                              const Sampling& sampling,
                              const Control& control) {
    return guarded<Image>([&]() -> Result<Image> {
        const auto request = request_of(view, look, sampling, control);
        if (!request) return library_error(request.error());
        auto image = render_image(*asset.impl_, view, *request, control);
        if (!image) return library_error(image.error());
        return std::move(*image);
    });
}

Result<void> Session::write(const Image& image,
                            const std::string& file,
                            const WriteOptions& options) {
    return guarded<void>([&]() -> Result<void> {
        Log log(Verbosity::normal, library_sink(impl_->sink), SettingNames::fields);
        const auto written = write_image(image, file, options, log);
        if (!written) return library_error(written.error());
        return {};
    });
}

const char* version() noexcept {
    return OBSCURA_VERSION;
}

}  // namespace v0

}  // namespace obscura
