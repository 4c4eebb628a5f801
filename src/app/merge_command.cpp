// app/merge_command.cpp - the subcommand `obscura merge`: parts of a picture become the picture.
// SPDX-License-Identifier: Apache-2.0
#include "app/merge_command.h"

#include "app/outcome.h"
#include "app/part_options.h"
#include "app/render_command.h"
#include "session/image_parts.h"

namespace obscura::app {

namespace {

constexpr const char* merge_notes = R"(
Carries out the command that rendered the parts, with their pixels in place of rendering: the
outputs have the bits that one process would have written. The scene is read once more, so
run it in the folder where the parts were rendered.

Examples:
  obscura render shot.glb -o shot.exr --part 1/2
  obscura render shot.glb -o shot.exr --part 2/2
  obscura merge shot.exr.*-of-2.film
      writes shot.exr)";

constexpr OptionInfo parts_option = {
    .name = "PART", .help = "Files of all parts, in any order", .files = "film"};
constexpr OptionInfo merged_output_option = {
    .name = "-o,--output",
    .argument = "FILE",
    .help = "File to write in place of the rendering's own outputs; may be given several times",
    .fallback = "as the parts were asked for",
    .files = "exr png jpg jpeg tif tiff webp avif"};
constexpr OptionInfo merge_quiet_option = {.name = "--quiet", .help = "Print errors only"};

int run_merge(const MergeArguments& arguments) {
    const TerminalLog log(arguments.quiet ? Verbosity::quiet : Verbosity::normal);
    if (arguments.parts.empty()) {
        const auto none = conflict("PART", "no part is named; expected all parts of a picture");
        return report_failure(none.value(), log);
    }
    const Result<ImageParts> parts =
        ImageParts::open({arguments.parts.begin(), arguments.parts.end()});
    if (!parts) return report_failure(parts.error(), log);
    RenderArguments render;
    if (auto done = replay_options(parts->options(), render); !done)
        return report_failure(done.error(), log);
    if (!arguments.outputs.empty()) render.outputs = arguments.outputs;
    render.quiet = arguments.quiet;
    return run_render(render, &*parts);
}

}  // namespace

Command merge_command(MergeArguments& arguments) {
    Command command{
        "merge", "Make the picture of parts that `obscura render --part` wrote", merge_notes};
    command.options = {{parts_option, "", &arguments.parts},
                       {merged_output_option, "", &arguments.outputs},
                       {merge_quiet_option, "", &arguments.quiet}};
    command.run = [&arguments] { return run_merge(arguments); };
    return command;
}

}  // namespace obscura::app
