// python/module/asset.cpp - Asset, and what it tells of itself.
// SPDX-License-Identifier: Apache-2.0
#include "pixels.h"
#include "session.h"

namespace obscura::python {

namespace {

using AssetPointer = std::shared_ptr<AssetState>;

template <typename T>
py::tuple tuple_of(const std::vector<T>& list) {
    py::tuple out(list.size());
    for (std::size_t i = 0; i < list.size(); ++i)
        out[i] = py::cast(list[i]);
    return out;
}

/// None where there is nothing to see.
py::object bounds_of(const AssetInfo& info) {
    if (info.is_empty) return py::none();
    using Point = Plain<std::array<double, 3>>;
    return py::make_tuple(Point::to(info.low), Point::to(info.high));
}

std::string shown(const std::string& type, const std::string& name) {
    return "<obscura." + type + " '" + name + "'>";
}

/// Worked out when they are asked for: in deep files paths are long.
py::tuple nodes_of(AssetState& state) {
    if (!state.nodes) {
        if (!state.asset) throw py::value_error("the asset is closed");
        state.nodes = state.asset->nodes();
    }
    return tuple_of(*state.nodes);
}

void bind_parts(py::module_& module) {
    py::class_<CameraInfo>(module, "CameraInfo", "A camera of a file.")
        .def_property_readonly("name", [](const CameraInfo& c) { return text(c.name); })
        .def_readonly("orthographic", &CameraInfo::orthographic)
        .def_property_readonly(
            "world_from_camera",
            [](const CameraInfo& c) {
                const std::array<py::ssize_t, 2> shape = {4, 4};
                return py::array_t<double>(
                    shape, strides_of<double>(shape), c.world_from_camera.data());
            },
            "(4, 4) float64 for column vectors; looks along -Z, +Y is up.")
        .def_readonly("fov_deg", &CameraInfo::fov_deg, "Vertical, of perspective cameras.")
        .def("__repr__", [](const CameraInfo& c) { return text(shown("CameraInfo", c.name)); });
    py::class_<AnimationInfo>(module, "AnimationInfo", "An animation of a file.")
        .def_property_readonly("name", [](const AnimationInfo& a) { return text(a.name); })
        .def_readonly("end_s", &AnimationInfo::end_s, "When the last keyframe comes, seconds.")
        .def("__repr__",
             [](const AnimationInfo& a) { return text(shown("AnimationInfo", a.name)); });
    py::class_<NodeInfo>(module, "NodeInfo", "A node of a file.")
        .def_property_readonly(
            "path",
            [](const NodeInfo& n) { return text(n.path); },
            "From its root: '/lamp/shade', as Cryptomatte layers name it.")
        .def_property_readonly(
            "mesh",
            [](const NodeInfo& n) { return Plain<std::string>::to(n.mesh); },
            "Its mesh's name, or None.")
        .def("__repr__", [](const NodeInfo& n) { return text(shown("NodeInfo", n.path)); });
}

/// The facts, of AssetInfo itself and of an Asset.
template <typename Class, typename Get>
void bind_facts(Class& bound, Get get) {
    using From = typename Class::type;
    const auto add = [&](const char* name, auto read, const char* doc) {
        bound.def_property_readonly(
            name, [get, read](const From& from) { return read(get(from)); }, doc);
    };
    using Info = const AssetInfo&;
    add(
        "file", [](Info i) { return text(i.file); }, "The file's name, without folder.");
    add(
        "generator", [](Info i) { return text(i.generator); }, "What wrote the file.");
    add(
        "copyright", [](Info i) { return text(i.copyright); }, "As the file says it.");
    add(
        "scenes", [](Info i) { return texts(i.scenes); }, "The names of its scenes.");
    add(
        "scene", [](Info i) { return i.scene; }, "The index of the one that was opened.");
    add(
        "variants", [](Info i) { return texts(i.variants); }, "Names, for Session.open(variant=).");
    add(
        "cameras", [](Info i) { return tuple_of(i.cameras); }, "CameraInfo, of the scene.");
    add(
        "animations", [](Info i) { return tuple_of(i.animations); }, "AnimationInfo.");
    add(
        "bounds",
        [](Info i) { return bounds_of(i); },
        "((x, y, z), (x, y, z)), the lowest and the highest corner of all that is seen, metres; "
        "None where nothing is.");
    add(
        "triangles", [](Info i) { return i.triangles; }, "With every instance counted.");
}

}  // namespace

void bind_asset(py::module_& module) {
    bind_parts(module);
    py::class_<AssetInfo> info(module, "AssetInfo", "What a file holds, in its order.");
    bind_facts(info, [](const AssetInfo& own) -> const AssetInfo& { return own; });
    py::class_<AssetState, AssetPointer> asset(
        module,
        "Asset",
        "An opened asset, by Session.open(). It keeps what rendering has built, so that the next "
        "image of\nthe same pose starts at once. Used by the session that opened it, which it "
        "keeps alive.");
    bind_facts(asset, [](const AssetState& state) -> const AssetInfo& { return state.info; });
    asset.def_property_readonly("nodes", nodes_of, "NodeInfo, of all scenes.")
        .def_property_readonly(
            "info", [](const AssetState& state) { return state.info; }, "All of it, as AssetInfo.")
        .def(
            "close",
            [](AssetState& state) {
                if (state.session->is_closed) return;
                const Turn turn(*state.session);
                close_asset(state);
            },
            "Frees its memory; it can be rendered no more.")
        .def_property_readonly("closed", [](const AssetState& state) { return !state.asset; })
        .def("__repr__",
             [](const AssetState& state) { return text(shown("Asset", state.info.file)); });
}

}  // namespace obscura::python
