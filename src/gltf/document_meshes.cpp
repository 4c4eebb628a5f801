// gltf/document_meshes.cpp - reads meshes, and counts the animations that are not played.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/document_parts.h"
#include "gltf/variants.h"

namespace obscura {

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

/// Where the number of an attribute is kept; nullptr: it is not used.
int* slot_of(GltfAttributes& attributes, const std::string& name) {
    if (name == "POSITION") return &attributes.position;
    if (name == "NORMAL") return &attributes.normal;
    if (name == "TANGENT") return &attributes.tangent;
    if (name == "COLOR_0") return &attributes.color;
    if (name == "KHR_gaussian_splatting:SH_DEGREE_0_COEF_0") return &attributes.splat_color;
    if (name == "KHR_gaussian_splatting:OPACITY") return &attributes.splat_opacity;
    const int set = uv_set_of(name);
    return set < 0 ? nullptr : &attributes.uv[static_cast<size_t>(set)];
}

void read_draco(DocumentReading& reading, const JsonReader& object, GltfPrimitive& out) {
    constexpr const char* name = "KHR_draco_mesh_compression";
    if (!object.has_extension(name)) return;
    const JsonReader draco = object.extension(name);
    draco.require("bufferView");
    draco.require("attributes");
    out.draco_view = draco.index("bufferView", reading.root.count("bufferViews"), "buffer view");
    if (out.mode != 4 && out.mode != 5) {
        object.fault("mode", "E-DRACO-MODE", "Draco holds triangles: accepted are 4 and 5");
    }
    if (out.indices < 0) {
        object.fault("", "E-DRACO-DATA", "a Draco-compressed primitive must have indices");
    }
    const JsonReader ids = draco.child("attributes");
    const JsonReader accessors = object.child("attributes");
    ids.each_key([&](const std::string& attribute) {
        const int id = ids.index(attribute, INT32_MAX, "attribute");
        if (!accessors.has(attribute)) {
            ids.fault(attribute, "E-DRACO-DATA", "the primitive has no accessor for it");
        }
        int* slot = slot_of(out.draco_ids, attribute);
        if (slot != nullptr) *slot = id;
    });
}

GltfPrimitive read_primitive(DocumentReading& reading, const JsonReader& object) {
    object.require("attributes");
    const size_t accessor_count = reading.root.count("accessors");
    GltfPrimitive out;
    const JsonReader attributes = object.child("attributes");
    attributes.each_key([&](const std::string& name) {
        const int accessor = attributes.index(name, accessor_count, "accessor");
        int* slot = slot_of(out, name);
        if (slot != nullptr) *slot = accessor;
    });
    out.indices = object.index("indices", accessor_count, "accessor");
    out.material = object.index("material", reading.root.count("materials"), "material");
    const uint64_t mode = object.size("mode", 4);
    if (mode > 6) {
        object.fault("mode",
                     "E-MESH-MODE",
                     std::to_string(mode) + " is not a primitive mode; accepted are 0 to 6");
    }
    out.mode = static_cast<int>(mode);
    constexpr const char* splats = "KHR_gaussian_splatting";
    out.splats_are_linear = object.has_extension(splats) &&
                            object.extension(splats).text("colorSpace") == "lin_rec709_display";
    read_draco(reading, object, out);
    read_variant_materials(reading, object, out);
    return out;
}

}  // namespace

void read_meshes(DocumentReading& reading) {
    Document& document = reading.document;
    reading.root.each("meshes", [&](const JsonReader& mesh, size_t index) {
        mesh.require("primitives");
        GltfMesh out;
        out.name = mesh.text("name");
        if (out.name.empty()) out.name = "mesh " + std::to_string(index);
        bool morphed = false;
        mesh.each("primitives", [&](const JsonReader& primitive, size_t) {
            out.primitives.push_back(read_primitive(reading, primitive));
            morphed = morphed || primitive.count("targets") != 0;
        });
        if (morphed) ++document.morphed_mesh_count;
        document.meshes.push_back(std::move(out));
    });
    if (document.morphed_mesh_count != 0) {
        reading.log.warn(document.file,
                         "morph targets are not supported: base shapes are drawn (meshes: " +
                             std::to_string(document.morphed_mesh_count) + ")");
    }
}

void read_animations(DocumentReading& reading) {
    Document& document = reading.document;
    reading.root.each("animations", [&](const JsonReader& animation, size_t index) {
        const std::string name = animation.text("name");
        document.animations.push_back({name.empty() ? "animation " + std::to_string(index) : name,
                                       animation.count("channels")});
    });
    if (!document.animations.empty()) {
        reading.log.warn(
            document.file,
            "animations are not supported: the pose of the nodes is drawn (animations: " +
                std::to_string(document.animations.size()) + ")");
    }
    document.skin_count = reading.root.count("skins");
    if (document.skin_count != 0) {
        reading.log.warn(
            document.file,
            "skins are not supported: meshes are drawn unposed, placed by their nodes (skins: " +
                std::to_string(document.skin_count) + ")");
    }
}

}  // namespace obscura
