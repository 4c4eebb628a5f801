// serve/route_drake.cpp - the route of Drake's glTF render client-server protocol.
// SPDX-License-Identifier: Apache-2.0
#include "serve/route_drake.h"

#include "base/sha256.h"

#include "serve/answers.h"
#include "serve/beside.h"
#include "serve/connections.h"
#include "serve/drake_image.h"

namespace obscura::serve {

namespace {

/// The scene's bytes, which are what the client wanted to send.
Result<std::span<const std::byte>> whole_scene(const Form& form, const std::string& sha256) {
    const auto bytes = std::as_bytes(std::span(form.at("scene")));
    const std::string came = sha256_of(bytes);
    if (came == sha256) return bytes;
    return fail(ExitCode::bad_data,
                "E-DRAKE-HASH",
                "scene_sha256",
                "the scene that came has another: " + came);
}

Answer file_answer(std::vector<std::byte>&& file, DrakeImage image) {
    const auto kept = std::make_shared<const std::vector<std::byte>>(std::move(file));
    Answer out;
    out.type = image == DrakeImage::depth ? "image/tiff" : "image/png";
    out.bytes = {reinterpret_cast<const char*>(kept->data()), kept->size()};
    out.owner = kept;
    out.headers = {{"Cache-Control", "no-store"}};
    return out;
}

}  // namespace

void route_drake(Routes& routes,
                 const Service& service,
                 SceneCache& scenes,
                 const std::atomic<bool>& stop) {
    const auto render = [&](const httplib::Request& query, Body& body) -> Result<Answer> {
        const Result<DrakeSettings> settings = read_drake_query(query.params);
        if (!settings) return fail(settings.error());
        constexpr uint64_t other_fields = 1U << 16U;
        const Result<Form> form = body.form(service.max_upload() + other_fields);
        if (!form) return fail(form.error());
        const Result<DrakeRequest> wanted = read_drake_form(*form);
        if (!wanted) return fail(wanted.error());
        const auto bytes = whole_scene(*form, wanted->sha256);
        if (!bytes) return fail(bytes.error());
        Result<RenderRequest> request = service.request("scene.gltf", settings->options);
        if (!request) return fail(request.error());
        const Result<std::shared_ptr<SentScene>> scene = scenes.scene_of(wanted->sha256, *bytes);
        if (!scene) return fail(scene.error());
        request->scene = (*scene)->file;
        request->load.z_up = settings->z_up;
        std::atomic<bool> is_in_vain = false;
        const Beside watch([&, is_gone = client_is_gone()](const std::atomic<bool>& is_over) {
            constexpr std::chrono::milliseconds interval(100);
            for (; !is_over && !is_in_vain; std::this_thread::sleep_for(interval))
                is_in_vain = stop || is_gone();
        });
        Result<std::vector<std::byte>> file =
            make_drake_image(**scene, {*wanted, settings->labels, *request, is_in_vain});
        if (file) return file_answer(std::move(*file), wanted->image);
        if (!is_in_vain) scenes.forget(**scene);
        return fail(with_name(file.error(), (*scene)->file, "scene"));
    };
    routes.post_for_people("/render", render);
}

}  // namespace obscura::serve
