// app/bench_options.cpp - the options of `obscura bench`.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_options.h"

#include "app/asset_choice.h"
#include "app/option_group.h"
#include "app/render_options.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace obscura {

namespace {

constexpr const char* examples = R"(
"Of bare Embree" is the time in which Embree alone answers the rays of a rendering, as a share
of the time of that rendering: 100 % is the limit. See docs/cli.md for every figure.

Examples:
  obscura bench
      the project's own scenes, whole and close
  obscura bench helmet.glb --env sky.hdr --json now.json --compare before.json
      says which figures have changed and which of that is noise
  obscura bench helmet.glb --threads 1,2,4,8 --isa all --plot scaling.svg
  obscura bench helmet.glb --integrator normal
      camera rays only)";

void add_measurement_options(CLI::App& command, BenchArguments& arguments) {
    OptionGroup group(command, "Measurement");
    group.text("--size",
               arguments.render.size,
               "WxH",
               "Width and height in pixels [640x360; 1920x1080 for\n"
               "quantities, which take one sample a pixel]");
    group.text("--view",
               arguments.view,
               "NAME",
               "whole: the file's camera or all in view; close: at least\n"
               "70 % of the frame covered; both [both]");
    group.text("--repeat", arguments.repeat, "N", "Times that each figure is measured [5]");
    group.text("--threads",
               arguments.threads,
               "LIST",
               "Thread counts, such as 1,2,4: the greatest for the main\n"
               "figures, all for the table of scaling; 0: every core [0]");
    group.text("--isa",
               arguments.isa,
               "LIST",
               "Instruction sets: auto, baseline, avx2, avx512 or all; the\n"
               "first for the main figures, all for a table [auto]");
    add_assets_option(group, arguments.assets);
}

void add_report_options(CLI::App& command, BenchArguments& arguments) {
    OptionGroup group(command, "Report");
    group.text("--json", arguments.json, "FILE", "Write all figures as JSON");
    group.text("--compare",
               arguments.compare,
               "OLD.json",
               "Say which figures changed since that report, and which of\n"
               "it is noise");
    group.text(
        "--plot", arguments.plot, "FILE.svg", "Draw the tables of --threads and --isa as a chart");
    group.flag("--quiet", arguments.render.quiet, "Print the tables and errors only");
    group.flag("--verbose", arguments.render.verbose, "Print more notes");
}

}  // namespace

void add_bench_options(CLI::App& command, BenchArguments& arguments) {
    command.add_option("SCENE", arguments.scenes, "glTF 2.0 files [those in the assets folder]")
        ->type_name("");
    add_measurement_options(command, arguments);
    add_report_options(command, arguments);
    add_sampling_options(command, arguments.render, "4");
    add_camera_options(command, arguments.render);
    add_light_options(command, arguments.render);
    add_fault_options(command, arguments.render);
    command.footer(examples);
}

}  // namespace obscura
