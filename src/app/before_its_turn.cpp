// app/before_its_turn.cpp - does something with a rendering before its turn, without a word.
// SPDX-License-Identifier: Apache-2.0
#include "app/before_its_turn.h"

#include "app/listed_poses.h"
#include "app/memory_option.h"
#include "app/render_request.h"
#include "base/parallel.h"

#include <set>
#include <string>

namespace obscura::app {

Result<void> do_before_its_turn(const SceneRun& run,
                                KeptForLater& kept,
                                const std::function<Result<void>(Job&)>& act) {
    RenderRequest request = run.request;
    request.lists.keeps_asset = true;
    Log unheard(Verbosity::quiet);
    // Nothing can be lost: signals and the time limit end the program at once.
    Watch watch(request.scene.string(), unheard, {request.long_run.time_limit_s, {}, {}});
    const ThreadLimit threads(request.threads);
    Result<void> done = start_threads_ahead();
    if (done) done = use_memory_limit(request.max_memory, memory_bound());
    if (done) done = read_named_files(request, unheard);
    if (!done) return done;
    Job job{.log = unheard,
            .whole = request,
            .request = request,
            .options = run.options,
            .watch = watch,
            .kept = kept,
            .hooks = run.hooks};
    std::set<std::string> told;  // environments of which somebody has heard
    for (const auto& [key, environment] : kept.environments) {
        if (environment.notes.is_told()) told.insert(key);
    }
    done = act(job);
    const bool lacks_memory = !done && done.error().code == ExitCode::out_of_memory;
    if (lacks_memory && give_back(kept)) {
        job.renderer.reset();
        job.asset_notes = {};
        done = act(job);
    }
    job.asset_notes.forget_telling();
    for (auto& [key, environment] : kept.environments) {
        if (!told.contains(key)) environment.notes.forget_telling();
    }
    if (done) leave_asset(job);
    watch.end();
    return done;
}

}  // namespace obscura::app
