// app/serve_options.cpp - the tables of the options of `obscura serve` and `obscura view`.
// SPDX-License-Identifier: Apache-2.0
#include "app/serve_options.h"

#include "app/memory_option.h"
#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/serve_command.h"

#include <array>

namespace obscura::app {

namespace {

using A = ServeArguments;
using R = ServeRequest;
using S = serve::ServerOptions;
using J = serve::JobsOptions;
using Entry = OptionEntry<A, R>;

constexpr const char* serve_notes = R"(
Serves a page for a browser, and an API for programs (docs/serve.md). The first line of standard
output is the page's address, with the token that it needs. Ctrl-C ends the server.

Examples:
  obscura serve --root products
      the page lists the models in products; others may be dropped on it
  obscura serve --listen 0.0.0.0 --token "$TOKEN" --root /srv/assets
      for other machines that know the token, in a network that can be trusted: it is plain HTTP)";

constexpr const char* view_notes = R"(
Opens a page in the browser that shows the model, and refines while one looks: `obscura serve` for
the model's folder, at a free port. Without a display it only prints the page's address.

Example:
  obscura view helmet.glb)";

// clang-format off
constexpr Entry entries[] = {
    {{.name = "--root", .argument = "DIR",
      .help = "A folder whose models and environments clients may name, with those below it. May "
              "be given several times",
      .fallback = "the folder where the command runs", .files = "/"},
     text_at<&A::roots>},
    {{.name = "--listen", .argument = "ADDRESS",
      .help = "Address of this machine to listen at. Beyond the machine itself it needs --token"},
     text_at<&A::listen>, name_at<&R::server, &S::address>},
    {{.name = "--port", .argument = "N", .help = "Port; 0 is one that is free",
      .range = {0, 65535}},
     text_at<&A::port>, number_at<&R::server, &S::port>},
    {{.name = "--token", .argument = "TEXT", .help = "What clients must know",
      .fallback = "a random one", .excludes = {"--no-token"}},
     text_at<&A::token>},
    {{.name = "--no-token",
      .help = "Every program on this machine may use the server; pages of other sites still may "
              "not"},
     text_at<&A::no_token>},
    {{.name = "--max-upload", .argument = "SIZE",
      .help = "The largest file that clients may send, and the most that is kept of all of them: "
              "where it is too little, the oldest go",
      .fallback = "1G"},
     text_at<&A::max_upload>, parsed_at<parse_memory_size, &R::max_upload>},
    {{.name = "--jobs", .argument = "DIR",
      .help = "A folder for the jobs of clients, which keeps their files when the server ends",
      .fallback = "a temporary one", .files = "/"},
     text_at<&A::jobs>},
    {{.name = "--jobs-at-once", .argument = "N",
      .help = "Jobs that run at the same time; the others wait", .range = {1, 64}},
     text_at<&A::jobs_at_once>, number_at<&R::server, &S::jobs, &J::at_once>}};

constexpr Entry view_entries[] = {
    {{.name = "MODEL", .help = "The model, a .gltf or .glb file", .files = "gltf glb"},
     text_at<&A::file>},
    {{.name = "--no-browser", .help = "Only print the page's address"},
     text_at<&A::no_browser>}};
// clang-format on

constexpr ServeOptionGroup groups[] = {{"", entries}};
constexpr ServeOptionGroup view_groups[] = {{"", view_entries}};

/// Options of `obscura render` that all pictures get.
constexpr std::array common_options = {"--threads",
                                       "--priority",
                                       "--max-memory",
                                       "--texture-memory",
                                       "--texture-cache",
                                       "--isa",
                                       "--ocio",
                                       "--quiet",
                                       "--verbose"};

void add_options(Command& command, ServeArguments& arguments) {
    for (BoundOption& option : bind_all(serve_option_groups(), arguments))
        command.options.push_back(std::move(option));
    for (const char* name : common_options)
        add_render_option(command, arguments.render, name, "Program");
}

}  // namespace

std::span<const ServeOptionGroup> serve_option_groups() {
    return groups;
}

Command serve_command(ServeArguments& arguments) {
    Command command{"serve", "Serve a preview page and an API for programs", serve_notes};
    add_options(command, arguments);
    command.run = [&arguments] { return run_serve(arguments); };
    return command;
}

Command view_command(ServeArguments& arguments) {
    Command command{"view", "Show a model in the browser", view_notes};
    command.options = bind_all(std::span<const ServeOptionGroup>(view_groups), arguments);
    add_options(command, arguments);
    command.run = [&arguments] { return run_view(arguments); };
    return command;
}

}  // namespace obscura::app
