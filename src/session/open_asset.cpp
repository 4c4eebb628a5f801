// session/open_asset.cpp - an asset that stays open: each image changes only what it must.
// SPDX-License-Identifier: Apache-2.0
#include "session/open_asset.h"

#include "scene/node_primitives.h"
#include "session/lighting.h"

#include <algorithm>

namespace obscura {

namespace {

PoseTimes pose_times(const ImageTime& time) {
    PoseTimes times;
    times.time_s = time.time_s.value_or(0);
    if (time.shutter_s) {
        times.shutter = gltf::ShutterTimes{
            times.time_s + (*time.shutter_s)[0], times.time_s + (*time.shutter_s)[1], times.time_s};
    }
    return times;
}

/// Whether two ways of reading differ in the variant at most, and in what each image decides.
bool are_alike(gltf::LoadOptions a, const gltf::LoadOptions& b) {
    a.variant = b.variant;
    a.keeps_uv = b.keeps_uv;
    a.time_s = b.time_s;
    return a == b;
}

}  // namespace

/// Reads the file for the purposes of this image. They change what is made of the file, so that
/// another purpose reads it again.
Result<void> OpenAsset::read(const ReadFor& wanted, Log& log) {
    if (renderer_ && read_for_ == wanted) return {};
    read_for_ = wanted;
    load_.keeps_uv = wanted.uv;
    renderer_.reset();
    is_posed_ = false;
    prepared_for_.reset();
    Result<AssetRenderer> renderer = AssetRenderer::open(file_, load_, wanted.times, log);
    if (!renderer) return fail(renderer.error());
    renderer_ = std::move(*renderer);
    has_plan_ = false;
    for (const auto& [pointer, value] : values_) {
        if (auto done = renderer_->set_value(pointer, value); !done) return done;
    }
    for (const auto& [node, material] : assigned_) {
        if (auto done = renderer_->assign_material(node, material); !done) return done;
    }
    return {};
}

Result<void> OpenAsset::open(Log& log) {
    if (auto done = read({}, log); !done) return done;
    if (auto posed = renderer_->pose({}, log); !posed) return posed;
    is_posed_ = true;
    return {};
}

Result<ChosenCamera> OpenAsset::prepare(const RenderRequest& request,
                                        const ImageTime& time,
                                        Log& log) {
    Result<ChosenCamera> camera = bring(request, time, log);
    if (!camera && renderer_ && !renderer_->has_scene()) renderer_.reset();
    return camera;
}

Result<ChosenCamera> OpenAsset::bring(const RenderRequest& request,
                                      const ImageTime& time,
                                      Log& log) {
    if (auto done = read({time.is_given(), wants_uv(request.options)}, log); !done)
        return fail(done.error());
    AssetRenderer& renderer = *renderer_;
    const PreparedFor wanted{time,
                             request.environment.value_or("").string(),
                             request.environment_intensity,
                             request.environment_rotation_deg,
                             request.environment_follows_camera,
                             request.catcher_ground,
                             request.isa};
    const bool is_there = prepared_for_ && prepared_for_->isa == wanted.isa;
    // The thickness of points and lines depends on the camera.
    const bool keeps_pose = is_there && prepared_for_->time == time && !is_changed_ &&
                            !has_points_lines(renderer.scene());
    const bool same = prepared_for_ == wanted;
    const bool turns_light = request.environment_follows_camera;
    if (same && keeps_pose && !turns_light) return renderer.look_again(request, log);
    if (!is_there) renderer.start_anew();
    prepared_for_.reset();
    if (!same) {
        Result<LightingOptions> lighting = load_lighting(request, log);
        if (!lighting) return fail(lighting.error());
        lighting_ = std::move(*lighting);
    }
    if (keeps_pose) {
        renderer.prepare_again();
    } else if (!is_posed_ || is_changed_ || time.is_given()) {
        if (auto posed = renderer.pose(pose_times(time), log); !posed) return fail(posed.error());
    }
    is_posed_ = is_changed_ = false;
    Result<ChosenCamera> camera = renderer.prepare(request, lighting_, log);
    if (camera) prepared_for_ = wanted;
    return camera;
}

Result<void> OpenAsset::load_as(const gltf::LoadOptions& load, Log& log) {
    if (!are_alike(load, load_)) {
        load_ = load;
        load_.time_s.reset();
        renderer_.reset();
        return {};
    }
    return load.variant == load_.variant ? Result<void>() : set_variant(load.variant, log);
}

Result<void> OpenAsset::set_variant(const std::string& name, Log& log) {
    if (auto done = read(read_for_, log); !done) return done;
    if (!has_plan_) {
        std::vector<std::string> all = renderer_->info().variants;
        all.emplace_back();
        if (auto planned = renderer_->plan_variants(all, true); !planned) return planned;
        has_plan_ = true;
    }
    if (auto chosen = renderer_->choose_variant(name); !chosen) {
        (void)renderer_->choose_variant(load_.variant);  // parts to hide may be of the other one
        return chosen;
    }
    load_.variant = name;
    is_changed_ = true;
    return {};
}

Result<void> OpenAsset::set_value(const std::string& pointer,
                                  const std::vector<double>& value,
                                  Log& log) {
    if (auto done = read(read_for_, log); !done) return done;
    if (auto set = renderer_->set_value(pointer, value); !set) return set;
    std::erase_if(values_, [&](const auto& known) { return known.first == pointer; });
    values_.emplace_back(pointer, value);
    is_changed_ = true;
    return {};
}

Result<void> OpenAsset::assign_material(size_t node, size_t material, Log& log) {
    if (auto done = read(read_for_, log); !done) return done;
    if (auto assigned = renderer_->assign_material(node, material); !assigned) return assigned;
    assigned_[node] = material;
    is_changed_ = true;
    return {};
}

void OpenAsset::reset() {
    values_.clear();
    assigned_.clear();
    renderer_.reset();
}

}  // namespace obscura
