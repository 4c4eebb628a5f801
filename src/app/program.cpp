// app/program.cpp - the program `obscura`: finds the subcommand and runs it.
// SPDX-License-Identifier: Apache-2.0
#include "app/program.h"

#include "app/batch_command.h"
#include "app/bench_options.h"
#include "app/command_line.h"
#include "app/config_file.h"
#include "app/crosscheck_options.h"
#include "app/dataset_options.h"
#include "app/denoise_options.h"
#include "app/explain_pixel_options.h"
#include "app/info_options.h"
#include "app/merge_command.h"
#include "app/outcome.h"
#include "app/print_docs.h"
#include "app/render_options.h"
#include "app/serve_options.h"
#include "app/signals.h"
#include "base/memory_limit.h"
#include "bench/machine.h"
#include "image/oiio.h"
#include "image/process_settings.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::app {

namespace {

constexpr const char* notes = R"(
Examples:
  obscura helmet.glb
      writes helmet.png
  obscura render helmet.glb --env sky.hdr -o helmet.exr -o helmet.png
  obscura batch job.json
  obscura dataset mug.glb --count 500 --write bop,coco -o mugs
  obscura view helmet.glb
  obscura serve --root products
  obscura denoise helmet.exr -o clean.exr
  obscura merge helmet.exr.*-of-4.film
  obscura info helmet.glb --json
  obscura bench helmet.glb --json helmet.json
  obscura crosscheck helmet.glb --rays 10M
  obscura explain-pixel helmet.glb 640,360 -o pixel.svg

`obscura help COMMAND` explains a command's options.)";

/// The texts of all subcommands' options.
struct Arguments {
    RenderArguments render;
    BatchArguments batch;
    DatasetArguments dataset;
    ServeArguments serve;
    ServeArguments view;
    DenoiseArguments denoise;
    MergeArguments merge;
    InfoArguments info;
    BenchArguments bench;
    CrosscheckArguments crosscheck;
    ExplainPixelArguments explain_pixel;
    PrintDocsArguments print_docs;
    OptionText config;
};

Program describe(Arguments& arguments) {
    Program program;
    program.name = "obscura";
    program.summary =
        "Renders glTF 2.0 assets by path tracing, to scene-linear EXR and to images for displays.";
    program.notes = notes;
    program.version = "obscura " OBSCURA_VERSION "\nEmbree " OBSCURA_EMBREE_VERSION
                      "\ncompiled by " +
                      bench::compiler_name();
    program.commands = {render_command(arguments.render),
                        batch_command(arguments.batch),
                        dataset_command(arguments.dataset),
                        serve_command(arguments.serve),
                        view_command(arguments.view),
                        denoise_command(arguments.denoise),
                        merge_command(arguments.merge),
                        info_command(arguments.info),
                        bench_command(arguments.bench),
                        crosscheck_command(arguments.crosscheck),
                        explain_pixel_command(arguments.explain_pixel)};
    for (Command& command : program.commands)
        command.options.push_back(config_option(arguments.config));
    program.commands.push_back(print_docs_command(arguments.print_docs, program));
    return program;
}

/// The words after the program's name, with short forms written out: a scene alone is rendered to
/// a picture to look at, and `help COMMAND` is `COMMAND --help`.
std::vector<const char*> full_words(int argc,
                                    char** argv,
                                    const Program& program,
                                    Arguments& arguments) {
    std::vector<const char*> words(argv, argv + argc);
    if (argc < 2) return words;
    const std::string first = argv[1];
    std::string ending = std::filesystem::path(first).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    if (first == "help") {
        words.erase(words.begin() + 1);
        const auto is_asked_about = [&](const Command& command) {
            return command.name == std::string_view(words[1]);
        };
        if (argc == 2 ||
            std::any_of(program.commands.begin(), program.commands.end(), is_asked_about))
            words.push_back("--help");
    } else if (!first.starts_with('-') && (ending == ".glb" || ending == ".gltf")) {
        words.insert(words.begin() + 1, "render");
        arguments.render.default_ending = ".png";
    }
    return words;
}

/// However the command ends.
struct AtTheEnd {
    AtTheEnd() = default;
    ~AtTheEnd() { wait_for_oiio(); }
    AtTheEnd(const AtTheEnd&) = delete;
    AtTheEnd& operator=(const AtTheEnd&) = delete;
};

}  // namespace

int run_program(int argc, char** argv) {
    const AtTheEnd waits_for_libraries;
    ignore_broken_pipes();
    own_process_settings();
    spare_addresses();
    Arguments arguments;
    const Program program = describe(arguments);
    const std::vector<const char*> words = full_words(argc, argv, program, arguments);
    const Result<CommandLine> line =
        parse_command_line(program, static_cast<int>(words.size()), words.data());
    if (!line) return report_failure(line.error(), TerminalLog());
    if (line->command) return line->command->run();
    std::fputs(line->text.c_str(), stdout);
    return 0;
}

}  // namespace obscura::app
