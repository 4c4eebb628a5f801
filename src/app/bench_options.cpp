// app/bench_options.cpp - the table of the options of `obscura bench`.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_options.h"

#include "app/asset_choice.h"
#include "app/bench_command.h"
#include "app/option_readers.h"
#include "app/render_options.h"

namespace obscura::app {

namespace {

using A = BenchArguments;
using R = BenchRequest;
using Entry = OptionEntry<A, R>;

constexpr const char* notes = R"(
"Of bare Embree" is the time in which Embree alone answers the rays of a rendering, as a share
of the time of that rendering: 100 % is the limit. See docs/cli.md for every figure.

Examples:
  obscura bench
      the project's own scenes, whole and close
  obscura bench helmet.glb --env sky.hdr --json now.json --compare before.json
      says which figures have changed and which of that is noise
  obscura bench helmet.glb --threads 1,2,4,8 --isa all --plot scaling.svg
  obscura bench --standard --json score.json
      a score by docs/scores.md
  obscura bench helmet.glb --integrator normal
      camera rays only)";

constexpr std::array<Choice<ViewChoice>, 3> views = {
    {{"whole", ViewChoice::whole}, {"close", ViewChoice::close}, {"both", ViewChoice::both}}};

// clang-format off
constexpr Entry scenes[] = {
    {{.name = "SCENE", .help = "glTF 2.0 files", .fallback = "those in the assets folder",
      .files = "gltf glb"},
     text_at<&A::scenes>}};

constexpr Entry measurement[] = {
    {{.name = "--standard",
      .help = "Measure three scenes that the program makes, and give a score to compare and to "
              "publish; with --threads, --isa (one each), --json and --compare alone"},
     text_at<&A::standard>, flag_at<&R::standard>},
    {{.name = "--view", .argument = "NAME",
      .help = "whole: the file's camera or all in view; close: at least 70 % of the frame covered; "
              "both",
      .excludes = {"--eye", "--target", "--up"}},
     text_at<&A::view>, choice_at<views, &R::views>},
    {{.name = "--repeat", .argument = "N",
      .help = "Times that each figure is measured; medians are reported", .range = {1, 1000}},
     text_at<&A::repeat>, number_at<&R::repeat>},
    {{.name = "--threads", .argument = "N[,N]",
      .help = "Thread counts, such as 1,2,4: the greatest for the main figures, all for the table "
              "of scaling; 0: every core",
      .fallback = "0"},
     text_at<&A::threads>, parsed_at<parse_thread_counts, &R::threads>},
    {{.name = "--isa", .argument = "NAME[,NAME]",
      .help = "Instruction sets: auto, baseline, avx2, avx512 or all; the first for the main "
              "figures, all for a table",
      .fallback = "auto"},
     text_at<&A::isa>,
     {.read = read_parsed<parse_isas, &R::isas>, .names = choice_names<instruction_sets>}},
    {assets_option, text_at<&A::assets>}};

constexpr Entry report[] = {
    {{.name = "--json", .argument = "FILE", .help = "Write all figures as JSON", .files = "json"},
     text_at<&A::json>, name_at<&R::json>},
    {{.name = "--compare", .argument = "OLD.json",
      .help = "Say which figures changed since that report, and which of it is noise",
      .files = "json"},
     text_at<&A::compare>, name_at<&R::compare>},
    {{.name = "--plot", .argument = "FILE.svg",
      .help = "Draw the tables of --threads and --isa as a chart", .files = "svg"},
     text_at<&A::plot>, name_at<&R::plot>}};
// clang-format on

constexpr OptionGroup<A, R> groups[] = {
    {"", scenes}, {"Measurement", measurement}, {"Report", report}};

}  // namespace

std::span<const OptionGroup<A, R>> bench_option_groups() {
    return groups;
}

Command bench_command(BenchArguments& arguments) {
    Command command{"bench", "Measure how fast scenes render", notes};
    command.options = bind_all(bench_option_groups(), arguments);
    RenderArguments& render = arguments.render;
    add_render_option(command, render, "--size", "Measurement").fallback =
        size_text(bench_size) + "; " + size_text(bench_aov_size) +
        " for AOVs, which take one sample a pixel";
    add_render_option(command, render, "--quiet", "Report").info.help =
        "Print the tables and errors only";
    add_render_option(command, render, "--verbose", "Report");
    add_render_group(command, render, "Sampling");
    for (BoundOption& option : command.options) {
        if (long_name(option.info) != "--spp") continue;
        option.info.argument = "N";
        option.info.help = "Samples per pixel";
        option.fallback = bench_spp;
    }
    add_render_group(command, render, "Camera");
    add_render_group(command, render, "Light");
    add_render_option(command, render, "--strict", "");
    add_render_option(command, render, "--lenient", "");
    command.run = [&arguments] { return run_bench(arguments); };
    return command;
}

}  // namespace obscura::app
