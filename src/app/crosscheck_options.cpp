// app/crosscheck_options.cpp - the options of `obscura crosscheck`.
// SPDX-License-Identifier: Apache-2.0
#include "app/crosscheck_options.h"

#include "app/asset_choice.h"
#include "app/option_group.h"
#include "app/render_options.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace obscura {

namespace {

constexpr const char* examples = R"(
Ends with exit code 0 when everything is within the budget of docs/crosscheck.md, 1 otherwise.

Examples:
  obscura crosscheck
      the project's own scenes
  obscura crosscheck helmet.glb --rays 10M --json helmet.json --image helmet.png
      a hundred million rays through closed meshes, ten million compared and spawned
  obscura crosscheck helmet.glb --ray 0.1,0.2,3,0,0,-1
      what every kernel says about one ray
  obscura crosscheck helmet.glb --export-embree out
      beside the pictures of Embree's own viewer)";

void add_check_options(CLI::App& command, CrosscheckArguments& arguments) {
    OptionGroup group(command, "Check");
    group.text("--rays",
               arguments.rays,
               "N",
               "Rays that are compared, such as 250k or 10M; as many\n"
               "are spawned and ten times as many look for leaks [1M]");
    group.text("--ray",
               arguments.ray,
               "RAY",
               "ox,oy,oz,dx,dy,dz: ask every kernel about this one ray\n"
               "and print the answers");
    group.text("--size", arguments.render.size, "WxH", "Picture of the camera's rays [640x360]");
    group.text("--seed", arguments.render.seed, "N", "Random numbers; equal seeds, equal rays [0]");
    group.text("--threads", arguments.render.threads, "N", "0 is every core [0]");
    group.text("--isa",
               arguments.render.isa,
               "NAME",
               "Instruction set of the renderer's own queries: auto,\n"
               "baseline, avx2, avx512; Embree's are all checked [auto]");
    add_assets_option(group, arguments.assets);
}

void add_report_options(CLI::App& command, CrosscheckArguments& arguments) {
    OptionGroup group(command, "Report");
    group.text("--json", arguments.json, "FILE", "Write all figures as JSON");
    group.text("--image",
               arguments.image,
               "FILE.png",
               "Draw where on the screen answers differ from the truth");
    group.text("--export-embree",
               arguments.export_embree,
               "DIR",
               "Write what Embree's tutorial programs read and compare\n"
               "with their viewer's pictures where it is installed");
    group.flag("--quiet", arguments.render.quiet, "Print the tables and errors only");
    group.flag("--verbose", arguments.render.verbose, "Print more notes");
}

}  // namespace

void add_crosscheck_options(CLI::App& command, CrosscheckArguments& arguments) {
    command.add_option("SCENE", arguments.scenes, "glTF 2.0 files [those in the assets folder]")
        ->type_name("");
    add_check_options(command, arguments);
    add_report_options(command, arguments);
    add_camera_options(command, arguments.render);
    add_fault_options(command, arguments.render);
    command.footer(examples);
}

}  // namespace obscura
