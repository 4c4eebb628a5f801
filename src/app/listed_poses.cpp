// app/listed_poses.cpp - poses an asset for the images of a list, each pose once.
// SPDX-License-Identifier: Apache-2.0
#include "app/listed_poses.h"

#include "base/stopwatch.h"
#include "render/points_lines_sizes.h"
#include "session/lighting.h"
#include "session/segmentation.h"

#include <algorithm>

namespace obscura::app {

namespace {

/// When an image's scene is posed.
PoseTimes times_of(const RenderRequest& request, double time_s, bool is_last) {
    PoseTimes times{time_s, {}, is_last};
    if (request.shutter) {
        const double frame_s = 1 / request.fps;
        times.shutter = gltf::ShutterTimes{time_s + request.shutter->open * frame_s,
                                           time_s + request.shutter->close * frame_s,
                                           time_s};
    }
    return times;
}

bool has_times(const RenderRequest& request) {
    const std::vector<View>& views = request.lists.views;
    return request.load.time_s || request.frames || request.shutter ||
           std::any_of(views.begin(), views.end(), [](const View& view) {
               return view.time_s.has_value();
           });
}

}  // namespace

std::string environment_key(const RenderRequest& request) {
    if (!request.environment) return "";
    return request.color_space + "\n" + request.environment->string();
}

double ListedPoses::first_time_s() const {
    if (!whole_.frames) return whole_.load.time_s.value_or(0);
    return whole_.frames->time_s(whole_.frames->numbers.front());
}

Result<void> ListedPoses::load_once() {
    if (job_.renderer) return {};
    Result<void> loaded = load(job_.log);
    if (!loaded) job_.renderer.reset();
    return loaded;
}

/// Opens the asset, unless the rendering before has left it as it would be.
Result<void> ListedPoses::open(Log& log) {
    KeptAsset* const kept = job_.kept;
    const bool fits = kept != nullptr && kept->renderer && kept->scene == whole_.scene &&
                      kept->load == whole_.load && kept->has_times == has_times(whole_) &&
                      kept->isa == whole_.isa;
    if (fits) {
        job_.renderer = std::move(kept->renderer);
        job_.renderer->statistics() = {};
    }
    if (kept != nullptr) kept->renderer.reset();
    if (fits) return {};
    Result<AssetRenderer> renderer =
        AssetRenderer::open(whole_.scene, whole_.load, has_times(whole_), log);
    if (!renderer) return fail(renderer.error());
    job_.renderer = std::move(*renderer);
    return {};
}

/// Reads or makes the environment, unless the job has had it before.
Result<void> ListedPoses::light(Log& log) {
    RenderRequest request = whole_;
    std::optional<ImageRgb32f> known;
    if (job_.kept != nullptr && request.environment) {
        const auto found = job_.kept->environments.find(environment_key(request));
        if (found != job_.kept->environments.end()) {
            known = std::move(found->second.image);
            job_.kept->environments.erase(found);
        }
    }
    if (known) request.environment.reset();
    Result<LightingOptions> lighting = load_lighting(request, log);
    if (!lighting) return fail(lighting.error());
    if (known) {
        lighting->environment = std::move(known);
        lighting->environment_name = whole_.environment->string();
    }
    job_.lighting = std::move(*lighting);
    return {};
}

Result<void> ListedPoses::load(Log& log) {
    const Stopwatch loading;
    if (auto opened = open(log); !opened) return opened;
    if (auto found = job_.renderer->find_framed_nodes(whole_.camera); !found) return found;
    job_.request.camera.framed_nodes = whole_.camera.framed_nodes;
    const auto variants = variants_to_plan(whole_, job_.renderer->info().variants);
    if (!variants) return fail(variants.error());
    auto planned = job_.renderer->plan_variants(*variants, whole_.lists.keeps_asset);
    if (!planned) return planned;
    if (auto lit = light(log); !lit) return lit;
    if (auto there = check_writers(whole_); !there) return there;
    job_.renderer->statistics().load_s = loading.seconds();
    return {};
}

Result<void> ListedPoses::find_images(Log& log) {
    AssetOffer offer;
    if (whole_.lists.needs_asset()) {
        if (auto loaded = load_once(); !loaded) return loaded;
        offer.variants = job_.renderer->info().variants;
    }
    if (whole_.lists.cameras) {
        const auto variants = listed_variants(whole_, offer.variants);
        if (!variants) return fail(variants.error());
        const Pose first = {first_time_s(), variants->front()};
        if (auto posed = pose_as(first, false, log); !posed) return posed;
        for (const SceneCamera& camera : job_.renderer->scene().cameras)
            offer.cameras.push_back(camera.name);
    }
    Result<ImageList> list = list_images(whole_, offer);
    if (!list) return fail(list.error());
    list_ = std::move(*list);
    return {};
}

void ListedPoses::begin_image(size_t index) {
    const ListedImage& image = list_.images[index];
    job_.request = request_of(whole_, list_.views[image.view], image);
    job_.image_facts = image.facts;
    const auto kept = kept_.find(image.variant);
    if (kept == kept_.end()) return;
    job_.request.camera.framed = kept->second[image.view].bounds;
    job_.request.camera.kept = kept->second[image.view].framing;
}

ListedPoses::Pose ListedPoses::pose_of(size_t index) const {
    return {list_.images[index].time_s, list_.images[index].variant};
}

Result<void> ListedPoses::pose_as(const Pose& pose, bool is_last, Log& log) {
    if (posed_ == pose && job_.renderer->has_scene()) return {};
    posed_.reset();
    lit_.reset();
    if (auto chosen = job_.renderer->choose_variant(pose.second); !chosen) return chosen;
    const auto posed = job_.renderer->pose(times_of(whole_, pose.first, is_last), log);
    if (posed) posed_ = pose;
    return posed;
}

/// The framing of the first frame, in every view.
void ListedPoses::keep_views(const std::string& variant) {
    const Scene& scene = job_.renderer->scene();
    std::vector<KeptView>& kept = kept_[variant];
    for (const View& view : list_.views) {
        RenderRequest request = request_of(whole_, view, list_.images.front());
        request.camera.framed = scene.bounds;
        const double aspect = static_cast<double>(request.options.width) / request.options.height;
        kept.push_back({scene.bounds, automatic_framing(scene, request.camera, aspect)});
    }
}

Result<void> ListedPoses::pose(size_t index, bool is_last, Log& log) {
    const Pose wanted = pose_of(index);
    // All keep the view of the first frame, whoever renders it.
    if (is_sequence() && !kept_.contains(wanted.second)) {
        const Pose first = {first_time_s(), wanted.second};
        const bool is_first = wanted == first;
        if (auto posed = pose_as(first, is_last && is_first, is_first ? log : job_.log); !posed)
            return posed;
        keep_views(wanted.second);
        begin_image(index);
    }
    if (auto posed = pose_as(wanted, is_last, log); !posed) return posed;
    if (!job_.request.segmentation) return {};
    return check_segmentation(job_.renderer->scene());
}

Result<ChosenCamera> ListedPoses::look(size_t index, bool is_last, Log& log) {
    // Points and lines may be as thick as the view says; their pose is made anew for each.
    const bool has_own_pose =
        lit_ && job_.renderer->has_scene() && has_points_lines(job_.renderer->scene());
    if (has_own_pose) posed_.reset();
    const RenderRequest& request = job_.request;
    if (auto fits = check_crop(request.options); !fits) return fail(fits.error());
    if (auto posed = pose(index, is_last, log); !posed) return fail(posed.error());
    const Light light = {request.environment_rotation_deg, request.environment_intensity};
    if (lit_ == light && !request.environment_follows_camera)
        return job_.renderer->look_again(request, log);
    lit_.reset();
    job_.renderer->prepare_again();
    LightingOptions& lighting = job_.lighting;
    lighting.environment_rotation_deg = light.first;
    lighting.environment_intensity = light.second;
    Result<ChosenCamera> camera = job_.renderer->prepare(request, lighting, log);
    if (camera) lit_ = light;
    return camera;
}

void leave_asset(Job& job) {
    if (job.kept == nullptr) return;
    const RenderRequest& whole = job.whole;
    KeptAsset& kept = *job.kept;
    if (job.lighting.environment && whole.environment) {
        ImageRgb32f& image = *job.lighting.environment;
        const uint64_t bytes = image.pixels.size() * sizeof(float);
        auto charge = charge_memory(MemoryUse::environment, job.lighting.environment_name, bytes);
        if (charge)
            kept.environments[environment_key(whole)] = {std::move(image), std::move(*charge)};
    }
    kept.renderer.reset();
    if (!whole.lists.keeps_asset) return;
    kept.scene = whole.scene;
    kept.load = whole.load;
    kept.has_times = has_times(whole);
    kept.isa = whole.isa;
    kept.asset_facts = std::move(job.asset_facts);
    kept.renderer = std::move(job.renderer);
}

}  // namespace obscura::app
