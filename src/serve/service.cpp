// serve/service.cpp - what the server can do, whatever protocol asks for it.
// SPDX-License-Identifier: Apache-2.0
#include "serve/service.h"

#include "base/log.h"
#include "session/built_in_environment.h"

#include "serve/answers.h"
#include <array>

namespace obscura::serve {

namespace {

constexpr size_t max_views = 8;

/// What a layer is called in the page, by the integrator that shows it.
struct LayerTitle {
    const char* integrator;
    const char* title;
};
constexpr std::array<LayerTitle, 9> layer_titles = {{{"path", "Beauty"},
                                                     {"normal", "Normals"},
                                                     {"albedo", "Albedo"},
                                                     {"depth", "Depth"},
                                                     {"id", "Ids"},
                                                     {"ao", "Ambient occlusion"},
                                                     {"wireframe", "Wireframe"},
                                                     {"uv", "Texture coordinates"},
                                                     {"heat", "Cost of rays"}}};

Error no_such_view(const std::string& view) {
    return {ExitCode::usage,
            "E-SERVE-UNKNOWN",
            escape_control(view),
            "there is no such view, or it was closed to make room; open one anew"};
}

}  // namespace

Service::Service(ServiceOptions options)
    : options_(std::move(options)), files_(options_.roots, options_.max_upload) {}

Json Service::list_files() const {
    Json out = {{"files", Json::array()}};
    for (const KnownFile& file : files_.list()) {
        const char* const kind = file.kind == FileKind::model ? "model" : "environment";
        out["files"].push_back({{"file", file.name}, {"kind", kind}});
    }
    return out;
}

Result<Json> Service::choices() const {
    Log log;
    const Result<std::vector<DisplayChoice>> displays = display_choices(options_.ocio_file, log);
    if (!displays) return fail(displays.error());
    Json out = {{"version", OBSCURA_VERSION},
                {"environments", {"studio", "neutral", "white", "sky:40,30"}},
                {"displays", Json::array()},
                {"layers", Json::array()}};
    for (const DisplayChoice& display : *displays)
        out["displays"].push_back({{"name", display.name}, {"views", display.views}});
    for (const LayerTitle& layer : layer_titles)
        out["layers"].push_back({{"name", layer.integrator}, {"title", layer.title}});
    return out;
}

Result<Options> Service::with_files_found(const Options& options) const {
    Options out = options;
    const auto env = out.find("env");
    if (env == out.end()) return out;
    // An array would be put together to the name of a file that nobody has looked up.
    if (!env->is_string())
        return fail(ExitCode::usage, "E-USAGE-CHOICE", "/options/env", "expected a string");
    const auto name = env->get<std::string>();
    const auto built_in = parse_built_in_environment(name);
    if (!built_in) return fail(built_in.error());
    if (*built_in) return out;
    const Result<std::filesystem::path> file = files_.find(name);
    if (!file) return fail(file.error());
    *env = file->string();
    return out;
}

Result<RenderRequest> Service::request(const std::filesystem::path& scene,
                                       const Options& options) const {
    const Result<Options> found = with_files_found(options);
    if (!found) return fail(found.error());
    return options_.options.request(scene, *found);
}

Result<Json> Service::open_view(const std::string& file) {
    const Result<std::filesystem::path> scene = files_.find(file);
    if (!scene) return fail(scene.error());
    if (kind_of(*scene) != FileKind::model)
        return fail(ExitCode::usage, "E-SERVE-NAME", file, "expected a .glb or .gltf file");
    Result<RenderRequest> request = options_.options.request(*scene, Options::object());
    if (!request) return fail(request.error());
    Open open{
        file, *scene, {{scene->string(), file}}, std::make_shared<Viewer>(*scene, request->load)};
    const Result<LookAt> camera = open.viewer->open({0, std::move(*request), ""});
    if (!camera) return fail(with_name(camera.error(), *scene, file));
    Json out;
    std::string id;
    const std::shared_ptr<Viewer> viewer = open.viewer;
    std::vector<std::string> warnings = viewer->warnings();
    for (std::string& warning : warnings)
        replace_path(warning, *scene, file);
    out["asset"] = asset_answer(viewer->scene(), warnings);
    out["camera"] = camera_answer(*camera);
    // What is closed to make room goes when nobody holds the lock.
    const std::shared_ptr<Viewer> closed = add(std::move(open), id);
    out["view"] = id;
    return out;
}

/// Returns the viewer that had to make room.
std::shared_ptr<Viewer> Service::add(Open&& open, std::string& id) {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Viewer> closed;
    if (views_.size() >= max_views) {
        const auto idlest =
            std::max_element(views_.begin(), views_.end(), [](const auto& a, const auto& b) {
                return a.second.viewer->idle() < b.second.viewer->idle();
            });
        closed = std::move(idlest->second.viewer);
        views_.erase(idlest);
    }
    id = "v" + std::to_string(++opened_) + "-" + run_;
    views_.emplace(id, std::move(open));
    return closed;
}

Result<Service::Open> Service::find_open(const std::string& view) const {
    const std::lock_guard lock(mutex_);
    const auto found = views_.find(view);
    if (found != views_.end()) return found->second;
    return fail(no_such_view(view));
}

Result<Json> Service::wish(const std::string& view, const Options& options) {
    const Result<Open> open = find_open(view);
    if (!open) return fail(open.error());
    const Result<Options> found = with_files_found(options);
    if (!found) return fail(found.error());
    Result<RenderRequest> request = options_.options.request(open->scene, *found);
    if (!request) return fail(request.error());
    int number = 0;
    {
        const std::lock_guard lock(mutex_);
        const auto known = views_.find(view);
        if (known == views_.end()) return fail(no_such_view(view));
        number = ++known->second.wishes;
        const auto env = found->find("env");
        if (env != found->end() && *env != options.at("env"))
            known->second.names[env->get<std::string>()] = options.at("env").get<std::string>();
    }
    open->viewer->want({number, std::move(*request), rendering_of(*found)});
    return Json{{"wish", number}, {"command", options_.options.command(open->file, options)}};
}

Result<std::shared_ptr<Viewer>> Service::viewer(const std::string& view) const {
    const Result<Open> open = find_open(view);
    if (!open) return fail(open.error());
    return open->viewer;
}

Result<void> Service::close_view(const std::string& view) {
    const Result<Open> open = find_open(view);
    if (!open) return fail(open.error());
    const std::lock_guard lock(mutex_);
    views_.erase(view);
    return {};
}

Error Service::told(const std::string& view, Error error) const {
    const Result<Open> open = find_open(view);
    if (!open) return error;
    for (const auto& [file, name] : open->names)
        error = with_name(std::move(error), file, name);
    const bool is_missing = error.code == ExitCode::missing_scene && is_upload(open->file);
    if (is_missing && !files_.find(open->file))
        error.message = "this upload went to make room for newer ones; send it again";
    return error;
}

}  // namespace obscura::serve
