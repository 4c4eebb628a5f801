// app/dataset_command.cpp - the subcommand `obscura dataset`: images with labels from random views.
// SPDX-License-Identifier: Apache-2.0
#include "app/dataset_command.h"

#include "app/outcome.h"
#include "app/part_options.h"
#include "app/render_command.h"

#include "dataset/aim.h"
#include "dataset/write_formats.h"
#include "dataset/write_labels.h"
#include <filesystem>
#include <system_error>

namespace obscura::app {

namespace {

namespace fs = std::filesystem;

/// What a scene's images are rendered and labelled by.
SceneRun run_of(DatasetScene& scene, const dataset::LabelOptions& labels) {
    SceneRun run{std::move(scene.request), options_for_merge(scene.arguments)};
    run.hooks.aim = [](const AssetRenderer& renderer,
                       RenderRequest& request,
                       const ChosenCamera& camera,
                       Log& log) { return dataset::aim(renderer, request, camera, log); };
    run.hooks.label = [labels](const RenderRequest& request,
                               const PreparedScene& prepared,
                               const ChosenCamera& camera,
                               Log& log) {
        return dataset::write_labels(labels, {request, prepared, camera}, log);
    };
    return run;
}

/// The folders of the labels; those of the images are made with these.
///
/// Errors  73 E-OUT-CREATE
Result<void> make_folders(const dataset::Dataset& dataset) {
    for (const dataset::SceneFolder& scene : dataset.scenes) {
        std::vector<const char*> folders = {
            dataset::depth_folder, dataset::segmentation_folder, dataset::labels_folder};
        if (dataset.formats.bop)
            folders.insert(folders.end(), {dataset::mask_folder, dataset::visible_mask_folder});
        for (const char* folder : folders) {
            std::error_code error;
            fs::create_directories(scene.folder / folder, error);
            if (!error) continue;
            return fail(ExitCode::cannot_create,
                        "E-OUT-CREATE",
                        (scene.folder / folder).string(),
                        "the folder cannot be made: " + error.message());
        }
    }
    return {};
}

}  // namespace

int run_dataset(const DatasetArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    Result<DatasetRequest> request = make_dataset_request(arguments);
    if (!request) return report_failure(request.error(), log);
    const dataset::Dataset& dataset = request->dataset;
    std::vector<SceneRun> runs;
    for (size_t i = 0; i < request->scenes.size(); ++i) {
        runs.push_back(
            run_of(request->scenes[i],
                   {dataset.scenes[i].folder, dataset.formats.bop, request->depth_unit_mm}));
    }
    if (arguments.dry_run) return run_scenes(runs, dataset.root.string(), log);
    if (auto made = make_folders(dataset); !made) return report_failure(made.error(), log);
    return run_scenes(
        runs, dataset.root.string(), log, [&] { return dataset::write_formats(dataset, log); });
}

}  // namespace obscura::app
