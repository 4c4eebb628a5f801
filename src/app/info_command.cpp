// app/info_command.cpp - the subcommand `obscura info`.
// SPDX-License-Identifier: Apache-2.0
#include "app/info_command.h"

#include "app/explain_report.h"
#include "app/info_report.h"
#include "app/outcome.h"
#include "app/scene_choice.h"
#include "gltf/load.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace obscura {

namespace {

constexpr const char* examples = R"(
Reads the whole file and checks it, but decodes no image; see `obscura render --help` for
the exit codes.

Examples:
  obscura info helmet.glb
  obscura info helmet.glb --json | jq .triangles_in_world
      warnings and the closing RESULT line go to standard error, never into the JSON
  obscura info helmet.glb --explain
      what the file asks for, part by part: honoured, approximated (how), ignored (why))";

std::string report_text(const InfoArguments& arguments, const Scene& scene, const Log& log) {
    if (arguments.explain) {
        return arguments.json ? explain_json(scene.info) : explain_table(scene.info);
    }
    return arguments.json ? info_json(scene, log.warnings()) : info_table(scene);
}

}  // namespace

void add_info_options(CLI::App& command, InfoArguments& arguments) {
    command.add_option("SCENE", arguments.scene_file, "glTF 2.0 file, .gltf or .glb")
        ->type_name("")
        ->required();
    command.add_flag("--json", arguments.json, "Print JSON instead of a table");
    const auto store = [&arguments](const std::string& given) { arguments.scene = given; };
    command
        .add_option_function<std::string>(
            "--scene", store, "Scene of a file that holds several [the file's default]")
        ->type_name("NAME|INDEX");
    const auto store_variant = [&arguments](const std::string& given) {
        arguments.variant = given;
    };
    command
        .add_option_function<std::string>(
            "--variant", store_variant, "Look of a product [the file's own materials]")
        ->type_name("NAME");
    command.add_flag("--explain",
                     arguments.explain,
                     "Print what becomes of every extension and feature, part by part");
    command.add_flag(
        "--lenient", arguments.lenient, "Make do with faults as `obscura render --lenient` does");
    command.add_flag("--quiet", arguments.quiet, "Print no warnings");
    command.footer(examples);
}

int run_info(const InfoArguments& arguments) {
    Log log(arguments.quiet ? Verbosity::quiet : Verbosity::normal);
    Result<LoadOptions> options = choose_scene(arguments.scene, arguments.variant);
    if (!options) return report_failure(options.error(), log);
    options->info_only = true;
    options->lenient = arguments.lenient;
    const Result<Scene> scene = load_gltf(arguments.scene_file, *options, log);
    if (!scene) return report_failure(scene.error(), log);
    const Result<void> printed = print_output(report_text(arguments, *scene, log));
    if (!printed) return report_failure(printed.error(), log);
    return report_success(arguments.scene_file, log);
}

}  // namespace obscura
