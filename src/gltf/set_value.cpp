// gltf/set_value.cpp - values that a caller gives to properties of a document.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/set_value.h"

#include "gltf/parse/animation_pointer.h"
#include "gltf/parse/trs.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

tl::unexpected<Error> bad_value(const std::string& pointer, const std::string& message) {
    return fail(ExitCode::usage, "E-SET-VALUE", pointer, message);
}

size_t width_of(const PointedProperty& pointed, const Document& document) {
    if (pointed.width != 0) return pointed.width;
    int mesh = pointed.property.target;
    if (pointed.property.path == ChannelPath::weights)
        mesh = document.nodes[static_cast<size_t>(mesh)].mesh;
    return mesh < 0 ? 0 : document.meshes[static_cast<size_t>(mesh)].target_count;
}

/// Writes a node's matrix as translation, rotation and scale; false: it shears.
bool give_trs(GltfNode& node) {
    const std::optional<GltfTrs> trs = trs_of(node.parent_from_node);
    if (!trs) return false;
    node.trs = *trs;
    node.has_matrix = false;
    return true;
}

}  // namespace

Result<SetValue> check_set_value(const std::string& pointer,
                                 std::span<const double> value,
                                 Document& document) {
    const std::optional<PointedProperty> found = find_property(document, pointer);
    if (!found || !found->in_use) {
        return fail(ExitCode::usage,
                    "E-SET-UNKNOWN",
                    pointer,
                    "the asset has no such property, or it cannot be set; expected a pointer of "
                    "glTF's object model, such as /nodes/0/translation or "
                    "/materials/0/pbrMetallicRoughness/roughnessFactor");
    }
    SetValue out{{}, {value.begin(), value.end()}};
    out.channel.property = found->property;
    out.channel.width = width_of(*found, document);
    if (value.size() != out.channel.width || value.empty()) {
        return bad_value(pointer,
                         "it takes " + std::to_string(out.channel.width) + " numbers; given are " +
                             std::to_string(value.size()));
    }
    const bool is_finite =
        std::all_of(value.begin(), value.end(), [](double x) { return std::isfinite(x); });
    if (!is_finite) return bad_value(pointer, "its numbers must be finite");
    if (found->property.path == ChannelPath::visible && value[0] != 0 && value[0] != 1)
        return bad_value(pointer, "it takes 1, shown, or 0, hidden");
    if (is_quaternion(found->property)) {
        std::array<double, 4> quaternion{};
        std::copy_n(value.begin(), quaternion.size(), quaternion.begin());
        if (!normalize_quaternion(quaternion))
            return bad_value(pointer, "the quaternion has no length");
        out.value.assign(quaternion.begin(), quaternion.end());
    }
    if (!moves_node(found->property.path)) return out;
    GltfNode& node = document.nodes[static_cast<size_t>(found->property.target)];
    if (node.has_matrix && !give_trs(node)) {
        return bad_value(pointer,
                         "the node has a matrix that shears, which is no translation, rotation and "
                         "scale; move a node above it");
    }
    return out;
}

}  // namespace obscura::gltf
