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

/// A number, or a list of them of any length.
std::vector<double> numbers_of(const py::object& value) {
    const Place place{"Asset.set", "value"};
    if (py::isinstance<py::bool_>(value)) return {py::cast<bool>(value) ? 1.0 : 0.0};
    if (!py::isinstance<py::sequence>(value) && !py::isinstance<py::array>(value))
        return {read_double(value, place)};
    std::vector<double> out;
    for (const py::handle one : value)
        out.push_back(read_double(one, place));
    return out;
}

constexpr const char* set_doc =
    R"(Sets a property for the images that follow, whatever animations say.

    set(pointer, value)

pointer: of glTF's object model: '/nodes/3/translation', '/nodes/3/rotation' (x, y, z, w),
'/materials/2/pbrMetallicRoughness/baseColorFactor', '/nodes/3/weights', ...
value: a number or as many as it has, in glTF's units. Nothing is read again, and the BVHs of meshes
that only move are kept.

Raises obscura.Error 'E-SET-UNKNOWN' or 'E-SET-VALUE'.)";

void bind_changes(py::class_<AssetState, AssetPointer>& asset) {
    asset
        .def(
            "set",
            [](AssetState& state, const py::object& pointer, const py::object& value) {
                const std::string name = read_text(pointer, {"Asset.set", "pointer"});
                const std::vector<double> numbers = numbers_of(value);
                change_asset(state, [&](Asset& own) { return own.set(name, numbers); });
            },
            py::arg("pointer"),
            py::arg("value"),
            set_doc)
        .def(
            "set_variant",
            [](AssetState& state, const py::object& name) {
                const std::string variant =
                    name.is_none() ? "" : read_text(name, {"Asset.set_variant", "name"});
                change_asset(state, [&](Asset& own) { return own.set_variant(variant); });
            },
            py::arg("name"),
            "Shows the materials of a variant; None: the file's own. Nothing is read again.")
        .def(
            "_assign_material",
            [](AssetState& state, std::size_t node, std::size_t material) {
                change_asset(state,
                             [&](Asset& own) { return own.assign_material(node, material); });
            },
            py::arg("node"),
            py::arg("material"))
        .def(
            "reset",
            [](AssetState& state) {
                change_asset(state, [](Asset& own) -> Result<void> {
                    own.reset();
                    return {};
                });
            },
            "Undoes what set() and its like did; the next image reads the file again.");
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
        "materials",
        [](Info i) { return texts(i.materials); },
        "Names, by their numbers in the file.");
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
    bind_changes(asset);
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
