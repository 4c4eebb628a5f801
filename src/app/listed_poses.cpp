// app/listed_poses.cpp - poses an asset for the images of a list, each pose once.
// SPDX-License-Identifier: Apache-2.0
#include "app/listed_poses.h"

#include "base/memory_budget.h"
#include "base/stopwatch.h"
#include "render/points_lines_sizes.h"
#include "session/lighting.h"
#include "session/repeated_log.h"
#include "session/segmentation.h"

#include <utility>

namespace obscura::app {

std::string environment_key(const RenderRequest& request) {
    if (!request.environment) return "";
    return request.color_space + "\n" + request.environment->string();
}

Result<void> ListedPoses::load_once() {
    if (job_.renderer) return {};
    RepeatedLog repeated(job_.log, SettingNames::options);
    Result<void> loaded = load(is_reopened_ ? repeated.begin() : job_.log);
    if (!loaded) job_.renderer.reset();
    return loaded;
}

/// Opens the asset, unless it is open or was read ahead.
Result<void> ListedPoses::open(Log& log) {
    KeptAssets& assets = job_.kept.assets;
    if (std::optional<KeptAsset> kept = assets.take(asset_use(whole_))) {
        take(std::move(*kept), log);
        return {};
    }
    if (memory_share_taken() > max_share_of_kept) assets.close_all();
    Log noted = noted_log(log, job_.asset_notes);
    Result<AssetRenderer> renderer = open_asset(whole_, noted);
    if (!renderer) return fail(renderer.error());
    job_.renderer = std::move(*renderer);
    notes_pose_ = true;
    return {};
}

void ListedPoses::take(KeptAsset&& asset, Log& log) {
    log.detail(whole_.scene.string() + (asset.pose ? " was read ahead" : " is open already"));
    job_.renderer = std::move(asset.renderer);
    if (!asset.facts.empty()) job_.kept.asset_facts[whole_.scene] = std::move(asset.facts);
    job_.asset_notes = std::move(asset.notes);
    job_.asset_notes.tell(log);
    has_told_pose_ = true;
    posed_ = asset.pose;
    if (!posed_) job_.renderer->statistics() = {};
}

/// Reads or makes the environment, unless the job has had it before.
Result<void> ListedPoses::light(Log& log) {
    KeptForLater::Environment& kept = job_.kept.environments[environment_key(whole_)];
    if (kept.image) {
        log.detail(whole_.environment->string() + " is there already");
        kept.notes.tell(log);
    }
    Log noted = noted_log(log, kept.notes);
    Result<LightingOptions> lighting = load_lighting(whole_, noted, kept.image);
    if (!lighting) return fail(lighting.error());
    kept.image = lighting->environment;
    job_.lighting = std::move(*lighting);
    job_.lighting.environments = job_.kept.environment_tables;
    return {};
}

Result<void> ListedPoses::load(Log& log) {
    const Stopwatch loading;
    if (auto opened = open(log); !opened) return opened;
    AssetRenderer& renderer = *job_.renderer;
    if (auto found = renderer.find_framed_nodes(whole_.camera); !found) return found;
    job_.request.camera.framed_nodes = whole_.camera.framed_nodes;
    if (auto planned = plan_variants(whole_, renderer); !planned) return planned;
    if (auto lit = light(log); !lit) return lit;
    if (auto there = check_writers(whole_); !there) return there;
    RenderStatistics& statistics = renderer.statistics();
    if (!posed_) statistics.load_s = loading.seconds();
    if (before_close_) {
        before_close_->load_s += statistics.load_s;
        statistics = std::move(*before_close_);
        before_close_.reset();
    }
    return {};
}

void ListedPoses::close() {
    if (job_.renderer) before_close_ = job_.renderer->statistics();
    job_.renderer.reset();
    job_.asset_notes = {};
    posed_.reset();
    lit_.reset();
    has_told_pose_ = is_reopened_ = true;
}

void ListedPoses::tell_again(Log& log) {
    job_.asset_notes.tell(log);
    job_.kept.environments[environment_key(whole_)].notes.tell(log);
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
        const AssetPose first = pose_at(whole_, first_time_s(whole_), variants->front());
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

AssetPose ListedPoses::pose_of(size_t index) const {
    return pose_at(whole_, list_.images[index].time_s, list_.images[index].variant);
}

Result<void> ListedPoses::pose_as(const AssetPose& pose, bool is_last, Log& log) {
    if (posed_ == pose && job_.renderer->has_scene()) {
        if (is_last) job_.renderer->forget_asset();
        return {};
    }
    RepeatedLog repeated(log, SettingNames::options);
    Log& heard = has_told_pose_ ? repeated.begin() : log;
    if (!std::exchange(notes_pose_, false)) return pose_anew(pose, is_last, heard);
    Log noted = noted_log(heard, job_.asset_notes);
    return pose_anew(pose, is_last, noted);
}

Result<void> ListedPoses::pose_anew(const AssetPose& pose, bool is_last, Log& log) {
    posed_.reset();
    lit_.reset();
    if (auto chosen = job_.renderer->choose_variant(pose.variant); !chosen) return chosen;
    PoseTimes times = pose.times;
    times.is_last = is_last;
    const auto posed = job_.renderer->pose(times, log);
    if (posed) posed_ = pose;
    return posed;
}

/// The framing of the first frame, in every view.
void ListedPoses::keep_views(const std::string& variant) {
    const FramedScene framed = job_.renderer->framed_scene();
    std::vector<KeptView>& kept = kept_[variant];
    for (const View& view : list_.views) {
        RenderRequest request = request_of(whole_, view, list_.images.front());
        request.camera.framed = framed.scene.bounds;
        const double aspect = static_cast<double>(request.options.width) / request.options.height;
        kept.push_back({framed.scene.bounds, automatic_framing(framed, request.camera, aspect)});
    }
}

Result<void> ListedPoses::pose(size_t index, bool is_last, Log& log) {
    const AssetPose wanted = pose_of(index);
    // All keep the view of the first frame, whoever renders it.
    if (is_sequence() && !kept_.contains(wanted.variant)) {
        const AssetPose first = pose_at(whole_, first_time_s(whole_), wanted.variant);
        const bool is_first = wanted == first;
        if (auto posed = pose_as(first, is_last && is_first, is_first ? log : job_.log); !posed)
            return posed;
        keep_views(wanted.variant);
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
    if (!job.renderer || !job.whole.lists.keeps_asset) return;
    KeptAsset asset{std::move(*job.renderer)};
    job.renderer.reset();
    asset.notes = std::move(job.asset_notes);
    job.kept.assets.keep(asset_use(job.whole), std::move(asset));
}

bool give_back(KeptForLater& kept) {
    const bool had_assets = kept.assets.close_all();
    const bool had_tables = kept.environment_tables->drop_unused();
    const size_t images = std::erase_if(kept.environments, [](const auto& entry) {
        return entry.second.image && entry.second.image.use_count() == 1;
    });
    return had_assets || had_tables || images > 0;
}

}  // namespace obscura::app
