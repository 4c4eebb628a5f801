// app/exposure_groups.cpp - --exposure auto: one exposure for the images of a group.
// SPDX-License-Identifier: Apache-2.0
#include "app/exposure_groups.h"

#include "app/before_its_turn.h"
#include "app/listed_poses.h"
#include "app/numbers.h"
#include "camera/exposure.h"
#include "session/exposure_meter.h"
#include "session/preview.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace obscura::app {

namespace {

constexpr size_t metered_images = 4;  ///< of a run

/// One look of all assets, unless the group has a name.
std::string group_of(const RenderRequest& request) {
    if (!request.exposure_group->empty()) return "the group " + *request.exposure_group;
    return "the look " + request.lists.look;
}

/// Meters the image that is begun and posed.
Result<void> meter_image(Job& job,
                         const ChosenCamera& camera,
                         Log& log,
                         std::vector<double>& stops) {
    const RenderRequest small = metering_image(job.request);
    const Result<ChosenCamera> again = job.renderer->look_again(small, log);
    if (!again) return fail(again.error());
    const Result<RenderedFilm> film = job.renderer->render_film(small, *again, {});
    if (!film) return fail(film.error());
    const std::optional<double> light = metered_stops(film->result.film);
    if (!light) return {};
    const double camera_ev = camera.ev100 ? std::log2(exposure_scale(*camera.ev100)) : 0;
    stops.push_back(*light + camera_ev);
    return {};
}

/// Meters images of a run.
Result<void> meter_images(Job& job, Log& log, std::vector<double>& stops) {
    ListedPoses poses(job);
    if (auto listed = poses.find_images(log); !listed) return listed;
    const size_t count = poses.list().images.size();
    const size_t metered = std::min(count, metered_images);
    for (size_t i = 0; i < metered; ++i) {
        const size_t index = i * count / metered;
        poses.begin_image(index);
        if (auto loaded = poses.load_once(); !loaded) return loaded;
        Result<ChosenCamera> camera = poses.look(index, false, log);
        if (camera && job.hooks.aim)
            camera = job.hooks.aim(*job.renderer, job.request, *camera, log);
        if (!camera) return fail(camera.error());
        if (auto done = meter_image(job, *camera, log, stops); !done) return done;
    }
    return {};
}

/// What is metered of a run; nothing after an error.
std::vector<double> meter(const SceneRun& run, KeptForLater& kept) {
    std::vector<double> stops;
    if (needs_preview(run.request.options.integrator)) return stops;
    // Also once more: the number must not depend on the memory that others left.
    const Result<void> done = do_before_its_turn(run, kept, [&](Job& job) {
        stops.clear();
        return meter_images(job, job.log, stops);
    });
    if (!done) stops.clear();
    return stops;
}

void use_exposure(double exposure_ev, SceneRun& run) {
    run.request.display.exposure_ev = exposure_ev;
    for (auto& [option, text] : run.options) {
        if (option == "--exposure") text = shortest(exposure_ev);
    }
}

}  // namespace

void meter_exposures(std::vector<SceneRun>& runs, KeptForLater& kept, Log& log) {
    std::map<std::string, std::vector<double>> groups;
    for (const SceneRun& run : runs) {
        const RenderRequest& request = run.request;
        if (!request.exposure_group || request.check || request.lists.lists_only) continue;
        const std::vector<double> stops = meter(run, kept);
        std::vector<double>& all = groups[group_of(request)];
        all.insert(all.end(), stops.begin(), stops.end());
    }
    for (const auto& [group, stops] : groups) {
        const double exposure_ev = stops.empty() ? 0 : exposure_for(stops);
        for (SceneRun& run : runs) {
            if (run.request.exposure_group && group_of(run.request) == group)
                use_exposure(exposure_ev, run);
        }
        if (stops.empty()) {
            log.warn("--exposure", group + " shows nothing that can be metered: it is 0");
        } else {
            log.info(fmt::format("the exposure of {} is {}, metered in {} small images",
                                 group,
                                 shortest(exposure_ev),
                                 stops.size()));
        }
    }
}

}  // namespace obscura::app
