// app/serve_request.cpp - turns the option texts of `obscura serve` into a request.
// SPDX-License-Identifier: Apache-2.0
#include "app/serve_request.h"

#include "app/json_options.h"
#include "app/memory_option.h"
#include "app/render_options.h"
#include "app/serve_jobs.h"
#include "app/serve_options.h"

#include "serve/guard.h"
#include "serve/known_files.h"
#include "serve/option_names.h"
#include <algorithm>
#include <filesystem>
#include <system_error>

namespace obscura::app {

namespace {

namespace fs = std::filesystem;

Result<RenderRequest> image_request(const RenderArguments& common,
                                    const fs::path& scene,
                                    const serve::Options& options) {
    RenderArguments texts = common;
    texts.scene_file = scene.string();
    texts.default_ending = ".png";
    const std::vector<BoundOption> table = bind_all(std::span(render_option_groups()), texts);
    for (const auto& [key, value] : options.items()) {
        const std::string name = "--" + key;
        const BoundOption* const option = find_option(table, name);
        if (option == nullptr || !serve::is_view_option(key)) {
            return fail(
                ExitCode::usage, "E-USAGE", "/options/" + key, "a picture has no such option");
        }
        const std::string expected = set_from_json(*option, value);
        if (!expected.empty())
            return fail(ExitCode::usage, "E-USAGE-CHOICE", "/options/" + key, expected);
    }
    Result<RenderRequest> request = make_render_request(texts);
    if (request && request->exposure_group) {
        return fail(ExitCode::usage,
                    "E-USAGE-CHOICE",
                    "/options/exposure",
                    "expected a number: a view that moves is not metered");
    }
    return request;
}

/// A word as a shell takes it.
std::string quoted_word(const std::string& word) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string out = "'";
    for (const char c : word)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

/// A file's name where a leading - would be taken for an option.
std::string as_file(const std::string& name) {
    return name.starts_with('-') ? "./" + name : name;
}

/// How a file is named from where the server was started. Where a client's own files lie is
/// unknown: an upload has its name alone.
std::string file_word(const std::vector<fs::path>& roots, const std::string& name) {
    if (serve::is_upload(name)) return as_file(fs::path(name).filename().string());
    for (const fs::path& root : roots) {
        std::error_code error;
        if (fs::is_regular_file(root / name, error))
            return as_file((root / name).lexically_normal().string());
    }
    return as_file(name);
}

/// What pictures have in common, whatever clients ask for.
struct ServedFrom {
    std::vector<fs::path> roots;
    std::optional<std::string> ocio;
};

std::string command_line(const ServedFrom& from,
                         const std::string& scene,
                         const serve::Options& options) {
    RenderArguments texts;
    const std::vector<BoundOption> table = bind_all(std::span(render_option_groups()), texts);
    std::string out = "obscura render " + quoted_word(file_word(from.roots, scene));
    if (from.ocio) out += " --ocio " + quoted_word(*from.ocio);
    for (const auto& [key, value] : options.items()) {
        const BoundOption* const option = find_option(table, "--" + key);
        if (option == nullptr) continue;
        const bool is_file = key == "env" && value.is_string();
        const serve::Options shown =
            is_file ? serve::Options(file_word(from.roots, value.get<std::string>())) : value;
        for (const std::string& word : words_from_json(*option, shown))
            out += " " + quoted_word(word);
    }
    const fs::path name = fs::path(scene).stem();
    return out + " -o " + quoted_word(as_file(name.string() + ".png"));
}

Result<void> choose_roots(const ServeArguments& arguments, ServeRequest& request) {
    std::vector<fs::path>& roots = request.server.service.roots;
    for (const std::string& root : arguments.roots)
        roots.emplace_back(root);
    if (!arguments.file.empty()) {
        const fs::path file = arguments.file;
        std::error_code error;
        if (!fs::is_regular_file(file, error)) {
            return fail(ExitCode::missing_scene,
                        "E-SCENE-MISSING",
                        file.string(),
                        "expected a .gltf or .glb file");
        }
        request.file = file.filename().string();
        roots.insert(roots.begin(), file.has_parent_path() ? file.parent_path() : fs::path("."));
    } else if (roots.empty()) {
        roots.emplace_back(".");
    }
    for (const fs::path& root : roots) {
        std::error_code error;
        if (fs::is_directory(root, error)) continue;
        return fail(ExitCode::usage, "E-SERVE-ROOT", root.string(), "expected a folder");
    }
    return {};
}

Result<void> choose_token(const ServeArguments& arguments, serve::ServerOptions& server) {
    if (!serve::is_loopback(server.address) && !arguments.token) {
        return conflict("--listen",
                        "others reach this address: choose a --token that only those know who may "
                        "use this machine");
    }
    if (arguments.token && arguments.token->empty())
        return conflict("--token", "the text is empty; --no-token is for none");
    const auto is_refused = [](char c) { return c <= ' ' || c > '~' || c == '%'; };
    if (arguments.token &&
        std::any_of(arguments.token->begin(), arguments.token->end(), is_refused))
        return conflict("--token",
                        "expected letters, digits and signs of ASCII, without spaces and %");
    if (!arguments.no_token) server.token = arguments.token.value_or(serve::random_token());
    return {};
}

}  // namespace

serve::OptionReader image_options(const RenderArguments& common,
                                  const std::vector<fs::path>& roots) {
    const ServedFrom from{roots, common.ocio};
    return {[common](const fs::path& scene, const serve::Options& options) {
                return image_request(common, scene, options);
            },
            [from](const std::string& scene, const serve::Options& options) {
                return command_line(from, scene, options);
            }};
}

Result<ServeRequest> make_serve_request(const ServeArguments& arguments) {
    ServeArguments texts = arguments;
    const Command command = serve_command(texts);
    if (auto fit = check_combinations(command.options); !fit) return fail(fit.error());
    ServeRequest request;
    if (auto read = read_options(serve_option_groups(), texts, request); !read)
        return fail(read.error());
    if (auto chosen = choose_roots(arguments, request); !chosen) return fail(chosen.error());
    if (auto chosen = choose_token(arguments, request.server); !chosen) return fail(chosen.error());
    if (request.max_upload) request.server.service.max_upload = request.max_upload->bytes;
    request.render = arguments.render;
    request.server.service.ocio_file = arguments.render.ocio.value_or("");
    if (arguments.jobs) request.server.jobs.folder = *arguments.jobs;
    complete_jobs_options(arguments.render, request.server.jobs);
    request.server.service.options = image_options(arguments.render, request.server.service.roots);
    return request;
}

}  // namespace obscura::app
