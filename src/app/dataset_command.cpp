// app/dataset_command.cpp - the subcommand `obscura dataset`: images with labels from random views.
// SPDX-License-Identifier: Apache-2.0
#include "app/dataset_command.h"

#include "app/outcome.h"
#include "app/part_options.h"
#include "app/render_command.h"

#include "dataset/aim.h"
#include "dataset/write_formats.h"
#include "dataset/write_labels.h"
#include <fmt/format.h>
#include <memory>

namespace obscura::app {

namespace {

/// What a scene's images are rendered and labelled by.
SceneRun run_of(DatasetScene& scene, const dataset::LabelOptions& options) {
    SceneRun run{std::move(scene.request), options_for_merge(scene.arguments)};
    // Labels are parts of images: where these options change, images are made again.
    if (options.writes_masks) run.options.emplace_back("--write", "bop");
    if (options.depth_unit_mm)
        run.options.emplace_back("--depth-unit", fmt::format("{}", *options.depth_unit_mm));
    const auto writer = std::make_shared<dataset::LabelWriter>(options);
    run.hooks.aim =
        [](AssetRenderer& renderer, RenderRequest& request, const ChosenCamera& camera, Log& log) {
            return dataset::aim(renderer, request, camera, log);
        };
    run.hooks.label = [writer](const RenderRequest& request,
                               const PreparedScene& prepared,
                               const ChosenCamera& camera,
                               const std::atomic<bool>& stop,
                               Log& log) {
        return writer->write({request, prepared, camera, stop}, log);
    };
    run.hooks.has_label = [writer](const ListedImage& image) {
        return writer->has_written(image.outputs.front());
    };
    return run;
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
    return run_scenes(
        runs, dataset.root.string(), log, [&] { return dataset::write_formats(dataset, log); });
}

}  // namespace obscura::app
