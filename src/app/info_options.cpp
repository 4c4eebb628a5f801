// app/info_options.cpp - the table of the options of `obscura info`.
// SPDX-License-Identifier: Apache-2.0
#include "app/info_options.h"

#include "app/option_readers.h"
#include "gltf/load.h"

namespace obscura::app {

namespace {

using A = InfoArguments;
using Entry = OptionEntry<A, gltf::LoadOptions>;

constexpr const char* notes = R"(
Reads the whole file and checks it, but decodes no image; see `obscura render --help` for
the exit codes.

Examples:
  obscura info helmet.glb
  obscura info helmet.glb --json | jq .triangles_in_world
      warnings and the closing RESULT line go to standard error, never into the JSON
  obscura info helmet.glb --explain
      what the file asks for, part by part: honoured, approximated (how), ignored (why))";

// clang-format off
constexpr Entry entries[] = {
    {{.name = "SCENE", .help = "glTF 2.0 file, .gltf or .glb", .files = "gltf glb"},
     text_at<&A::scene_file>},
    {{.name = "--json", .help = "Print JSON instead of a table"}, text_at<&A::json>},
    {{.name = "--scene", .argument = "NAME|INDEX", .help = "Scene of a file that holds several",
      .fallback = "the file's default"},
     text_at<&A::scene>},
    {{.name = "--variant", .argument = "NAME", .help = "Look of a product",
      .fallback = "the file's own materials"},
     text_at<&A::variant>},
    {{.name = "--explain",
      .help = "Print what becomes of every extension and feature, part by part"},
     text_at<&A::explain>},
    {{.name = "--lenient", .help = "Make do with faults as `obscura render --lenient` does"},
     text_at<&A::lenient>, flag_at<&gltf::LoadOptions::lenient>},
    {{.name = "--quiet", .help = "Print no warnings"}, text_at<&A::quiet>}};
// clang-format on

constexpr OptionGroup<A, gltf::LoadOptions> groups[] = {{"", entries}};

}  // namespace

Command info_command(InfoArguments& arguments) {
    Command command{"info", "Print what a scene file holds", notes};
    command.options =
        bind_all(std::span<const OptionGroup<A, gltf::LoadOptions>>(groups), arguments);
    command.run = [&arguments] { return run_info(arguments); };
    return command;
}

}  // namespace obscura::app
