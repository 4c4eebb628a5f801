// gltf/parse/document_meshes.cpp - reads meshes with their morph targets.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_meshes.h"

#include "gltf/parse/document_splats.h"
#include "gltf/parse/variants.h"

#include <map>

namespace obscura::gltf {

namespace {

/// The number behind "TEXCOORD_"; -1 when the name is another one or the number is not plain.
int uv_set_of(const std::string& attribute) {
    constexpr std::string_view prefix = "TEXCOORD_";
    if (attribute.rfind(prefix, 0) != 0) return -1;
    const std::string digits = attribute.substr(prefix.size());
    if (digits.size() != 1 || digits[0] < '0' || digits[0] > '9') return -1;
    const int set = digits[0] - '0';
    return set < max_uv_sets ? set : -1;
}

/// Where "JOINTS_3" is kept in the list of such sets; nullptr: the name is another one.
int* set_slot(std::vector<int>& sets, const std::string& name, std::string_view prefix) {
    constexpr size_t max_digits = 3;
    if (name.rfind(prefix, 0) != 0) return nullptr;
    const std::string digits = name.substr(prefix.size());
    if (digits.empty() || digits.size() > max_digits ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
        return nullptr;
    }
    const auto set = static_cast<size_t>(std::stoi(digits));
    if (sets.size() <= set) sets.resize(set + 1, -1);
    return &sets[set];
}

/// Where the number of an attribute is kept; nullptr: it is not used.
int* slot_of(GltfAttributes& attributes, const std::string& name) {
    if (name == "POSITION") return &attributes.position;
    if (name == "NORMAL") return &attributes.normal;
    if (name == "TANGENT") return &attributes.tangent;
    if (name == "COLOR_0") return &attributes.color;
    int* joint_slot = set_slot(attributes.joints, name, "JOINTS_");
    if (joint_slot != nullptr) return joint_slot;
    int* weight_slot = set_slot(attributes.weights, name, "WEIGHTS_");
    if (weight_slot != nullptr) return weight_slot;
    const int set = uv_set_of(name);
    if (set >= 0) return &attributes.uv[static_cast<size_t>(set)];
    return splat_slot(attributes.splats, name);
}

void read_draco(const DocumentReading& reading,
                const tinygltf::Primitive& file,
                const ModelElement& object,
                GltfPrimitive& out) {
    constexpr const char* name = "KHR_draco_mesh_compression";
    if (!object.has_extension(name)) return;
    const ValueReader draco = object.extension(name);
    draco.require("bufferView");
    draco.require("attributes");
    out.draco_view = draco.index("bufferView", reading.model.bufferViews.size(), "buffer view");
    if (out.mode != 4 && out.mode != 5) {
        object.fault("mode", "E-DRACO-MODE", "Draco holds triangles: accepted are 4 and 5");
    }
    if (out.indices < 0) {
        object.fault("", "E-DRACO-DATA", "a Draco-compressed primitive must have indices");
    }
    const ValueReader ids = draco.child("attributes");
    ids.each_key([&](const std::string& attribute) {
        const int id = ids.index(attribute, INT32_MAX, "attribute");
        if (file.attributes.count(attribute) == 0) {
            ids.fault(attribute, "E-DRACO-DATA", "the primitive has no accessor for it");
        }
        int* slot = slot_of(out.draco_ids, attribute);
        if (slot != nullptr) *slot = id;
    });
}

/// Accessors by attribute, of a primitive or of one of its morph targets.
void read_attributes(const std::map<std::string, int>& attributes, GltfAttributes& out) {
    for (const auto& [name, accessor] : attributes) {
        int* slot = slot_of(out, name);
        if (slot != nullptr) *slot = accessor;
    }
}

GltfPrimitive read_primitive(const DocumentReading& reading,
                             const tinygltf::Primitive& file,
                             const ModelElement& place) {
    GltfPrimitive out;
    read_attributes(file.attributes, out);
    for (const auto& target : file.targets)
        read_attributes(target, out.targets.emplace_back());
    out.indices = file.indices;
    out.material = out.own_material = file.material;
    if (file.mode > 6) {
        place.fault("mode",
                    "E-MESH-MODE",
                    std::to_string(file.mode) + " is not a primitive mode; accepted are 0 to 6");
    }
    out.mode = out.own_mode = file.mode;
    read_splats(place, out);
    read_draco(reading, file, place, out);
    read_variant_materials(reading, place, out);
    return out;
}

}  // namespace

void read_meshes(DocumentReading& reading) {
    const auto read = [&](const tinygltf::Mesh& mesh, const ModelElement& place, size_t index) {
        GltfMesh out;
        out.name = name_or(mesh.name, "mesh", index);
        out.primitives.reserve(mesh.primitives.size());
        for (size_t number = 0; number < mesh.primitives.size() && !reading.failed(); ++number) {
            const tinygltf::Primitive& file = mesh.primitives[number];
            const ModelElement object =
                place.child("primitives/" + std::to_string(number), file.extensions);
            GltfPrimitive primitive = read_primitive(reading, file, object);
            if (number == 0) out.target_count = primitive.targets.size();
            if (primitive.targets.size() != out.target_count) {
                object.fault("targets",
                             "E-MESH-TARGETS",
                             "the primitive has " + std::to_string(primitive.targets.size()) +
                                 " morph targets and the first one " +
                                 std::to_string(out.target_count) + "; they must agree");
            }
            out.primitives.push_back(std::move(primitive));
        }
        out.weights = mesh.weights;
        reading.document.meshes.push_back(std::move(out));
    };
    each_element(reading, "meshes", reading.model.meshes, read);
}

}  // namespace obscura::gltf
