// app/explain_pixel_options.cpp - the table of the options of `obscura explain-pixel`.
// SPDX-License-Identifier: Apache-2.0
#include "app/explain_pixel_options.h"

#include "app/option_readers.h"
#include "app/render_options.h"

namespace obscura::app {

namespace {

using A = ExplainPixelArguments;
using R = ExplainRequest;
using Entry = OptionEntry<A, R>;

constexpr const char* notes = R"(
Prints the ray through the pixel's middle, what it meets with all numbers of the formulas, and the
light sum of `obscura render --integrator raycast`, whose pixel it is. docs/lecture.md explains the
formulas.

Examples:
  obscura explain-pixel helmet.glb 640,360
  obscura explain-pixel room.gltf 12,34 --size 320x240 --camera Door -o pixel.svg
      also draws the plane that holds the ray and the normal
  obscura explain-pixel helmet.glb 640,360 --json | jq .seen)";

// clang-format off
constexpr Entry places[] = {
    {{.name = "SCENE", .help = "glTF 2.0 file, .gltf or .glb", .files = "gltf glb"},
     text_at<&A::render, &RenderArguments::scene_file>},
    {{.name = "PIXEL", .help = "X,Y: a pixel, counted from 0 at the top left corner"},
     text_at<&A::pixel>}};

constexpr Entry report[] = {
    {{.name = "-o,--output", .argument = "FILE.svg",
      .help = "Draw the plane that holds the ray and the normal: cross sections of the objects in "
              "it, a numbered dot at each place that is met, the normal N, the directions L of the "
              "lights",
      .fallback = "no drawing", .files = "svg"},
     text_at<&A::output>},
    {{.name = "--json", .help = "Print JSON instead of text"},
     text_at<&A::json>, flag_at<&R::json>},
    {{.name = "--objects", .argument = "N",
      .help = "Objects near the ray that are listed, those that are met first",
      .range = {1, 100000}},
     text_at<&A::objects>, number_at<&R::max_objects>}};
// clang-format on

constexpr OptionGroup<A, R> groups[] = {{"", places}, {"Report", report}};

}  // namespace

std::span<const OptionGroup<A, R>> explain_pixel_option_groups() {
    return groups;
}

Command explain_pixel_command(ExplainPixelArguments& arguments) {
    Command command{"explain-pixel", "Print and draw how one pixel comes about", notes};
    command.options = bind_all(explain_pixel_option_groups(), arguments);
    RenderArguments& render = arguments.render;
    add_render_option(command, render, "--quiet", "Report").info.help =
        "Print the report and errors only";
    add_render_option(command, render, "--verbose", "Report");
    for (const char* name : {"--size", "--background", "--point-size", "--line-width"})
        add_render_option(command, render, name, "");
    for (const char* name : {"--scene", "--variant", "--time", "--animation", "--threads", "--isa"})
        add_render_option(command, render, name, "Scene");
    add_render_group(command, render, "Camera");
    add_lens_groups(command, render);
    add_render_group(command, render, "Light");
    add_render_option(command, render, "--strict", "");
    add_render_option(command, render, "--lenient", "");
    command.run = [&arguments] { return run_explain_pixel(arguments); };
    return command;
}

}  // namespace obscura::app
