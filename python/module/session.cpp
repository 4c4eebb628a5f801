// python/module/session.cpp - Session: opens assets, renders images, writes files.
// SPDX-License-Identifier: Apache-2.0
#include "session.h"

#include "pixels.h"
#include "settings.h"
#include <functional>
#include <utility>

namespace obscura::python {

namespace {

using SessionPointer = std::shared_ptr<SessionState>;
using AssetPointer = std::shared_ptr<AssetState>;

py::object exception_of(const Error& error) {
    py::list also;
    for (const Error& other : error.also)
        also.append(exception_of(other));
    const py::object type = py::module_::import("obscura._error").attr("Error");
    return type(text(error.id), text(error.place), text(error.text), error.code, py::tuple(also));
}

/// Runs a call that gives a Result; throws its error.
template <typename T>
Result<T> run(SessionState& state,
              Call& call,
              const Listeners& listeners,
              const std::function<Result<T>()>& body) {
    struct Current {
        SessionState& state;
        ~Current() { state.call = nullptr; }
    } current{state};
    state.call = &call;
    std::optional<Result<T>> result;
    call.run([&] { result.emplace(body()); }, listeners);
    if (!*result) raise(result->error());
    return std::move(*result);
}

template <typename Owner>
Owner settings_or_usual(const py::object& value, const Place& place, const char* expected) {
    if (value.is_none()) return {};
    if (!py::isinstance<Owner>(value)) wrong_type(place, expected, value);
    return py::cast<Owner>(value);
}

AssetPointer open(const SessionPointer& state, const py::object& path, const py::kwargs& keywords) {
    AssetOptions options;
    set_fields(options, asset_fields(), keywords);
    const std::string file = read_file_name(path, {"Session.open", "path"});
    const Turn turn(*state);
    Call call;
    auto asset = run<Asset>(*state, call, {state->log, {}, {}, {}}, [&] {
        return state->session->open(file, options);
    });
    auto opened = std::make_shared<AssetState>(state, std::move(*asset));
    std::erase_if(state->assets, [](const auto& known) { return known.expired(); });
    state->assets.push_back(opened);
    return opened;
}

/// The library's callbacks, where Python has any.
void post_to(Call& call, Control& control, const Listeners& listeners) {
    control.cancel = &call.cancel;
    if (listeners.progress) {
        control.progress = [&call](double share) { call.post_progress(share); };
    }
    if (listeners.tile) {
        control.tile = [&call](const Tile& tile) { call.post(tile); };
    }
}

AssetState& open_asset_of(const SessionState& session, const py::object& value) {
    const Place place{"Session.render", "asset"};
    if (!py::isinstance<AssetState>(value)) wrong_type(place, "an obscura.Asset", value);
    AssetState& state = *py::cast<AssetPointer>(value);
    if (state.session.get() != &session) wrong_value(place, "it belongs to another session");
    return state;
}

/// The settings of one rendering, copied, so that Python may change its own meanwhile.
struct Request {
    View view;
    Look look;
    Sampling sampling;
    RenderControl control;
};

std::shared_ptr<Image> render(const SessionPointer& state,
                              const py::object& given_asset,
                              const Request& request) {
    AssetState& asset = open_asset_of(*state, given_asset);
    const RenderControl& asked = request.control;
    const Listeners listeners{state->log, asked.on_progress, asked.on_tile, asked.cancel_event};
    const Turn turn(*state, listeners.cancel);
    if (!asset.asset) throw py::value_error("the asset is closed");
    Call call;
    call.cancel = listeners.cancel && listeners.cancel.attr("is_set")().cast<bool>();
    Control control = asked;
    post_to(call, control, listeners);
    auto image = run<Image>(*state, call, listeners, [&] {
        return state->session->render(
            *asset.asset, request.view, request.look, request.sampling, control);
    });
    return std::make_shared<Image>(std::move(*image));
}

void write(const SessionPointer& state,
           const std::shared_ptr<Image>& image,
           const py::object& path,
           const py::kwargs& keywords) {
    WriteOptions options;
    set_fields(options, write_fields(), keywords);
    const std::string file = read_file_name(path, {"Session.write", "path"});
    const Turn turn(*state);
    Call call;
    run<void>(*state, call, {state->log, {}, {}, {}}, [&] {
        return state->session->write(*image, file, options);
    });
}

/// Frees the assets, too. A session that is closed stays closed.
void close(SessionState& state) {
    if (state.is_closed) return;
    const Turn turn(state);
    for (const std::weak_ptr<AssetState>& asset : state.assets) {
        if (const AssetPointer open = asset.lock()) close_asset(*open);
    }
    state.assets.clear();
    state.is_closed = true;
    state.log = {};
}

void bind_messages(py::module_& module) {
    py::class_<Message>(module, "Message", "A warning or a note of the library.")
        .def_readonly("is_warning", &Message::is_warning)
        .def_property_readonly(
            "place",
            [](const Message& m) { return text(m.place); },
            "Of a warning: a file, with a JSON pointer into it.")
        .def_property_readonly("text", [](const Message& m) { return text(m.text); })
        .def("__str__", [](const Message& m) {
            return text(m.place.empty() ? m.text : m.place + ": " + m.text);
        });
    py::class_<TileCopy, std::shared_ptr<TileCopy>>(
        module, "Tile", "Pixels of the beauty that are finished.")
        .def_property_readonly("x", [](const TileCopy& t) { return t.area.x; })
        .def_property_readonly("y", [](const TileCopy& t) { return t.area.y; })
        .def_property_readonly("width", [](const TileCopy& t) { return t.area.width; })
        .def_property_readonly("height", [](const TileCopy& t) { return t.area.height; })
        .def_property_readonly("channels", [](const TileCopy& t) { return texts(t.channels); })
        .def_property_readonly(
            "pixels",
            [](TileCopy& t) {
                return pixels_of({t.area.width, t.area.height, t.channels.size()},
                                 t.pixels,
                                 py::cast(t, py::return_value_policy::reference));
            },
            "(height, width, channels) float32, a copy.");
}

constexpr const char* session_doc =
    R"(Opens assets, renders images, writes files.

log: called with each Message of the library; None: nobody is told.

One call of a session runs at a time; other threads wait for their turn. Several sessions in
several threads work side by side. `with obscura.Session() as session:` closes it at the end.)";

constexpr const char* open_doc =
    R"(Reads and checks a .gltf or .glb file with all that it refers to.

    open(path, *, scene=None, variant=None, animation=None, threads=0, lenient=False,
         ambient_occlusion=False, fps=None) -> Asset

scene: name or index of one of several; variant: of KHR_materials_variants; animation: a name, an
index as text, 'all' or 'none'; threads: 0 is every core; lenient: makes do with faults that would
change the image, and warns; ambient_occlusion: materials keep their occlusion textures; fps: frames
a second, between which the layer 'motion' tells movement.

Raises obscura.Error with the id, place and text of what is wrong.)";

constexpr const char* render_doc = R"(Renders one image.

    render(asset, view=None, look=None, sampling=None, *, threads=0, isa='auto', tile_size=16,
           cancel=None, progress=None, tile=None) -> Image

The same arguments give the same bits for any number of threads and any size of tiles.

threads: 0 is every core; isa: 'auto', 'baseline', 'avx2', 'avx512'; tile_size: pixels, 1 to 256.
cancel: a threading.Event; once it is set, rendering ends soon with Error 'E-STOPPED'.
progress: called with the finished share, from 0 to 1. Shares that come faster than it returns are
left out. tile: called with each finished Tile.

Callbacks run in the calling thread. What they raise ends the rendering and is raised here, and so
is KeyboardInterrupt of Ctrl-C; the asset can be rendered again.)";

constexpr const char* write_doc = R"(Writes .exr, .png, .jpg, .tif, .webp or .avif.

    write(image, path, *, float32=False, exr_layout='single', exposure_ev=0, ocio_config=None,
          display=None, view=None, bits=8, quality=None, dither=True, page=None)

The file is what the program writes, whole or not at all. Only an EXR has the layers. float32 and
exr_layout ('single', 'multipart', 'separate') are of EXR, all others of the other formats: values
are multiplied by 2^exposure_ev; ocio_config, display and view choose the transform; bits: 8, or 16
in PNG and TIFF; quality: 1 to 100; page: a colour behind an image with alpha, (r, g, b) from 0 to 1
in the display's encoding.)";

}  // namespace

void raise(const Error& error) {
    const py::object exception = exception_of(error);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
    throw py::error_already_set();
}

void change_asset(AssetState& state, const std::function<Result<void>(Asset&)>& made) {
    const Turn turn(*state.session);
    if (!state.asset) throw py::value_error("the asset is closed");
    Call call;
    run<void>(
        *state.session, call, {state.session->log, {}, {}, {}}, [&] { return made(*state.asset); });
}

void bind_session(py::module_& module) {
    bind_messages(module);
    py::class_<SessionState, SessionPointer>(module, "Session", session_doc)
        .def(py::init([](const py::object& log) {
                 if (!log.is_none() && PyCallable_Check(log.ptr()) == 0) {
                     wrong_type({"Session", "log"}, "a callable", log);
                 }
                 return std::make_shared<SessionState>(log.is_none() ? py::object() : log);
             }),
             py::kw_only(),
             py::arg("log") = py::none())
        .def("open", open, py::arg("path"), open_doc)
        .def(
            "render",
            [](const SessionPointer& state,
               const py::object& asset,
               const py::object& view,
               const py::object& look,
               const py::object& sampling,
               const py::kwargs& keywords) {
                const char* const name = "Session.render";
                Request request;
                request.view = settings_or_usual<View>(view, {name, "view"}, "an obscura.View");
                request.look = settings_or_usual<Look>(look, {name, "look"}, "an obscura.Look");
                request.sampling = settings_or_usual<Sampling>(
                    sampling, {name, "sampling"}, "an obscura.Sampling");
                set_fields(request.control, control_fields(), keywords);
                return render(state, asset, request);
            },
            py::arg("asset"),
            py::arg("view") = py::none(),
            py::arg("look") = py::none(),
            py::arg("sampling") = py::none(),
            render_doc)
        .def("write", write, py::arg("image").none(false), py::arg("path"), write_doc)
        .def(
            "close",
            [](SessionState& state) { close(state); },
            "Frees the assets; what is called afterwards raises ValueError.")
        .def_property_readonly("closed", [](const SessionState& s) { return s.is_closed; })
        .def("__enter__", [](const py::object& self) { return self; })
        .def("__exit__", [](SessionState& state, const py::args&) { close(state); });
}

}  // namespace obscura::python
