// app/explain_pixel_options.cpp - the options of `obscura explain-pixel`.
// SPDX-License-Identifier: Apache-2.0
#include "app/explain_pixel_options.h"

#include "app/lens_options.h"
#include "app/option_group.h"
#include "app/render_options.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace obscura {

namespace {

constexpr const char* examples = R"(
Prints the ray through the pixel's middle, what it meets with all numbers of the formulas, and the
light sum of `obscura render --integrator raycast`, whose pixel it is. docs/lecture.md explains the
formulas.

Examples:
  obscura explain-pixel helmet.glb 640,360
  obscura explain-pixel room.gltf 12,34 --size 320x240 --camera Door -o pixel.svg
      also draws the plane that holds the ray and the normal
  obscura explain-pixel helmet.glb 640,360 --json | jq .seen)";

void add_report_options(CLI::App& command, ExplainPixelArguments& arguments) {
    OptionGroup group(command, "Report");
    group.text("-o,--output",
               arguments.output,
               "FILE.svg",
               "Draw the ray, what it meets, the normal and the lights");
    group.flag("--json", arguments.json, "Print JSON instead of text");
    group.text("--objects", arguments.objects, "N", "Objects near the ray that are listed [16]");
    group.flag("--quiet", arguments.render.quiet, "Print the report and errors only");
    group.flag("--verbose", arguments.render.verbose, "Print more notes");
}

void add_picture_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Picture");
    group.text("--size", arguments.size, "WxH", "Width and height in pixels [1280x720]");
    group.text("--background",
               arguments.background,
               "KIND",
               "What rays that hit nothing see: env, transparent, or\n"
               "a linear colour R,G,B [env]");
    group.text("--point-size", arguments.point_size, "LENGTH", "Diameter of glTF's points [3px]");
    group.text("--line-width", arguments.line_width, "LENGTH", "Diameter of glTF's lines [2px]");
}

void add_scene_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Scene");
    group.text("--scene",
               arguments.scene,
               "NAME|INDEX",
               "Scene of a file that holds several [the file's default]");
    group.text("--variant", arguments.variant, "NAME", "Look of a product [the file's own]");
    group.text("--time", arguments.time, "SECONDS", "Time of the animation [as stored]");
    group.text("--animation", arguments.animation, "NAME|INDEX", "Which one plays [the first]");
    group.text("--threads", arguments.threads, "N", "Threads, 0 to 1024; 0 is every core [0]");
    group.text(
        "--isa", arguments.isa, "NAME", "Instruction set: auto, baseline, avx2, avx512 [auto]");
}

}  // namespace

void add_explain_pixel_options(CLI::App& command, ExplainPixelArguments& arguments) {
    command.add_option("SCENE", arguments.render.scene_file, "glTF 2.0 file, .gltf or .glb")
        ->type_name("")
        ->required();
    command
        .add_option("PIXEL", arguments.pixel, "X,Y: a pixel, counted from 0 at the top left corner")
        ->type_name("")
        ->required();
    add_report_options(command, arguments);
    add_picture_options(command, arguments.render);
    add_scene_options(command, arguments.render);
    add_camera_options(command, arguments.render);
    add_lens_options(command, arguments.render.lens);
    add_light_options(command, arguments.render);
    add_fault_options(command, arguments.render);
    command.footer(examples);
}

}  // namespace obscura
