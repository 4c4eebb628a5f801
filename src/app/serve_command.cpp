// app/serve_command.cpp - the subcommands `obscura serve` and `obscura view`.
// SPDX-License-Identifier: Apache-2.0
#include "app/serve_command.h"

#include "app/memory_option.h"
#include "app/outcome.h"
#include "app/signals.h"
#include "base/memory_limit.h"
#include "base/parallel.h"
#include "base/priority.h"
#include "image/oiio.h"

#include <cstdlib>
#include <fcntl.h>
#include <memory>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <thread>

namespace obscura::app {

namespace {

/// Tells the desktop to open a page; where there is none, nothing happens.
void open_in_browser(const std::string& url) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
    std::string program = "xdg-open", address = url;
    char* const words[] = {program.data(), address.data(), nullptr};
    posix_spawn_file_actions_t quietly;
    posix_spawn_file_actions_init(&quietly);
    for (const int descriptor : {0, 1, 2})
        posix_spawn_file_actions_addopen(&quietly, descriptor, "/dev/null", O_RDWR, 0);
    pid_t child = 0;
    const int failure = posix_spawnp(&child, words[0], &quietly, nullptr, words, environ);
    posix_spawn_file_actions_destroy(&quietly);
    if (failure == 0) std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
}

int serve(const Result<ServeRequest>& request, Log& log) {
    if (!request) return report_failure(request.error(), log);
    give_back_freed_memory();
    const Result<RenderRequest> common =
        request->server.service.options.request("none", serve::Options::object());
    if (!common) return report_failure(common.error(), log);
    if (auto set = use_memory_limit(common->max_memory, memory_bound()); !set)
        return report_failure(set.error(), log);
    if (common->gives_way) give_way_to_others();
    const ThreadLimit threads(common->threads);
    if (auto begun = start_threads_ahead(); !begun) return report_failure(begun.error(), log);
    const StopOnSignal signals;
    Result<std::unique_ptr<serve::Server>> server = serve::Server::listen(request->server);
    if (!server) return report_failure(server.error(), log);
    const std::string url = (*server)->url(request->file);
    if (auto printed = print_output(url + "\n"); !printed)
        return report_failure(printed.error(), log);
    open_oiio_ahead();  // textures will need it
    if (request->opens_browser) open_in_browser(url);
    (*server)->run(signals.flag());
    return report_success(request->server.address, log);
}

}  // namespace

int run_serve(const ServeArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    return serve(make_serve_request(arguments), log);
}

int run_view(const ServeArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    ServeArguments texts = arguments;
    if (!texts.port) texts.port = "0";
    Result<ServeRequest> request = make_serve_request(texts);
    if (request) request->opens_browser = !arguments.no_browser;
    return serve(request, log);
}

}  // namespace obscura::app
