// app/other_parts.cpp - files of renderings that other parts of a command make.
// SPDX-License-Identifier: Apache-2.0
#include "app/other_parts.h"

#include "app/distinct_files.h"
#include "session/image_names.h"

#include <algorithm>

namespace obscura::app {

namespace {

std::vector<NameShape> shapes_of(const RenderRequest& request) {
    NameFields fields;
    fields.asset = asset_name(request);
    fields.look = request.lists.look;
    std::vector<NameShape> out;
    for (const std::filesystem::path& pattern : patterns_of(request))
        out.emplace_back(pattern, fields);
    return out;
}

bool may_share_files(const std::vector<NameShape>& a, const std::vector<NameShape>& b) {
    return std::any_of(a.begin(), a.end(), [&](const NameShape& one) {
        return std::any_of(
            b.begin(), b.end(), [&](const NameShape& other) { return one.may_equal(other); });
    });
}

void note_files_of(const SceneRun& run, KeptForLater& kept) {
    Log unheard(Verbosity::quiet);
    RenderRequest request = run.request;
    Watch watch(request.scene.string(), unheard, {});
    if (!read_named_files(request, unheard)) return;
    Job job{.log = unheard,
            .whole = request,
            .request = request,
            .options = run.options,
            .watch = watch,
            .kept = kept};
    (void)note_all_files(job);
    watch.end();
}

}  // namespace

void note_files_of_other_parts(const std::vector<SceneRun>& runs, KeptForLater& kept) {
    std::vector<std::vector<NameShape>> shapes;
    for (const SceneRun& run : runs)
        shapes.push_back(shapes_of(run.request));
    for (size_t i = 0; i < runs.size(); ++i) {
        if (!runs[i].is_of_another_part) continue;
        bool may_share = false;
        for (size_t later = i + 1; later < runs.size() && !may_share; ++later)
            may_share =
                !runs[later].is_of_another_part && may_share_files(shapes[i], shapes[later]);
        if (!may_share) continue;
        kept.run = SIZE_MAX - 1 - i;  // a number that no rendering of this part has
        note_files_of(runs[i], kept);
    }
}

}  // namespace obscura::app
