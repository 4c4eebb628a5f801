// app/info_command.cpp - the subcommand `obscura info`.
// SPDX-License-Identifier: Apache-2.0
#include "app/info_command.h"

#include "app/explain_report.h"
#include "app/info_report.h"
#include "app/outcome.h"
#include "app/scene_choice.h"
#include "gltf/load.h"

namespace obscura::app {

namespace {

std::string report_text(const InfoArguments& arguments, const Scene& scene, const Log& log) {
    if (arguments.explain) {
        return arguments.json ? explain_json(scene.info) : explain_table(scene.info);
    }
    return arguments.json ? info_json(scene, log.warnings()) : info_table(scene);
}

}  // namespace

int run_info(const InfoArguments& arguments) {
    TerminalLog log(arguments.quiet ? Verbosity::quiet : Verbosity::normal);
    Result<gltf::LoadOptions> options = choose_scene(arguments.scene, arguments.variant);
    if (!options) return report_failure(options.error(), log);
    options->info_only = true;
    options->lenient = arguments.lenient;
    const Result<Scene> scene = gltf::load_gltf(arguments.scene_file, *options, log);
    if (!scene) return report_failure(scene.error(), log);
    const Result<void> printed = print_output(report_text(arguments, *scene, log));
    if (!printed) return report_failure(printed.error(), log);
    return report_success(arguments.scene_file, log);
}

}  // namespace obscura::app
