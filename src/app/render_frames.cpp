// app/render_frames.cpp - the images of a command in turn: those that are not there are made.
// SPDX-License-Identifier: Apache-2.0
#include "accel/embree_version.h"
#include "app/distinct_files.h"
#include "app/frame_claim.h"
#include "app/listed_images.h"
#include "app/listed_poses.h"
#include "app/outcome.h"
#include "app/render_job.h"
#include "app/signals.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "gltf/asset_files.h"
#include "session/focus.h"
#include "session/manifest.h"
#include "session/repeated_log.h"
#include "stages/dispatch.h"

#include <fmt/format.h>
#include <future>
#include <memory>
#include <system_error>

namespace obscura::app {

namespace {

/// Times that a frame added to the sums.
FrameStatistics frame_statistics(const ListedImage& image,
                                 const RenderStatistics& before,
                                 const RenderStatistics& after) {
    return {image.number.value_or(0),
            image.time_s,
            after.load_s - before.load_s,
            after.build_s - before.build_s,
            after.render_s - before.render_s,
            after.write_s - before.write_s};
}

/// Reads all files once more, which may be long: before loading only where files may be skipped, so
/// that one that is too large for the memory is refused first.
void find_facts(Job& job) {
    const Isa isa = job.request.isa;
    const std::string isa_name = has_isa(isa) ? stage_table_for(isa).isa : "";
    NamedTexts& asset = job.kept.asset_facts[job.whole.scene];
    if (asset.empty()) {
        asset = facts_of_asset(job.renderer ? job.renderer->files()
                                            : gltf::files_of_asset(job.whole.scene));
    }
    job.facts = facts_of(job.request, asset, isa_name, embree_version(), job.kept.checksums);
}

/// An error as the manifest has it: with the code by which a signal ends the command, and a text.
Error told_error(Error error) {
    if (error.id != "E-STOPPED") return error;
    const int signal = received_stop_signal();
    StopReason reason{static_cast<int>(error.code), "stopped on request"};
    if (signal != 0) reason = stop_reason(signal);
    error.code = static_cast<ExitCode>(reason.code);
    error.message = reason.text + (error.message.empty() ? "" : "; " + error.message);
    return error;
}

struct MadeImage {
    ImageOutcome outcome;
    FrameStatistics figures = {};
};

/// An image whose files are written while the next one is rendered.
struct WrittenBeside {
    MadeImage made;
    RenderRequest request;
    FinishedImage finished;
    MemoryCharge charge;
    Notes notes = {};
    Result<void> noted = {};  ///< in the manifest
    std::future<Result<void>> done = {};
};

/// However writing ends, the watch is told.
struct EndOfWriting {
    Watch& watch;
    ~EndOfWriting() { watch.end_writing_beside(); }
};

/// The images of a command, of which those that are not there are rendered.
class FrameRun {
public:
    FrameRun(Job& job, Progress& progress)
        : job_(job), progress_(progress), poses_(job), later_(job.log, SettingNames::options) {}

    /// Goes through the images; those of others once more in the end.
    Result<void> run() {
        Result<void> done = render_images();
        if (auto before = finish_beside(); done && !before) done = before;
        if (job_.renderer) job_.renderer->statistics().write_s += write_beside_s_;
        if (!done) return done;
        if (failures_.count() > 0) return fail(std::move(failures_).all(asked_));
        return check_none_left(of_others_, job_.request);
    }

private:
    Result<void> render_images() {
        if (auto opened = open_manifest(); !opened) return opened;
        if (auto listed = with_memory(job_.log, [&](Log& log) { return list(log); }); !listed)
            return note_no_list(listed.error());
        if (job_.request.long_run.skips_existing) find_facts(job_);
        std::vector<size_t> left = indices_to_render(job_.request, images().size());
        asked_ = left.size();
        last_ = left.empty() ? 0 : left.back();
        constexpr int passes = 2;
        for (int pass = 0; pass < passes && !left.empty(); ++pass) {
            if (auto done = render_free_ones(left); !done) return done;
        }
        for (const size_t i : left)
            of_others_.push_back(images()[i]);
        return {};
    }

    const std::vector<ListedImage>& images() const { return poses_.list().images; }

    Result<void> open_manifest() {
        const RenderRequest& request = poses_.whole();
        if (!request.lists.manifest) return {};
        Result<Manifest> manifest = Manifest::open(*request.lists.manifest, false);
        if (!manifest) return fail(manifest.error());
        manifest_.emplace(std::move(*manifest));
        job_.kept.has_manifest = true;
        return {};
    }

    Result<void> list(Log& log) {
        if (auto listed = poses_.find_images(log); !listed) return listed;
        const RenderRequest& request = poses_.whole();
        if (auto own = note_files(job_, images()); !own) return own;
        return request.lists.needs_asset() ? check_files(request, images()) : Result<void>();
    }

    /// Does something once more when memory lacks that was taken for what comes later, or for an
    /// image that is being written.
    ///
    /// In      act: takes the log
    template <typename Action>
    Result<void> with_memory(Log& log, const Action& act) {
        const Result<void> done = act(log);
        const bool lacks_memory = !done && done.error().code == ExitCode::out_of_memory;
        if (!lacks_memory) return done;
        const bool had_image = beside_ != nullptr;
        if (auto before = finish_beside(); !before) return before;
        const bool had_more = give_back(job_.kept);
        if (!had_image && !had_more) return done;
        job_.log.detail(had_more ? "memory lacks: what later renderings need is given back"
                                 : "memory lacks: the image before is written first");
        const AssetRenderer* const renderer = job_.renderer ? &*job_.renderer : nullptr;
        const bool is_whole = renderer != nullptr && renderer->has_scene() && renderer->can_pose();
        if (!is_whole) poses_.close();
        job_.watch.begin_preparing();
        RepeatedLog repeated(log, SettingNames::options);
        return act(repeated.begin());
    }

    /// An asset whose images are not known has one line.
    Result<void> note_no_list(const Error& error) {
        const ListedImage image;
        ImageOutcome outcome{image, View{}};
        outcome.error = told_error(error);
        if (auto noted = note(job_.request, outcome); !noted) return noted;
        return fail(error);
    }

    /// In, out   left: images to render; then those that others hold
    Result<void> render_free_ones(std::vector<size_t>& left) {
        std::vector<size_t> of_others;
        for (const size_t i : left) {
            poses_.begin_image(i);
            const Result<FrameClaim> claim = FrameClaim::make(job_, images()[i]);
            if (!claim) return fail(claim.error());
            if (claim->kind() == FrameClaim::Kind::of_others) of_others.push_back(i);
            if (claim->kind() == FrameClaim::Kind::is_there) {
                ++job_.skipped;
                ImageOutcome outcome = outcome_of(i);
                outcome.was_there = true;
                if (auto noted = note(job_.request, outcome); !noted) return noted;
            }
            if (claim->kind() != FrameClaim::Kind::to_render) continue;
            if (auto done = render_and_note(i); !done) return done;
        }
        left = std::move(of_others);
        return {};
    }

    ImageOutcome outcome_of(size_t index) const {
        const ListedImage& image = images()[index];
        return {image, poses_.list().views[image.view]};
    }

    /// In      request: of the image
    Result<void> note(const RenderRequest& request, const ImageOutcome& outcome) {
        return manifest_ ? manifest_->add(manifest_line(request, outcome)) : Result<void>();
    }

    /// A failure of one image of a list is kept for the end.
    Result<void> render_and_note(size_t index) {
        const Stopwatch making;
        MadeImage made{outcome_of(index)};
        Log& log = index == 0 ? job_.log : later_.begin();
        job_.unwritten.reset();
        job_.leaves_files = may_write_beside(index);
        Result<void> done =
            with_memory(log, [&](Log& own) { return render_one(index, own, made); });
        if (!done) done = fail(at_its_view(std::move(done.error()), made.outcome.view));
        if (has_ended_) return done;  // by the image before: of this one there is nothing
        made.outcome.seconds = making.seconds();
        made.outcome.warnings = log.warnings();
        if (auto before = finish_beside(); !before) return before;
        if (done && job_.unwritten) {
            write_beside(std::move(made));
            return {};
        }
        const Result<void> noted = note_end(job_.request, made.outcome, done);
        return done && !noted ? noted : conclude(made, done);
    }

    /// Tells the manifest how an image ended.
    Result<void> note_end(const RenderRequest& request,
                          ImageOutcome& outcome,
                          const Result<void>& done) {
        if (!done) outcome.error = told_error(done.error());
        return note(request, outcome);
    }

    /// Counts an image that is written or has failed. Out: an error that ends the rest.
    Result<void> conclude(const MadeImage& made, const Result<void>& done) {
        const ListedImage& image = made.outcome.image;
        if (done) {
            ++job_.rendered;
            if (image.label.empty()) return {};
            if (job_.renderer) job_.renderer->statistics().frames.push_back(made.figures);
            job_.log.info(fmt::format(
                "{} is written, {} of {}", image.label, job_.rendered + job_.skipped, asked_));
            return {};
        }
        const Error& error = done.error();
        const bool goes_on =
            job_.request.lists.is_asked() && job_.renderer && error.code != ExitCode::stopped_early;
        if (!goes_on) return done;
        failures_.add(image, error, job_.log);
        if (!job_.unwritten) job_.watch.begin_preparing();
        return {};
    }

    Result<void> render_one(size_t index, Log& log, MadeImage& made) {
        if (auto loaded = poses_.load_once(); !loaded) return loaded;
        if (job_.request.lists.is_asked()) {
            auto writable = check_image_files(poses_.whole(), {images()[index]});
            if (!writable) return writable;
        }
        if (index != 0) poses_.tell_again(log);
        if (job_.facts.empty()) find_facts(job_);
        const RenderStatistics& statistics = job_.renderer->statistics();
        const RenderStatistics before = statistics;
        Result<ChosenCamera> camera = poses_.look(index, is_last_pose(index), log);
        if (camera && job_.hooks.aim)
            camera = job_.hooks.aim(*job_.renderer, job_.request, *camera, log);
        if (!camera) return fail(camera.error());
        made.outcome.camera = *camera;
        if (job_.kept.read_ahead) job_.kept.read_ahead(job_.threads);
        if (camera->ev100 || job_.is_exposed) {  // it changes the display
            if (auto written = finish_beside(); !written) return written;
        }
        const auto done = make_image(job_, *camera, turn_of(index), log, progress_);
        if (!done) return done;
        if (!job_.unwritten) job_.watch.begin_preparing();
        made.figures = frame_statistics(made.outcome.image, before, statistics);
        return {};
    }

    /// Whether an image's files are written while the next one is rendered. Where that may be cut
    /// short, or others look at the files, they are written at once.
    bool may_write_beside(size_t index) const {
        const RenderRequest& request = job_.request;
        const LongRun& run = request.long_run;
        const bool is_simple = job_.parts == nullptr && !request.part && !is_followed(request);
        return is_simple && job_.threads > 1 && index != last_ && !run.time_limit_s &&
               !run.skips_existing;
    }

    /// Begins to write the files of the image that is finished.
    void write_beside(MadeImage&& made) {
        job_.watch.begin_writing_beside();
        job_.watch.begin_preparing();
        beside_.reset(new WrittenBeside{std::move(made),
                                        job_.request,
                                        std::move(*job_.unwritten),
                                        job_.renderer->take_film_charge()});
        job_.unwritten.reset();
        const auto write = [this, image = beside_.get()] {
            const EndOfWriting end{job_.watch};
            return write_and_note(*image);
        };
        try {
            beside_->done = std::async(std::launch::async, write);
        } catch (const std::system_error&) {  // there is no thread: it is done when waited for
            beside_->done = std::async(std::launch::deferred, write);
        }
    }

    /// In a thread of its own.
    Result<void> write_and_note(WrittenBeside& image) {
        const ThreadArena arena(job_.threads);
        const Stopwatch writing;
        Log log = noting_log(job_.log.verbosity(), image.notes);
        Result<void> done =
            write_outputs(image.request, image.finished, job_.display, job_.watch.stop(), log);
        if (!done && done.error().id == "E-STOPPED") done.error().message.clear();
        MadeImage& made = image.made;
        made.figures.write_s = writing.seconds();
        made.outcome.seconds += made.figures.write_s;
        for (const std::string& warning : log.warnings())
            made.outcome.warnings.push_back(warning);
        image.noted = note_end(image.request, made.outcome, done);
        return done;
    }

    /// Waits for the files that are being written. Out: an error that ends the rest.
    Result<void> finish_beside() {
        if (!beside_) return {};
        const std::unique_ptr<WrittenBeside> image = std::move(beside_);
        const Result<void> done = image->done.get();
        RepeatedLog repeated(job_.log, SettingNames::options);
        image->notes.tell(repeated.begin());
        write_beside_s_ += image->made.figures.write_s;
        if (job_.renderer) job_.renderer->recycle(std::move(image->finished.image));
        const Result<void> concluded =
            done && !image->noted ? image->noted : conclude(image->made, done);
        has_ended_ = !concluded;
        return concluded;
    }

    /// With locks nobody knows which image comes last, unless there is one only.
    bool may_come_back() const {
        return job_.request.long_run.skips_existing && images().size() > 1;
    }

    bool is_last_pose(size_t index) const {
        return turn_of(index).is_last && !job_.request.lists.keeps_asset;
    }

    Turn turn_of(size_t index) const {
        const size_t done = job_.rendered + job_.skipped + failures_.count() + (beside_ ? 1 : 0);
        return {done, asked_, index == 0, index == last_ && !may_come_back()};
    }

    Job& job_;
    Progress& progress_;
    ListedPoses poses_;
    RepeatedLog later_;
    std::optional<Manifest> manifest_;
    std::unique_ptr<WrittenBeside> beside_;  ///< the image before, which has not been counted yet
    std::vector<ListedImage> of_others_;
    ImageFailures failures_;
    bool has_ended_ = false;  ///< an image's files, written beside the next one, ended the rest
    double write_beside_s_ = 0;
    size_t asked_ = 0;  ///< number of images that this command is to render
    size_t last_ = 0;   ///< of them, the index of the last one
};

}  // namespace

Result<void> render_all(Job& job, Progress& progress) {
    const Result<void> done = FrameRun(job, progress).run();
    if (done) progress.finish();
    return done;
}

}  // namespace obscura::app
