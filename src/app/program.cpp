// app/program.cpp - the program `obscura`: finds the subcommand and runs it.
// SPDX-License-Identifier: Apache-2.0
#include "app/program.h"

#include "app/bench_command.h"
#include "app/bench_options.h"
#include "app/crosscheck_command.h"
#include "app/crosscheck_options.h"
#include "app/explain_pixel_command.h"
#include "app/explain_pixel_options.h"
#include "app/info_command.h"
#include "app/numbers.h"
#include "app/outcome.h"
#include "app/render_command.h"
#include "app/render_options.h"
#include "app/signals.h"
#include "bench/machine.h"
#include "image/plugins.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

namespace {

constexpr const char* examples = R"(
Examples:
  obscura render helmet.glb --env sky.hdr -o helmet.exr -o helmet.png
  obscura info helmet.glb --json
  obscura bench helmet.glb --json helmet.json
  obscura crosscheck helmet.glb --rays 10M
  obscura explain-pixel helmet.glb 640,360 -o pixel.svg

`obscura COMMAND --help` explains a command's options.)";

std::string version_text() {
    return "obscura " OBSCURA_VERSION "\nEmbree " OBSCURA_EMBREE_VERSION "\ncompiled by " +
           compiler_name();
}

/// Steps that turn one word into the other, at most `limit` of them.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row[b.size()];
}

/// " (did you mean --spp?)" when an option of the command is close to what was typed.
std::string suggestion(const CLI::App& command, const std::string& typed) {
    const std::string word = typed.substr(0, typed.find('='));
    std::string best;
    size_t best_distance = 3;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            const size_t distance = edit_distance(word, "--" + name);
            if (distance < best_distance) {
                best_distance = distance;
                best = name;
            }
        }
    }
    return best.empty() ? "" : " (did you mean --" + best + "?)";
}

int report_usage(const std::string& where, const std::string& message) {
    const Log log;
    return report_failure(Error{ExitCode::usage, "E-USAGE", where, message}, log);
}

/// The option that has too few or too many values, "" for any other complaint. The parser's text
/// begins with its name.
std::string option_of(const CLI::ParseError& error) {
    const std::string text = error.what();
    const bool counts = error.get_name() == "ArgumentMismatch";
    return counts ? text.substr(0, text.find_first_of(": ")) : "";
}

/// Words a parser's complaint about the command line.
int report_parse_error(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    if (chosen.empty()) {
        const std::vector<std::string> extras = app.remaining();
        const std::string got =
            extras.empty() ? "no command was given" : in_quotes(extras.front()) + " is no command";
        return report_usage("command-line",
                            got +
                                "; expected `obscura render SCENE`, `obscura info SCENE`, "
                                "`obscura bench`, `obscura crosscheck` or `obscura explain-pixel "
                                "SCENE X,Y`, see `obscura --help`");
    }
    const CLI::App& command = *chosen.front();
    const std::string hint = "; `obscura " + command.get_name() + " --help` lists what is accepted";
    const std::vector<std::string> extras = command.remaining();
    if (extras.empty()) {
        const std::string option = option_of(error);
        if (option.empty()) return report_usage("command-line", error.what() + hint);
        return report_usage(option, "expected the option once, with one value" + hint);
    }
    const std::string& first = extras.front();
    if (first.size() > 1 && first[0] == '-') {
        return report_usage(first, "there is no such option" + suggestion(command, first) + hint);
    }
    return report_usage("command-line", in_quotes(first) + " is one argument too many" + hint);
}

}  // namespace

int run_program(int argc, char** argv) {
    ignore_broken_pipes();
    ignore_plugin_paths();
    CLI::App app("Renders glTF 2.0 assets to scene-linear EXR, PNG and JPEG by path tracing.",
                 "obscura");
    app.set_version_flag("--version", version_text(), "Print versions and exit");
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.require_subcommand(1);
    app.footer(examples);
    RenderArguments render_arguments;
    CLI::App* render = app.add_subcommand("render", "Render a scene to EXR, PNG or JPEG");
    add_render_options(*render, render_arguments);
    InfoArguments info_arguments;
    CLI::App* info = app.add_subcommand("info", "Print what a scene file holds");
    add_info_options(*info, info_arguments);
    BenchArguments bench_arguments;
    CLI::App* bench = app.add_subcommand("bench", "Measure how fast scenes render");
    add_bench_options(*bench, bench_arguments);
    CrosscheckArguments crosscheck_arguments;
    CLI::App* crosscheck =
        app.add_subcommand("crosscheck", "Check intersections against Embree and in double");
    add_crosscheck_options(*crosscheck, crosscheck_arguments);
    ExplainPixelArguments explain_arguments;
    CLI::App* explain =
        app.add_subcommand("explain-pixel", "Print and draw how one pixel comes about");
    add_explain_pixel_options(*explain, explain_arguments);
    for (CLI::App* command : {render, info, bench, crosscheck, explain}) {
        command->get_formatter()->column_width(28);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::fputs(app.help().c_str(), stdout);
        return 0;
    } catch (const CLI::CallForVersion&) {
        std::printf("%s\n", version_text().c_str());
        return 0;
    } catch (const CLI::ParseError& error) {
        return report_parse_error(app, error);
    }
    if (bench->parsed()) return run_bench(bench_arguments);
    if (crosscheck->parsed()) return run_crosscheck(crosscheck_arguments);
    if (explain->parsed()) return run_explain_pixel(explain_arguments);
    return render->parsed() ? run_render(render_arguments) : run_info(info_arguments);
}

}  // namespace obscura
