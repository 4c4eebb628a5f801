// app/render_frames.cpp - the images of a command in turn: those that are not there are made.
// SPDX-License-Identifier: Apache-2.0
#include "accel/embree_version.h"
#include "app/frame_claim.h"
#include "app/outcome.h"
#include "app/render_job.h"
#include "base/stopwatch.h"
#include "session/focus.h"
#include "session/lighting.h"
#include "session/repeated_log.h"
#include "session/requested_camera.h"
#include "session/segmentation.h"
#include "stages/dispatch.h"

#include <fmt/format.h>

namespace obscura::app {

namespace {

/// When an image's scene is posed.
PoseTimes times_of(const RenderRequest& request, const MovieFrame& frame, bool is_last) {
    PoseTimes times{frame.time_s, {}, is_last};
    if (request.shutter) {
        const double frame_s = 1 / request.fps;
        times.shutter = gltf::ShutterTimes{frame.time_s + request.shutter->open * frame_s,
                                           frame.time_s + request.shutter->close * frame_s,
                                           frame.time_s};
    }
    return times;
}

/// Times that a frame added to the sums.
FrameStatistics frame_statistics(const MovieFrame& frame,
                                 const RenderStatistics& before,
                                 const RenderStatistics& after) {
    return {frame.number.value_or(0),
            frame.time_s,
            after.load_s - before.load_s,
            after.build_s - before.build_s,
            after.render_s - before.render_s,
            after.write_s - before.write_s};
}

/// Reads the asset and the environment, once for all images.
Result<void> load(Job& job) {
    const gltf::LoadOptions& options = job.request.load;
    const bool has_time = options.time_s || job.request.frames || job.request.shutter;
    const Stopwatch loading;
    Result<AssetRenderer> renderer =
        AssetRenderer::open(job.request.scene, options, has_time, job.log);
    if (!renderer) return fail(renderer.error());
    job.renderer = std::move(*renderer);
    if (auto found = job.renderer->find_framed_nodes(job.request.camera); !found) return found;
    Result<LightingOptions> lighting = load_lighting(job.request, job.log);
    if (!lighting) return fail(lighting.error());
    job.lighting = std::move(*lighting);
    if (auto there = check_writers(job.request); !there) return there;
    job.renderer->statistics().load_s = loading.seconds();
    return {};
}

/// Poses the asset; a sequence keeps the view of its first frame.
Result<void> pose(Job& job, const MovieFrame& frame, const Turn& turn, Log& log) {
    const PoseTimes times = times_of(job.request, frame, turn.is_last);
    if (auto posed = job.renderer->pose(times, log); !posed) return posed;
    if (job.request.segmentation) {
        if (auto fits = check_segmentation(job.renderer->scene()); !fits) return fits;
    }
    if (job.request.frames && job.request.frames->numbers.size() > 1 && turn.is_first) {
        const Scene& scene = job.renderer->scene();
        const RenderOptions& options = job.request.options;
        CameraRequest& camera = job.request.camera;
        camera.framed = scene.bounds;
        camera.kept =
            automatic_framing(scene, camera, static_cast<double>(options.width) / options.height);
    }
    return {};
}

/// Whether --part-by frames leaves the frame with this index to another part.
bool is_of_another_part(const RenderRequest& request, size_t index) {
    if (!request.part || request.part_by != PartBy::frames) return false;
    return index % static_cast<size_t>(request.part->count) !=
           static_cast<size_t>(request.part->index);
}

/// The indices of the images that this command renders.
std::vector<size_t> indices_to_render(const RenderRequest& request, size_t count) {
    std::vector<size_t> out;
    for (size_t i = 0; i < count; ++i) {
        if (!is_of_another_part(request, i)) out.push_back(i);
    }
    return out;
}

/// Reads all files once more, which may be long: before loading only where files may be skipped, so
/// that one that is too large for the memory is refused first.
void find_facts(Job& job) {
    const Isa isa = job.request.isa;
    const std::string isa_name = has_isa(isa) ? stage_table_for(isa).isa : "";
    job.facts = facts_of(job.request, isa_name, embree_version());
}

/// The images of a command, of which those that are not there are rendered.
class FrameRun {
public:
    FrameRun(Job& job, Progress& progress)
        : job_(job),
          progress_(progress),
          all_(frames_of(job.request)),
          later_(job.log, SettingNames::options) {}

    /// Goes through the images; those of others once more in the end.
    Result<void> run() {
        if (job_.request.long_run.skips_existing) find_facts(job_);
        std::vector<size_t> left = indices_to_render(job_.request, all_.size());
        asked_ = left.size();
        last_ = left.empty() ? 0 : left.back();
        constexpr int passes = 2;
        for (int pass = 0; pass < passes && !left.empty(); ++pass) {
            if (auto done = render_free_ones(left); !done) return done;
        }
        std::vector<MovieFrame> of_others;
        for (const size_t i : left)
            of_others.push_back(all_[i]);
        return check_none_left(of_others, job_.request);
    }

private:
    /// In, out   left: images to render; then those that others hold
    Result<void> render_free_ones(std::vector<size_t>& left) {
        std::vector<size_t> of_others;
        for (const size_t i : left) {
            const Result<FrameClaim> claim = FrameClaim::make(job_, all_[i]);
            if (!claim) return fail(claim.error());
            if (claim->kind() == FrameClaim::Kind::is_there) ++job_.skipped;
            if (claim->kind() == FrameClaim::Kind::of_others) of_others.push_back(i);
            if (claim->kind() != FrameClaim::Kind::to_render) continue;
            if (auto done = render_one(i); !done) return done;
        }
        left = std::move(of_others);
        return {};
    }

    Result<void> render_one(size_t index) {
        if (!job_.renderer) {
            if (auto loaded = load(job_); !loaded) return loaded;
            if (job_.facts.empty()) find_facts(job_);
        }
        // All keep the view of the first frame, whoever renders it.
        if (index != 0 && !has_view_) {
            if (auto posed = pose_one(0, job_.log); !posed) return posed;
        }
        RenderStatistics& statistics = job_.renderer->statistics();
        const RenderStatistics before = statistics;
        Log& log = index == 0 ? job_.log : later_.begin();
        if (auto posed = pose_one(index, log); !posed) return posed;
        const Result<ChosenCamera> camera =
            job_.renderer->prepare(job_.request, job_.lighting, log);
        if (!camera) return fail(camera.error());
        const auto done = make_image(job_, *camera, turn_of(index), log, progress_);
        if (!done) return done;
        job_.watch.begin_preparing();
        ++rendered_;
        const MovieFrame& frame = all_[index];
        if (!frame.number) return {};
        statistics.frames.push_back(frame_statistics(frame, before, statistics));
        job_.log.info(fmt::format(
            "frame {} is written, {} of {}", *frame.number, rendered_ + job_.skipped, asked_));
        return {};
    }

    Result<void> pose_one(size_t index, Log& log) {
        const MovieFrame& frame = all_[index];
        job_.request.outputs = frame.outputs;
        job_.request.segmentation = frame.segmentation;
        job_.request.frame = frame.number;
        has_view_ = true;
        return pose(job_, frame, turn_of(index), log);
    }

    /// With locks nobody knows which image comes last, unless there is one only.
    Turn turn_of(size_t index) const {
        const bool may_come_back = job_.request.long_run.skips_existing && all_.size() > 1;
        const size_t done = rendered_ + job_.skipped;
        return {done, asked_, index == 0, index == last_ && !may_come_back};
    }

    Job& job_;
    Progress& progress_;
    const std::vector<MovieFrame> all_;
    RepeatedLog later_;
    size_t asked_ = 0;     ///< number of images that this command is to render
    size_t rendered_ = 0;  ///< of them, those that it has rendered
    size_t last_ = 0;      ///< of them, the index of the last one
    bool has_view_ = false;
};

}  // namespace

Result<void> render_all(Job& job, Progress& progress) {
    const Result<void> done = FrameRun(job, progress).run();
    if (done) progress.finish();
    return done;
}

Result<void> check_all(Job& job) {
    if (const Result<void> loaded = load(job); !loaded) return loaded;
    const std::vector<MovieFrame> frames = frames_of(job.request);
    RepeatedLog later(job.log, SettingNames::options);
    for (size_t i = 0; i < frames.size(); ++i) {
        Log& log = i == 0 ? job.log : later.begin();
        if (auto posed =
                pose(job, frames[i], {i, frames.size(), i == 0, i + 1 == frames.size()}, log);
            !posed)
            return posed;
        const Result<ChosenCamera> chosen =
            choose_unfocused_camera(job.renderer->scene(), job.request, log);
        if (!chosen) return fail(chosen.error());
        const Result<void> exposed = expose_display(*chosen, job.request, job.display, log);
        if (!exposed) return exposed;
    }
    if (!has_isa(job.request.isa)) return fail(missing_isa());
    job.log.info("checked: nothing forbids to render it; nothing was written");
    return {};
}

}  // namespace obscura::app
