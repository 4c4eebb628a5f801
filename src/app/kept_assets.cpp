// app/kept_assets.cpp - assets that are open for later renderings of a job, or are read ahead.
// SPDX-License-Identifier: Apache-2.0
#include "app/kept_assets.h"

#include "app/render_request.h"
#include "base/parallel.h"
#include "session/image_parts.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <system_error>

namespace obscura::app {

namespace {

bool has_times(const RenderRequest& request) {
    const std::vector<View>& views = *request.lists.views;
    return request.load.time_s || request.frames || request.shutter ||
           std::any_of(views.begin(), views.end(), [](const View& view) {
               return view.time_s.has_value();
           });
}

/// The pose of a request's first image, as far as that is known before there is a list: another
/// one costs time and nothing else.
///
/// Errors  those of listed_variants
Result<AssetPose> first_pose(const RenderRequest& request, const AssetRenderer& renderer) {
    const auto variants = listed_variants(request, renderer.info().variants);
    if (!variants) return fail(variants.error());
    double time_s = first_time_s(request);
    std::string variant = variants->front();
    if (!request.lists.views->empty()) {
        const View& view = request.lists.views->front();
        time_s = view.time_s.value_or(time_s);
        variant = view.variant.value_or(variant);
    }
    return pose_at(request, time_s, variant);
}

/// Errors  those of read_named_files, open_asset and posing
Result<std::pair<AssetUse, KeptAsset>> read(RenderRequest request, Notes& notes) {
    Log log = noting_log(request.verbosity, notes);
    Log unheard;  // the rendering will say the same
    if (auto done = read_named_files(request, unheard); !done) return fail(done.error());
    Result<AssetRenderer> renderer = open_asset(request, log);
    if (!renderer) return fail(renderer.error());
    const Result<AssetPose> pose = first_pose(request, *renderer);
    if (!pose) return fail(pose.error());
    if (auto chosen = renderer->choose_variant(pose->variant); !chosen) return fail(chosen.error());
    if (auto posed = renderer->pose(pose->times, log); !posed) return fail(posed.error());
    NamedTexts facts = facts_of_asset(renderer->files());
    KeptAsset asset{std::move(*renderer), std::move(facts)};
    asset.pose = *pose;
    return std::pair(asset_use(request), std::move(asset));
}

}  // namespace

AssetUse asset_use(const RenderRequest& request) {
    return {request.scene, request.load, has_times(request), request.isa};
}

AssetPose pose_at(const RenderRequest& request, double time_s, const std::string& variant) {
    PoseTimes times{time_s};
    if (request.shutter) {
        const double frame_s = 1 / request.fps;
        times.shutter = gltf::ShutterTimes{time_s + request.shutter->open * frame_s,
                                           time_s + request.shutter->close * frame_s,
                                           time_s};
    }
    return {times, variant};
}

double first_time_s(const RenderRequest& request) {
    if (!request.frames) return request.load.time_s.value_or(0);
    return request.frames->time_s(request.frames->numbers.front());
}

Result<void> plan_variants(const RenderRequest& request, AssetRenderer& renderer) {
    const auto variants = variants_to_plan(request, renderer.info().variants);
    if (!variants) return fail(variants.error());
    return renderer.plan_variants(*variants, request.lists.keeps_asset);
}

Result<AssetRenderer> open_asset(const RenderRequest& request, Log& log) {
    const AssetUse use = asset_use(request);
    Result<AssetRenderer> renderer = AssetRenderer::open(use.scene, use.load, use.has_times, log);
    if (!renderer) return renderer;
    if (auto planned = plan_variants(request, *renderer); !planned) return fail(planned.error());
    return renderer;
}

std::optional<KeptAsset> KeptAssets::take(const AssetUse& use) {
    if (scene_being_read_ == use.scene) finish_reading();
    const auto found = std::find_if(
        open_.begin(), open_.end(), [&](const Entry& entry) { return entry.first == use; });
    if (found == open_.end()) return {};
    std::optional<KeptAsset> out = std::move(found->second);
    open_.erase(found);
    return out;
}

void KeptAssets::keep(AssetUse use, KeptAsset asset) {
    open_.emplace_back(std::move(use), std::move(asset));
}

void KeptAssets::read_ahead(RenderRequest request, int threads) {
    const bool is_open = std::any_of(open_.begin(), open_.end(), [&](const Entry& entry) {
        return entry.first.scene == request.scene;
    });
    if (is_open || reading_.valid()) return;
    scene_being_read_ = request.scene;
    const auto read_it = [threads](RenderRequest asked) -> std::optional<Entry> {
        try {
            const ThreadArena arena(threads);
            Notes notes;
            Result<Entry> done = read(std::move(asked), notes);
            if (!done) return {};
            done->second.notes = std::move(notes);
            return std::move(*done);
        } catch (const std::exception&) {  // no memory: it may be there in its turn
            return {};
        }
    };
    try {
        reading_ = std::async(std::launch::async, read_it, std::move(request));
    } catch (const std::system_error&) {  // there is no thread
        scene_being_read_.clear();
    }
}

bool KeptAssets::is_reading() const {
    return reading_.valid() &&
           reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

bool KeptAssets::close_all() {
    const bool had_any = reading_.valid() || !open_.empty();
    finish_reading();
    open_.clear();
    return had_any;
}

void KeptAssets::finish_reading() {
    if (!reading_.valid()) return;
    std::optional<Entry> entry = reading_.get();
    scene_being_read_.clear();
    if (entry) open_.push_back(std::move(*entry));
}

}  // namespace obscura::app
