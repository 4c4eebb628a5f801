// session/asset_renderer.cpp - reads an asset once and makes images of it.
// SPDX-License-Identifier: Apache-2.0
#include "session/asset_renderer.h"

#include "base/stopwatch.h"
#include "camera/exposure.h"
#include "render/enclosed_lights.h"
#include "render/integrators.h"
#include "scene/scene_memory.h"
#include "session/denoising.h"
#include "session/focus.h"
#include "session/framed_geometry.h"
#include "session/image_layers.h"
#include "session/lighting.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace obscura {

namespace {

/// The masks of `--segmentation`, whose layer leaves the film.
Segmentation take_segmentation(Film& film, const Scene& scene) {
    const auto masks = std::find_if(film.layers.begin(), film.layers.end(), [](const auto& one) {
        return std::holds_alternative<MajorityNode>(one.layer.source);
    });
    std::rotate(masks, masks + 1, film.layers.end());  // behind it were the scene's light groups
    Segmentation out = segmentation_of(film, scene);
    film.layers.pop_back();
    return out;
}

}  // namespace

Result<AssetRenderer> AssetRenderer::open(const std::filesystem::path& file,
                                          const gltf::LoadOptions& options,
                                          bool has_time,
                                          Log& log) {
    const Stopwatch loading;
    Result<gltf::PosedAsset> asset = gltf::PosedAsset::open(file, options, has_time, log);
    if (!asset) return fail(asset.error());
    AssetRenderer out(std::move(*asset));
    out.statistics_.load_s = loading.seconds();
    return out;
}

Result<void> AssetRenderer::find_framed_nodes(CameraRequest& camera) const {
    if (camera.framed_node.empty()) return {};
    Result<std::vector<char>> nodes = asset_->subtree(camera.framed_node);
    if (!nodes) return fail(nodes.error());
    camera.framed_nodes = std::move(*nodes);
    return {};
}

Result<void> AssetRenderer::pose(const PoseTimes& times, Log& log) {
    const Stopwatch loading;
    if (scene_) asset_->take_back(std::move(*scene_));
    if (is_prepared_) asset_->take_back(prepared_->take_scene());
    scene_.reset();
    is_prepared_ = false;
    geometry_.forget();
    Result<Scene> scene = times.shutter ? asset_->scene_between(*times.shutter, times.is_last, log)
                                        : asset_->scene_at(times.time_s, times.is_last, log);
    if (!scene) return fail(scene.error());
    charges_.textures = asset_->texture_charges();
    if (auto fits = charge_geometry(*scene, charges_); !fits) return fits;
    degraded_ = asset_->degraded();
    add_degraded(degraded_, statistics_.degraded);
    if (times.is_last) asset_.reset();
    statistics_.load_s += loading.seconds();
    statistics_.parse_s += scene->info.parse_seconds;
    statistics_.decode_s += scene->info.decode_seconds;
    statistics_.geometry_bytes = geometry_bytes(*scene);
    statistics_.texture_bytes = texture_bytes(*scene);
    scene_ = std::move(*scene);
    return {};
}

void AssetRenderer::prepare_again() {
    if (!is_prepared_) return;
    scene_ = prepared_->take_scene();
    is_prepared_ = false;
}

void AssetRenderer::start_anew() {
    if (is_prepared_) asset_->take_back(prepared_->take_scene());
    is_prepared_ = false;
    prepared_.reset();
}

const Scene& AssetRenderer::scene() const {
    return scene_ ? *scene_ : prepared_->scene();
}

Result<ChosenCamera> AssetRenderer::prepare(const RenderRequest& request,
                                            const LightingOptions& lighting,
                                            Log& log) {
    Result<ChosenCamera> camera = choose_unfocused_camera(framed_scene(), request, log);
    if (!camera) return camera;
    if (has_points_lines(*scene_)) size_points_lines(request.points_lines, camera->camera, *scene_);
    std::optional<LightingOptions> turned;
    if (request.environment_follows_camera) {
        turned = lighting;
        turned->environment_rotation_deg += camera_azimuth_deg(camera->basis.world_from_camera);
    }
    const LightingOptions& used = turned ? *turned : lighting;
    Scene scene = std::move(*scene_);
    scene_.reset();
    if (prepared_) {
        const Result<void> updated = prepared_->update(std::move(scene), used, log);
        if (!updated) {
            prepared_.reset();
            return fail(updated.error());
        }
    } else {
        Result<PreparedScene> created =
            PreparedScene::create(std::move(scene), used, request.isa, log);
        if (!created) return fail(created.error());
        prepared_ = std::move(*created);
    }
    is_prepared_ = true;
    if (!prepared_->scene().curve_points.empty()) geometry_.forget();  // curves were split
    if (!is_aov(request.options.integrator)) {
        const auto& eye = camera->camera.world_from_camera.m;
        warn_of_enclosed_lights(*prepared_, {eye[0][3], eye[1][3], eye[2][3]}, log);
    }
    statistics_.build_s += prepared_->build_seconds().all;
    statistics_.bvh_bytes = prepared_->bvh_bytes();
    statistics_.isa = prepared_->isa_name();
    statistics_.embree = prepared_->embree_version();
    if (auto focused = focus(*prepared_, request, log, *camera); !focused) {
        return fail(focused.error());
    }
    return camera;
}

Result<ChosenCamera> AssetRenderer::look_again(const RenderRequest& request, Log& log) {
    Result<ChosenCamera> camera = choose_unfocused_camera(framed_scene(), request, log);
    if (!camera) return camera;
    if (auto focused = focus(*prepared_, request, log, *camera); !focused) {
        return fail(focused.error());
    }
    return camera;
}

Result<RenderOptions> AssetRenderer::options_of_image(const RenderRequest& request,
                                                      const ChosenCamera& camera) {
    RenderOptions options = request.options;
    options.crop = rendered_part(request);
    if (request.segmentation) options.layers.push_back(segmentation_layer());
    if (request.denoise) add_denoising_layers(options);
    set_half_runs(options);
    if (request.catcher_ground) {
        const FramedGeometry& geometry =
            geometry_.of(prepared_->scene(), request.camera.framed_nodes);
        options.catcher_ground_m = static_cast<float>(geometry.farthest({0, -1, 0}).y);
    }
    options.moving_camera = camera.moving;
    Result<std::vector<Camera>> frame_cameras =
        choose_frame_cameras(prepared_->scene(), request.camera, camera);
    if (!frame_cameras) return fail(frame_cameras.error());
    options.frame_cameras = std::move(*frame_cameras);
    options.film_memory = &film_memory_;
    if (options.adaptive) {
        const double camera_scale = camera.ev100 ? exposure_scale(*camera.ev100) : 1;
        options.adaptive->white = std::exp2(-request.display.exposure_ev) / camera_scale;
    }
    return options;
}

Result<FinishedImage> AssetRenderer::render(const RenderRequest& request,
                                            const ChosenCamera& camera,
                                            const RenderHooks& hooks,
                                            const Log& log) {
    Result<RenderedFilm> film = render_film(request, camera, hooks);
    if (!film) return fail(film.error());
    return finish(request, camera, std::move(*film), log);
}

Result<RenderedFilm> AssetRenderer::render_film(const RenderRequest& request,
                                                const ChosenCamera& camera,
                                                const RenderHooks& hooks) {
    Result<RenderOptions> options = options_of_image(request, camera);
    if (!options) return fail(options.error());
    options->share = hooks.share;
    const auto fits = charge_film(prepared_->scene(), request, *options, charges_);
    if (!fits) return fail(fits.error());
    const std::atomic<bool> never = false;
    Result<RenderResult> result = obscura::render(*prepared_,
                                                  camera.camera,
                                                  *options,
                                                  hooks.progress,
                                                  hooks.stop != nullptr ? *hooks.stop : never);
    if (!result) return fail(result.error());
    statistics_.render_s += result->render_seconds;
    add_counters(result->counters, statistics_.counters);
    if (result->adaptive) add_samples(*result->adaptive, statistics_.adaptive);
    const Film& film = result->film;
    statistics_.film_bytes = film.pixels.size() * sizeof(float) + layer_bytes(film.layers);
    return RenderedFilm{std::move(*options), std::move(*result)};
}

FinishedImage AssetRenderer::finish(const RenderRequest& request,
                                    const ChosenCamera& camera,
                                    RenderedFilm&& rendered,
                                    const Log& log) {
    const RenderOptions& options = rendered.options;
    RenderResult& result = rendered.result;
    Film& film = result.film;
    FinishedImage finished;
    finished.metadata = make_metadata(request, *prepared_, camera, log);
    if (result.adaptive) {
        add_samples_taken(*options.adaptive, *result.adaptive, finished.metadata);
    }
    finished.render_seconds = result.render_seconds;
    if (request.load.lenient) {
        finished.metadata.extra.push_back({"obscura:degraded", degraded_text(degraded_)});
    }
    if (request.denoise) {
        const std::string done = denoise_film(options, request.options, film);
        finished.metadata.extra.push_back({"obscura:denoise", done});
    }
    if (request.segmentation) {
        finished.segmentation = take_segmentation(film, prepared_->scene());
    }
    std::string manifest;
    if (request.crypto_manifest) {
        manifest = request.crypto_manifest->filename().string();
        finished.crypto_manifest = cryptomatte_document(film.layers);
    }
    finished.counters = result.counters;
    finished.image = {
        film.width, film.height, std::move(film.channels), std::move(film.pixels), film.part_of};
    finished.image.layers = image_layers(std::move(film.layers), manifest);
    return finished;
}

}  // namespace obscura
