// app/crosscheck_options.cpp - the table of the options of `obscura crosscheck`.
// SPDX-License-Identifier: Apache-2.0
#include "app/crosscheck_options.h"

#include "app/asset_choice.h"
#include "app/crosscheck_command.h"
#include "app/option_readers.h"
#include "app/render_options.h"

namespace obscura::app {

namespace {

using A = CrosscheckArguments;
using R = CrosscheckRequest;
using Entry = OptionEntry<A, R>;

constexpr const char* notes = R"(
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

// clang-format off
constexpr Entry scenes[] = {
    {{.name = "SCENE", .help = "glTF 2.0 files", .fallback = "those in the assets folder",
      .files = "gltf glb"},
     text_at<&A::scenes>}};

constexpr Entry check[] = {
    {{.name = "--rays", .argument = "N",
      .help = "Rays that are compared, such as 250k, 10M or 1G; as many are spawned and ten times "
              "as many look for leaks. 48 bytes each are kept",
      .fallback = "1M"},
     text_at<&A::rays>, parsed_at<parse_count, &R::rays>},
    {{.name = "--ray", .argument = "OX,OY,OZ,DX,DY,DZ[,END]",
      .help = "Ask every kernel about this one ray and print the answers; with an end, in lengths "
              "of its direction, about occlusion",
      .excludes = {"--json", "--image", "--export-embree"}},
     text_at<&A::ray>, parsed_at<parse_ray, &R::ray>},
    {assets_option, text_at<&A::assets>}};

constexpr Entry report[] = {
    {{.name = "--json", .argument = "FILE", .help = "Write all figures as JSON", .files = "json"},
     text_at<&A::json>, name_at<&R::json>},
    {{.name = "--image", .argument = "FILE.png",
      .help = "Draw where on the screen answers differ from the truth: grey agrees, blue equal "
              "depth, green edge, yellow crack or edge-on, red unexplained, black none",
      .files = "png"},
     text_at<&A::image>, name_at<&R::image>},
    {{.name = "--export-embree", .argument = "DIR",
      .help = "Write what Embree's tutorial programs read, mesh.obj and mesh.ecs, and compare with "
              "their viewer's pictures where it is on $PATH",
      .files = "/"},
     text_at<&A::export_embree>, name_at<&R::export_embree>}};
// clang-format on

constexpr OptionGroup<A, R> groups[] = {{"", scenes}, {"Check", check}, {"Report", report}};

}  // namespace

std::span<const OptionGroup<A, R>> crosscheck_option_groups() {
    return groups;
}

Command crosscheck_command(CrosscheckArguments& arguments) {
    Command command{"crosscheck", "Check intersections against Embree and in double", notes};
    command.options = bind_all(crosscheck_option_groups(), arguments);
    RenderArguments& render = arguments.render;
    BoundOption& size = add_render_option(command, render, "--size", "Check");
    size.info.help = "Width and height of the picture of the camera's rays";
    size.fallback = crosscheck_size;
    add_render_option(command, render, "--seed", "Check");
    add_render_option(command, render, "--threads", "Check");
    add_render_option(command, render, "--isa", "Check").info.help =
        "Instruction set of the renderer's own queries (Embree's are all checked):";
    add_render_option(command, render, "--quiet", "Report").info.help =
        "Print the tables and errors only";
    add_render_option(command, render, "--verbose", "Report");
    add_render_group(command, render, "Camera");
    add_render_option(command, render, "--strict", "");
    add_render_option(command, render, "--lenient", "");
    command.run = [&arguments] { return run_crosscheck(arguments); };
    return command;
}

}  // namespace obscura::app
