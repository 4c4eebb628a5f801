// serve/server.cpp - the server: which request leads where.
// SPDX-License-Identifier: Apache-2.0
#include "serve/server.h"

#include "image/output_format.h"

#include "serve/answers.h"
#include "serve/connections.h"
#include "serve/http.h"
#include "serve/page_files.h"
#include "serve/route_drake.h"
#include "serve/route_jobs.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <malloc.h>
#include <thread>

namespace obscura::serve {

namespace {

constexpr size_t max_connections = 256;
/// Clients that ask for the next picture get an answer within this time, so that one that is gone
/// is noticed.
constexpr std::chrono::milliseconds patience_of_polls(5000);

/// What a picture is saved as.
struct FileType {
    std::string_view ending;
    OutputFormat format;
    const char* type;
};
constexpr std::array<FileType, 5> file_types = {{{"png", OutputFormat::png, "image/png"},
                                                 {"exr", OutputFormat::exr, "image/x-exr"},
                                                 {"webp", OutputFormat::webp, "image/webp"},
                                                 {"jpg", OutputFormat::jpeg, "image/jpeg"},
                                                 {"tif", OutputFormat::tiff, "image/tiff"}}};

/// What pages may do: nothing that this server does not serve.
const httplib::Headers safe_headers = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
     "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Accept-Ranges", "none"}};

/// A port that has just become free is taken at once, but never one that another server has: the
/// library's own options would share it.
void reuse_address(socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

std::string parameter(const httplib::Request& request, const char* name) {
    return request.has_param(name) ? request.get_param_value(name) : "";
}

/// A number from 0 to 1.
Result<double> fraction(const httplib::Request& request, const char* name) {
    const std::string text = parameter(request, name);
    double value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc() && end == text.data() + text.size();
    if (is_number && value >= 0 && value <= 1) return value;
    return fail(
        ExitCode::usage, "E-USAGE-RANGE", name, "expected a number from 0 to 1, such as 0.5");
}

/// The serial number after which a picture is wanted; 0 where none is given.
Result<int> serial_after(const httplib::Request& request) {
    const std::string text = parameter(request, "after");
    int value = 0;
    if (text.empty()) return value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size() && value >= 0) return value;
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                "after",
                "expected the serial number of a picture, a whole number from 0");
}

/// Gives memory that was freed back to the system: each thread's share of it would stay, and grow
/// with what clients open and close.
void return_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

/// For the fragment of a URL.
std::string percent_encoded(const std::string& text) {
    constexpr std::string_view plain = "-._~/";
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool is_plain = std::isalnum(byte) != 0 || plain.find(c) != std::string_view::npos;
        if (is_plain && byte < 0x80) {
            out += c;
        } else {
            out += {'%', digits[byte >> 4U], digits[byte & 15U]};
        }
    }
    return out;
}

/// An image's codes, which stay with their owner.
Answer codes_answer(const DisplayedImage& image,
                    const std::string& header,
                    std::shared_ptr<const void> owner) {
    Answer out;
    out.type = "application/octet-stream";
    const auto bytes = std::as_bytes(std::span(image.codes));
    out.bytes = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    out.owner = std::move(owner);
    out.headers = {{"X-Obscura-Image", header}, {"Cache-Control", "no-store"}};
    return out;
}

}  // namespace

struct Server::Impl {
    explicit Impl(ServerOptions&& from)
        : options(std::move(from)),
          guard(options.address, options.token),
          service(options.service),
          jobs(options.jobs, service),
          routes(http, guard, options.service.max_upload) {
        constexpr time_t read_s = 10, write_s = 30, keep_alive_s = 30;
        http.new_task_queue = [this] {
            return new ConnectionThreads(port, max_connections, is_ending);
        };
        http.set_read_timeout(read_s);
        http.set_write_timeout(write_s);
        http.set_keep_alive_timeout(keep_alive_s);
        http.set_keep_alive_max_count(1000000);
        http.set_tcp_nodelay(true);
        http.set_socket_options([this](socket_t socket) {
            listening = socket;
            reuse_address(socket);
        });
        http.set_default_headers(safe_headers);
        route_page();
        route_files();
        route_views();
        route_images();
        route_drake(routes, service, sent_scenes, is_ending);
        route_jobs(routes, jobs);
        routes.refuse_the_rest();
    }

    void route_page();
    void route_files();
    void route_views();
    void route_images();
    Result<std::shared_ptr<Viewer>> viewer_of(const httplib::Request& request) const {
        return service.viewer(request.matches[1]);
    }
    Result<Answer> picture(const httplib::Request& request) const;
    Result<Answer> image(const httplib::Request& request) const;

    const ServerOptions options;
    const Guard guard;
    Service service;
    SceneCache sent_scenes;
    Jobs jobs;
    httplib::Server http;
    Routes routes;
    int port = 0;
    socket_t listening = INVALID_SOCKET;  ///< the last that was made: at a host's last address
    std::atomic<bool> is_ending = false;
};

void Server::Impl::route_page() {
    for (const PageFile& file : page_files) {
        const auto give = [&file](const httplib::Request& /*request*/) -> Result<Answer> {
            Answer out;
            out.type = file.type;
            out.bytes = file.text;
            out.headers = {{"Cache-Control", "no-cache"}};
            return out;
        };
        routes.get_openly(std::string(file.path), give);
        if (file.path == "/index.html") routes.get_openly("/", give);
    }
}

void Server::Impl::route_files() {
    routes.get("/api/files", [this](const auto& /*request*/) -> Result<Answer> {
        return json_result(service.list_files());
    });
    routes.get("/api/choices", [this](const auto& /*request*/) -> Result<Answer> {
        const Result<Json> choices = service.choices();
        if (!choices) return fail(choices.error());
        return json_result(*choices);
    });
    routes.post("/api/files", [this](const auto& request, Body& body) -> Result<Answer> {
        const Result<std::string> file = service.files().keep(
            parameter(request, "name"), [&](const ByteSink& sink) { return body.read(sink); });
        if (!file) return fail(file.error());
        return json_result({{"file", *file}}, 201);
    });
}

void Server::Impl::route_views() {
    routes.post("/api/views", [this](const auto& /*request*/, Body& body) -> Result<Answer> {
        const Result<nlohmann::json> asked = body.json();
        if (!asked) return fail(asked.error());
        const auto file = asked->find("file");
        if (file == asked->end() || !file->is_string()) {
            return fail(ExitCode::usage, "E-SERVE-BODY", "/file", "expected {\"file\": \"NAME\"}");
        }
        const Result<Json> opened = service.open_view(file->get<std::string>());
        if (!opened) return fail(opened.error());
        return json_result(*opened, 201);
    });
    routes.put("/api/views/([^/]+)", [this](const auto& request, Body& body) -> Result<Answer> {
        const Result<nlohmann::json> asked = body.json();
        if (!asked) return fail(asked.error());
        const auto wished = asked->find("options");
        if (wished == asked->end() || !wished->is_object()) {
            return fail(
                ExitCode::usage, "E-SERVE-BODY", "/options", "expected {\"options\": {...}}");
        }
        const Result<Json> taken = service.wish(request.matches[1], *wished);
        if (!taken) return fail(taken.error());
        return json_result(*taken);
    });
    routes.remove("/api/views/([^/]+)",
                  [this](const auto& request, Body& /*body*/) -> Result<Answer> {
                      const auto closed = service.close_view(request.matches[1]);
                      if (!closed) return fail(closed.error());
                      return json_result(Json::object());
                  });
}

Result<Answer> Server::Impl::picture(const httplib::Request& request) const {
    const auto viewer = viewer_of(request);
    if (!viewer) return fail(viewer.error());
    const Result<int> after = serial_after(request);
    if (!after) return fail(after.error());
    // In short waits: the server's end does not wait for the clients.
    constexpr std::chrono::milliseconds slice(250);
    std::shared_ptr<const ShownImage> picture;
    const std::function<bool()> is_gone = client_is_gone();
    for (auto waited = slice; !picture && waited <= patience_of_polls && !is_ending && !is_gone();
         waited += slice)
        picture = (*viewer)->wait_for(*after, slice);
    if (!picture) {
        Answer nothing;
        nothing.status = 204;
        return nothing;
    }
    if (!picture->error) return codes_answer(picture->image, image_header(*picture), picture);
    Json answer = error_answer(service.told(request.matches[1], *picture->error));
    answer["serial"] = picture->serial;
    answer["wish"] = picture->wish;
    return json_result(answer, 422);  // never 404: the view is there
}

Result<Answer> Server::Impl::image(const httplib::Request& request) const {
    const auto viewer = viewer_of(request);
    if (!viewer) return fail(viewer.error());
    const std::string asked = parameter(request, "format");
    const auto format = std::find_if(file_types.begin(), file_types.end(), [&](const auto& one) {
        return one.ending == (asked.empty() ? "png" : asked);
    });
    if (format == file_types.end()) {
        return fail(
            ExitCode::usage, "E-OUT-FORMAT", "format", "expected png, exr, webp, jpg or tif");
    }
    const std::string name = "picture." + std::string(format->ending);
    Result<EncodedFile> file = (*viewer)->file({format->format, name});
    if (!file) return fail(file.error());
    const auto kept = std::make_shared<const EncodedFile>(std::move(*file));
    Answer out;
    out.type = format->type;
    out.bytes = {reinterpret_cast<const char*>(kept->bytes.data()), kept->bytes.size()};
    out.owner = kept;
    out.headers = {{"Content-Disposition", "attachment; filename=\"" + name + "\""},
                   {"Cache-Control", "no-store"}};
    return out;
}

void Server::Impl::route_images() {
    routes.get("/api/views/([^/]+)/picture",
               [this](const auto& request) { return picture(request); });
    routes.get("/api/views/([^/]+)/image", [this](const auto& request) { return image(request); });
    routes.get("/api/views/([^/]+)/pick", [this](const auto& request) -> Result<Answer> {
        const auto viewer = viewer_of(request);
        if (!viewer) return fail(viewer.error());
        const Result<double> x = fraction(request, "x"), y = fraction(request, "y");
        if (!x) return fail(x.error());
        if (!y) return fail(y.error());
        const Result<Pick> picked = (*viewer)->pick(*x, *y);
        if (!picked) return fail(service.told(request.matches[1], picked.error()));
        return json_result(pick_answer(*picked));
    });
    routes.get("/api/views/([^/]+)/matte", [this](const auto& request) -> Result<Answer> {
        const auto viewer = viewer_of(request);
        if (!viewer) return fail(viewer.error());
        Result<DisplayedImage> matte = (*viewer)->matte(parameter(request, "node"));
        if (!matte) return fail(service.told(request.matches[1], matte.error()));
        const auto kept = std::make_shared<const DisplayedImage>(std::move(*matte));
        const Json header = {{"width", kept->width}, {"height", kept->height}, {"channels", 1}};
        return codes_answer(*kept, json_line(header), kept);
    });
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::listen(ServerOptions options) {
    auto impl = std::make_unique<Impl>(std::move(options));
    const ServerOptions& given = impl->options;
    impl->port = given.port;
    if (given.port == 0) {
        impl->port = impl->http.bind_to_any_port(given.address);
    } else if (!impl->http.bind_to_port(given.address, given.port)) {
        impl->port = -1;
    }
    if (impl->port > 0) {
        // The library lets five clients wait; the next of a burst would try again a second later.
        (void)::listen(impl->listening, SOMAXCONN);
        return std::unique_ptr<Server>(new Server(std::move(impl)));
    }
    return fail(ExitCode::unsupported,
                "E-SERVE-LISTEN",
                given.address + ":" + std::to_string(given.port),
                "cannot listen there: the address is not this machine's, or another program has "
                "the port; --port 0 takes one that is free");
}

int Server::port() const {
    return impl_->port;
}

std::string Server::url(const std::string& file) const {
    const ServerOptions& options = impl_->options;
    const bool is_any = options.address == "0.0.0.0" || options.address == "::";
    const std::string host = is_any ? "localhost" : host_in_url(options.address);
    std::string out = "http://" + host + ":" + std::to_string(impl_->port) + "/";
    std::string fragment;
    if (!options.token.empty()) fragment = "token=" + percent_encoded(options.token);
    if (!file.empty()) {
        fragment += fragment.empty() ? "" : "&";
        fragment += "file=" + percent_encoded(file);
    }
    return fragment.empty() ? out : out + "#" + fragment;
}

void Server::run(const std::atomic<bool>& stop) {
    std::atomic<bool> is_over = false;
    std::thread watch([&] {
        constexpr std::chrono::milliseconds interval(50);
        constexpr int intervals_to_trim = 100;
        for (int i = 1; !is_over; ++i) {
            std::this_thread::sleep_for(interval);
            if (i % intervals_to_trim == 0) return_memory();
            if (!stop) continue;
            impl_->is_ending = true;
            impl_->jobs.stop();
            impl_->http.stop();  // of no effect before it has begun to listen: once more
        }
    });
    impl_->http.listen_after_bind();
    impl_->is_ending = is_over = true;
    watch.join();
}

}  // namespace obscura::serve
