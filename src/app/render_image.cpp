// app/render_image.cpp - makes and writes one image or part, and keeps what is finished meanwhile.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_job.h"
#include "base/stopwatch.h"
#include "camera/exposure.h"
#include "image/fingerprint.h"
#include "render/counts.h"
#include "render/integrators.h"
#include "session/dark_image.h"
#include "session/denoising.h"
#include "session/film_keeper.h"
#include "session/fingerprint.h"

#include <cmath>
#include <fmt/format.h>

namespace obscura::app {

namespace {

/// An image that is being made.
struct Making {
    Job& job;
    const ChosenCamera& camera;
    const Turn& turn;
    Log& log;
    DisplayServer* viewer = nullptr;  ///< null: nobody looks on
    FilmKeeper* keeper = nullptr;     ///< null: nothing is kept before the end
    RenderHooks hooks = {};
};

/// What a viewer calls an image: not as it calls the file when it opens that, too.
std::string shown_name(const RenderRequest& request) {
    const std::string file =
        request.outputs.empty() ? standard_output_name : request.outputs.front().generic_string();
    if (!is_part_of_image(request)) return file + " (rendering)";
    const FilmPart& part = *request.part;
    return fmt::format("{} (rendering {} of {})", file, part.index + 1, part.count);
}

/// The head of a film state of this image.
FilmStateHead head_of(const Job& job) {
    FilmStateHead head;
    if (is_part_of_image(job.request)) head.part = *job.request.part;
    if (takes_passes(job.request)) head.target_samples = samples_taken(job.request.options);
    head.is_adaptive = job.request.options.adaptive.has_value();
    if (!job.request.long_run.has_checkpoint && !is_part_of_image(job.request)) return head;
    head.options = job.options;
    head.facts = job.facts;
    for (const auto& fact : job.image_facts) {
        if (fact.first != "the first frame") head.facts.push_back(fact);
    }
    return head;
}

std::string percent(double fraction) {
    return fmt::format("{:.1f} %", 100 * fraction);
}

/// What a stop leaves behind, for messages.
std::string note_of(const Making& making) {
    const std::string file = making.keeper != nullptr ? making.keeper->file_if_kept() : "";
    if (file.empty()) return "";
    return fmt::format("{} holds {} of the picture: the same command carries on from there",
                       file,
                       percent(making.keeper->saved_fraction()));
}

/// Writes a checkpoint with `save`. That it cannot be written does not end a rendering.
template <typename Save>
void try_to_save(const Making& making, bool& has_failed, const Save& save) {
    const Result<bool> saved = save();
    if (saved && *saved) {
        making.log.detail("checkpoint: " + percent(making.keeper->saved_fraction()));
    } else if (!saved && !has_failed) {
        making.log.warn(saved.error().where,
                        "no checkpoint: " + saved.error().message + "; rendering goes on");
    }
    has_failed = has_failed || !saved;
}

/// Marks an image of which pixels or samples are missing.
void mark_unfinished(const FilmKeeper& keeper, FinishedImage& image) {
    image.metadata.extra.push_back({"obscura:done", keeper.fraction()});
    if (const FilmSums* const sums = keeper.sums())
        image.metadata.extra.push_back({"obscura:samplesDone", sums->mean_samples()});
}

/// Renders no half images in which the denoiser would see the noise: they are not there yet.
void leave_undenoised(RenderRequest& request, Film& film) {
    request.denoise = false;
    remove_denoising_layers(request.options, film);
}

/// Marks a finished image with what it was made from.
void mark_finished(const Job& job, FinishedImage& image) {
    image.metadata.extra.push_back({std::string(fingerprint_name),
                                    image_fingerprint(job.options, job.facts, job.image_facts)});
}

/// Writes the image so far, while it is being rendered; undenoised, as that may take long.
Result<void> write_snapshot(const Making& making) {
    std::optional<Film> film = making.keeper->film_so_far();
    if (!film) return {};
    RenderRequest request = making.job.request;
    request.standard_output.reset();
    request.write_retries = 0;  // there will be another one, and checkpoints must not wait
    leave_undenoised(request, *film);
    RenderedFilm rendered{request.options, {}};
    rendered.result.film = std::move(*film);
    FinishedImage finished =
        making.job.renderer->finish(request, making.camera, std::move(rendered), making.log);
    mark_unfinished(*making.keeper, finished);
    Log unheard;  // the image itself will say the same
    const auto& stop = making.job.watch.stop();
    return write_outputs(request, finished, making.job.display, stop, unheard);
}

/// What is in a checkpoint, which no tile will be finished of.
Result<std::vector<FilmArea>> fill(const Making& making, Film& film) {
    Result<std::vector<FilmArea>> filled = making.keeper->fill(film);
    if (!filled || making.viewer == nullptr) return filled;
    const ImagePart origin = film.part_of.value_or(ImagePart{});
    for (const FilmArea& area : *filled)
        making.viewer->add(film, {area.x + origin.x, area.y + origin.y, area.width, area.height});
    return filled;
}

/// What is done beside rendering; `has_failed` must outlive it.
Watch::Tasks tasks_of(const Making& making, bool& has_failed) {
    Watch::Tasks out;
    const LongRun& run = making.job.request.long_run;
    if (run.has_checkpoint) {
        out.save = [&making, &has_failed] {
            try_to_save(making, has_failed, [&] { return making.keeper->save_meanwhile(); });
        };
    }
    if (run.snapshot_interval_s) {
        out.snapshot = [&making, warned = false]() mutable {
            const Result<void> written = write_snapshot(making);
            if (written || warned || written.error().id == "E-STOPPED") return;
            warned = true;
            making.log.warn(written.error().where, "no snapshot: " + written.error().message);
        };
    }
    return out;
}

/// Renders the film, with a checkpoint at the end where much would be lost.
Result<RenderedFilm> render_film(Making& making) {
    Job& job = making.job;
    FilmKeeper* const keeper = making.keeper;
    bool has_failed = false;
    const auto begin_rendering = [&] {
        job.watch.begin_rendering(keeper != nullptr ? tasks_of(making, has_failed)
                                                    : Watch::Tasks());
    };
    FilmShare share;
    if (is_part_of_image(job.request)) share.part = job.request.part;
    if (keeper != nullptr) {
        if (!share.part) share.part = FilmPart{};
        const auto begin = [&](const auto& take_checkpoint) {
            job.watch.begin_reading();
            auto taken = take_checkpoint();
            begin_rendering();
            return taken;
        };
        share.fill = [&, begin](Film& film) { return begin([&] { return fill(making, film); }); };
        share.begin_passes = [&, begin](const PassFilm& film) {
            return begin([&] { return keeper->begin_passes(film); });
        };
        const bool writes_sums = is_part_of_samples(job.request);
        share.wants_film = [=] { return !writes_sums && received_stop_signal() == 0; };
        share.shows_early = shows_early(job.request);
        share.leave = [&](const Film& /*film*/) { keeper->leave(); };
        share.keeps_unfinished = true;
    }
    if (share.part) making.hooks.share = &share;
    begin_rendering();
    Result<RenderedFilm> film = job.renderer->render_film(job.request, making.camera, making.hooks);
    if (film && keeper != nullptr) {
        const RenderResult& result = film->result;
        const double much_s = first_checkpoint_s(job.request.long_run.checkpoint_interval_s);
        const bool is_kept = job.request.long_run.keep_checkpoint;
        // Who ends the program waits for one checkpoint: what was written when the signal came, or
        // just before, is enough.
        constexpr double just_before_s = 1;
        const bool has_saved =
            received_stop_signal() != 0 && keeper->seconds_since_save() < just_before_s;
        if (!has_saved && (result.is_stopped || is_kept || result.render_seconds >= much_s))
            try_to_save(making, has_failed, [&] { return keeper->save(result.film); });
        add_counters(keeper->resumed_counters(), job.renderer->statistics().counters);
        add_counters(keeper->resumed_counters(), film->result.counters);
    }
    if (job.watch.begin_finishing()) return film;
    return fail(ExitCode::stopped_early, "E-STOPPED", "render", "stopped on request");
}

/// Says so when there are fewer blocks of samples than parts.
void tell_of_no_samples(const FilmStateHead& head, const FilmSums& sums, Log& log) {
    if (sums.target() > 0) return;
    log.info(fmt::format("part {} of {} has no samples: {} make {} blocks of {}",
                         head.part.index + 1,
                         head.part.count,
                         head.target_samples,
                         (head.target_samples - 1) / static_cast<int>(sum_block_samples) + 1,
                         sum_block_samples));
}

/// Writes a part's file.
Result<void> write_part(const Making& making, const RenderResult& result) {
    const RenderRequest& request = making.job.request;
    const std::filesystem::path file = part_file(request.outputs.front(), *request.part);
    FilmStateHead head = head_of(making.job);
    head.counters = counters_in_file(result.counters);
    head.areas = areas_of_part(result.film.width, result.film.height, head.part);
    if (head.part.of == PartOf::rows) {
        head.target_samples = 0;  // it holds pixels, also where checkpoints hold sums
        return write_film_state(file, head, result.film);
    }
    const FilmSums& sums = *making.keeper->sums();
    tell_of_no_samples(head, sums, making.log);
    return write_film_sums(file, head, result.film, [&](StateWriter& out) { sums.put(out); });
}

/// Why a film so far lacks one of the half images that the denoiser needs, of as many samples each;
/// "": it has both.
std::string lack_of_halves(const FilmKeeper& keeper, const RenderOptions& options) {
    const FilmSums* const sums = keeper.sums();
    if (sums == nullptr) return "";
    const size_t both = 2 * halves_run(options);
    if (static_cast<size_t>(sums->target()) % both != 0) {
        return fmt::format("with --spp {}, which is no multiple of {}, that takes all samples",
                           sums->target(),
                           sum_block_samples);
    }
    const size_t least =
        options.adaptive ? static_cast<size_t>(options.adaptive->min_samples) : both;
    if (static_cast<size_t>(sums->min_samples()) >= least) return "";
    return "there are too few samples to tell their noise";
}

/// Writes all outputs of a film that is finished, or of one of which pixels are missing.
Result<void> write_image(const Making& making, RenderedFilm&& film) {
    Job& job = making.job;
    RenderRequest request = job.request;
    const bool is_unfinished = film.result.is_stopped;
    const bool has_faults = too_many_nonfinite(film.result.counters);
    const std::string lack =
        is_unfinished ? lack_of_halves(*making.keeper, request.options) : std::string();
    if (is_unfinished) {
        film.result.film = making.keeper->finished_of(std::move(film.result.film));
        if (request.denoise && !lack.empty()) {
            making.log.warn(request.scene.string(), "not denoised: " + lack);
            leave_undenoised(request, film.result.film);
        }
    }
    FinishedImage finished =
        job.renderer->finish(request, making.camera, std::move(film), making.log);
    if (making.viewer != nullptr) making.viewer->add(finished.image);
    const double camera_ev =
        making.camera.ev100 ? std::log2(exposure_scale(*making.camera.ev100)) : 0;
    const double exposure_ev = request.display.exposure_ev + camera_ev;
    if (is_unfinished) {
        mark_unfinished(*making.keeper, finished);
        if (!lack.empty()) finished.metadata.extra.push_back(unequal_halves());
    } else if (!has_faults) {
        mark_finished(job, finished);
    }
    if (!is_unfinished && making.turn.is_first) {
        const Scene& scene = job.renderer->scene();
        warn_of_dark_image(finished.image, request, scene, exposure_ev, making.log);
    }
    job.watch.begin_writing();
    const Stopwatch writing;
    Result<void> written;
    if (job.hooks.label && is_unfinished) return {};  // a data set has whole images only
    if (job.hooks.label)
        written = job.hooks.label(
            request, job.renderer->prepared(), making.camera, job.watch.stop(), making.log);
    if (written && job.leaves_files && !is_unfinished) {
        job.renderer->statistics().write_s += writing.seconds();
        job.unwritten = std::move(finished);
        return {};
    }
    if (written)
        written = write_outputs(request, finished, job.display, job.watch.stop(), making.log);
    job.renderer->statistics().write_s += writing.seconds();
    job.renderer->recycle(std::move(finished.image));
    return written;
}

/// The film of all parts.
Result<RenderedFilm> film_of_parts(Making& making) {
    Job& job = making.job;
    if (auto same = job.parts->check_facts(job.facts); !same) return fail(same.error());
    const auto fill = [&](Film& film) -> Result<std::vector<FilmArea>> {
        if (auto filled = job.parts->fill(film); !filled) return fail(filled.error());
        return std::vector<FilmArea>();
    };
    FilmShare share{{}, fill};
    if (job.parts->are_of_samples()) {
        share.part = FilmPart{};
        share.begin_passes = [&](const PassFilm& film) { return job.parts->fill(film); };
    }
    making.hooks.share = &share;
    Result<RenderedFilm> film = job.renderer->render_film(job.request, making.camera, making.hooks);
    if (!film) return film;
    film->result.counters = job.parts->counters();
    add_counters(job.parts->counters(), job.renderer->statistics().counters);
    return film;
}

tl::unexpected<Error> time_is_up(const Making& making) {
    const RenderRequest& request = making.job.request;
    const std::string note = note_of(making);
    const FilmSums* const sums = making.keeper->sums();
    const bool is_black = sums == nullptr && !is_part_of_image(request);
    std::string message = fmt::format("the time limit is over: {} of the picture are rendered{}",
                                      percent(making.keeper->fraction()),
                                      is_black ? ", the rest is black" : "");
    if (sums != nullptr) {
        const char* const of = request.options.adaptive ? "at most " : "";
        message += fmt::format(
            ", {:.1f} of {}{} samples a pixel", sums->mean_samples(), of, sums->target());
    }
    if (!note.empty()) message += "; " + note;
    return fail(ExitCode::stopped_early, "E-TIME-LIMIT", request.scene.string(), message);
}

/// Renders and writes.
Result<void> make(Making& making) {
    Job& job = making.job;
    const bool is_part = is_part_of_image(job.request);
    Result<RenderedFilm> film = job.parts != nullptr ? film_of_parts(making) : render_film(making);
    if (!film) return fail(film.error());
    const bool is_unfinished = film->result.is_stopped && making.keeper->fraction() < 1;
    film->result.is_stopped = is_unfinished;
    if (is_part && is_unfinished) return time_is_up(making);
    if (is_part) job.watch.begin_writing();
    const Result<void> written =
        is_part ? write_part(making, film->result) : write_image(making, std::move(*film));
    if (!written) return written;
    if (is_unfinished) return time_is_up(making);
    if (making.keeper != nullptr && !job.request.long_run.keep_checkpoint) making.keeper->remove();
    return {};
}

}  // namespace

Result<void> expose(Job& job, const ChosenCamera& camera, Log& log) {
    if (job.is_exposed) {  // by the camera of another image
        Result<std::optional<DisplayTransform>> plain = make_display(job.request, log);
        if (!plain) return fail(plain.error());
        job.display = std::move(*plain);
    }
    job.is_exposed = camera.ev100.has_value();
    return expose_display(camera, job.request, job.display, log);
}

Result<void> make_image(
    Job& job, const ChosenCamera& camera, const Turn& turn, Log& log, Progress& progress) {
    const RenderRequest& request = job.request;
    if (auto exposed = expose(job, camera, log); !exposed) return exposed;
    if (!job.has_begun) progress.begin();
    job.has_begun = true;
    const LongRun& run = request.long_run;
    std::optional<FilmKeeper> keeper;
    if (is_followed(request) && job.parts == nullptr) {
        std::optional<std::filesystem::path> file;
        if (run.has_checkpoint) file = checkpoint_file(request);
        keeper.emplace(head_of(job), file);
        if (auto found = keeper->find(run.resume, log); !found) return found;
    }
    DisplayServer* const viewer = job.kept.viewer.get();
    if (viewer != nullptr) viewer->begin_image(shown_name(request));
    Making making{job, camera, turn, log, viewer, keeper ? &*keeper : nullptr};
    making.hooks.stop = &job.watch.stop();
    making.hooks.progress = [&](const FinishedTile& tile) {
        if (keeper) keeper->add(tile);
        if (viewer != nullptr) viewer->add(tile);
        progress.update((static_cast<double>(turn.done) + tile.done) /
                        static_cast<double>(turn.count));
    };
    Result<void> done = make(making);
    if (!done && done.error().id == "E-STOPPED") done.error().message = note_of(making);
    return done;
}

}  // namespace obscura::app
