// app/denoise_options.cpp - the table of the options of `obscura denoise`.
// SPDX-License-Identifier: Apache-2.0
#include "app/denoise_options.h"

#include "app/denoise_command.h"
#include "app/option_readers.h"
#include "app/render_options.h"

namespace obscura::app {

namespace {

using A = DenoiseArguments;
using R = DenoiseRequest;
using Entry = OptionEntry<A, R>;

constexpr const char* notes = R"(
IN.exr is from `obscura render --denoising-data`, of the layouts single or multipart. An EXR keeps
everything else that is in it, bit for bit.

Examples:
  obscura render room.glb --spp 16 --denoising-data -o room.exr
  obscura denoise room.exr -o clean.exr -o clean.png
  obscura denoise room.exr -o room.exr --keep-noisy
      in place, whole or not at all
  obscura denoise shot.####.exr --frames 1-48 -o clean.####.exr
      each frame with the help of those beside it, by the layer motion)";

// clang-format off
constexpr Entry entries[] = {
    {{.name = "IN.exr", .help = "EXR that `obscura render` wrote", .files = "exr"},
     text_at<&A::file>},
    {{.name = "-o,--output", .argument = "FILE",
      .help = "File to write: .exr like IN.exr, which it may replace; .png, .jpg, .tif, .webp or "
              ".avif for a display. May be given several times",
      .files = "exr png jpg jpeg tif tiff webp avif"},
     text_at<&A::outputs>},
    {{.name = "--keep-noisy",
      .help = "Keep the beauty as it was in the layer noisy of the EXR"},
     text_at<&A::keep_noisy>}};
// clang-format on

constexpr OptionGroup<A, R> groups[] = {{"", entries}};

}  // namespace

Command denoise_command(DenoiseArguments& arguments) {
    Command command{"denoise", "Take the noise out of an EXR that render wrote", notes};
    command.options = bind_all(std::span<const OptionGroup<A, R>>(groups), arguments);
    RenderArguments& render = arguments.render;
    BoundOption& frames = add_render_option(command, render, "--frames", "Sequence");
    frames.info.help =
        "Denoise a sequence, such as 1-48: the ### in all names become each frame's "
        "number. Frames beside a frame help where IN.exr has the layer motion";
    frames.info.excludes = {};
    constexpr const char* display = "Display (all but EXR)";
    add_render_group(command, render, display);
    BoundOption& space = add_render_option(command, render, "--color-space", display);
    space.info.help = "The linear space of the colours in IN.exr, where its header does not say:";
    space.fallback = "as its header says";
    add_render_option(command, render, "--threads", "Program");
    add_render_option(command, render, "--quiet", "Program");
    add_render_option(command, render, "--verbose", "Program");
    command.run = [&arguments] { return run_denoise(arguments); };
    return command;
}

}  // namespace obscura::app
