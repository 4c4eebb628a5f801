// gltf/parse/preflight.cpp - checks and repairs the JSON before tinygltf sees it.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/preflight.h"

#include "gltf/parse/light_camera_entries.h"
#include "gltf/parse/model.h"
#include "gltf/parse/tree_check.h"
#include "gltf/parse/tree_rules.h"
#include "gltf/parse/value_reader.h"
#include "math/warp.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

using nlohmann::json;

constexpr const char* punctual_name = "KHR_lights_punctual";
constexpr const char* pointer_name = "KHR_animation_pointer";

size_t array_size(const json& tree, const char* key) {
    const auto found = tree.find(key);
    return found != tree.end() && found->is_array() ? found->size() : 0;
}

/// The member if it is an object.
json* object_in(json& object, std::string_view key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_object() ? &*found : nullptr;
}

/// Checks the tree from its root to its leaves.
class Preflight {
public:
    Preflight(json& tree, Document& document, Log& log, JsonFault& fault)
        : tree_(tree), document_(document), log_(log), fault_(fault) {}

    void check();

private:
    /// What an element of an array needs beside its rules.
    using Special = void (Preflight::*)(json& element, const TreePlace& place);

    void check_array(const char* key, const ObjectRules& rules, Special special = nullptr);
    void check_lights();
    void drop_unread_occlusion();

    void set_buffer_aside(json& buffer, const TreePlace& place);
    void check_view(json& view, const TreePlace& place);
    void check_accessor(json& accessor, const TreePlace& place);
    void set_image_aside(json& image, const TreePlace& place);
    void check_mesh(json& mesh, const TreePlace& place);
    void check_camera(json& camera, const TreePlace& place);
    void check_light(json& light, const TreePlace& place);
    void check_node(json& node, const TreePlace& place);
    void check_animation(json& animation, const TreePlace& place);
    void check_channel_target(json& channel, const TreePlace& place);

    JsonReader reader_of(const json& object, const TreePlace& place) {
        return {object, place.text(), fault_};
    }

    json& tree_;
    Document& document_;
    Log& log_;
    JsonFault& fault_;
    TreeCounts counts_ = {};
    int added_view_ = 0;                 ///< placeholder_view
    std::vector<size_t> target_counts_;  ///< morph targets, by mesh
};

void Preflight::check_array(const char* key, const ObjectRules& rules, Special special) {
    if (fault_.error) return;
    const auto found = tree_.find(key);
    if (found == tree_.end()) return;
    JsonReader(tree_, "", fault_).count(key);
    if (fault_.error) return;
    TreeCheck check{counts_, fault_};
    const TreePlace array{nullptr, key};
    for (size_t i = 0; i < found->size() && !fault_.error; ++i) {
        json& element = (*found)[i];
        const TreePlace place{&array, {}, i};
        check_object(element, rules, place, check);
        if (special != nullptr && !fault_.error) (this->*special)(element, place);
    }
}

void Preflight::set_buffer_aside(json& buffer, const TreePlace& place) {
    GltfBuffer out;
    const auto uri = buffer.find("uri");
    if (uri != buffer.end()) out.uri = std::move(uri->get_ref<std::string&>());
    out.byte_length = buffer["byteLength"].get<uint64_t>();
    if (out.byte_length == 0) {
        reader_of(buffer, place)
            .fault("byteLength", "E-BUF-LENGTH", "the length must be 1 or more");
    }
    document_.buffers.push_back(std::move(out));
    buffer["byteLength"] = 1U;
    buffer["uri"] = placeholder_uri;
}

void Preflight::check_view(json& view, const TreePlace& place) {
    const auto found = view.find("byteStride");
    if (found == view.end()) return;
    const auto stride = found->get<uint64_t>();
    if (stride >= 4 && stride <= 252 && stride % 4 == 0) return;
    reader_of(view, place)
        .fault(
            "byteStride",
            "E-BUF-STRIDE",
            std::to_string(stride) + " is not accepted: a stride is a multiple of 4 from 4 to 252");
}

void check_component_type(const JsonReader& object) {
    const uint64_t value = object.size("componentType", 0);
    if (value >= 5120 && value <= 5126 && value != 5124) return;
    object.fault("componentType",
                 "E-ACC-TYPE",
                 std::to_string(value) +
                     " is not a component type; accepted are 5120, 5121, 5122, 5123, 5125, 5126");
}

void Preflight::check_accessor(json& accessor, const TreePlace& place) {
    constexpr std::string_view types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    const JsonReader reader = reader_of(accessor, place);
    check_component_type(reader);
    const std::string type = reader.text("type");
    if (std::find(std::begin(types), std::end(types), type) == std::end(types)) {
        reader.fault("type",
                     "E-ACC-TYPE",
                     "this is not an accessor type; accepted are SCALAR, VEC2, VEC3, VEC4, MAT2, "
                     "MAT3, MAT4");
    }
    if (accessor.contains("sparse")) {
        const JsonReader sparse = reader.child("sparse");
        // Both may be absent so far: what is in them is required.
        sparse.child("indices").require("bufferView");
        sparse.child("values").require("bufferView");
        if (!fault_.error) check_component_type(sparse.child("indices"));
    }
    std::array<double, 3> bound = {};
    if (type == "VEC3" && reader.numbers("min", bound)) reader.numbers("max", bound);
    if (!accessor.contains("bufferView")) accessor["bufferView"] = added_view_;
}

void Preflight::set_image_aside(json& image, const TreePlace& place) {
    GltfImage out;
    const auto uri = image.find("uri");
    const auto view = image.find("bufferView");
    if ((uri != image.end()) == (view != image.end())) {
        reader_of(image, place)
            .fault("", "E-DOC-IMAGE", "an image must have either a uri or a bufferView");
        return;
    }
    if (uri != image.end()) {
        out.uri = std::move(uri->get_ref<std::string&>());
        image.erase(uri);
    } else {
        out.view = view->get<int>();
    }
    image["bufferView"] = added_view_;
    document_.images.push_back(std::move(out));
}

/// "weights" of a mesh or node, checked against the number of its morph targets.
void check_morph_weights(const JsonReader& object, size_t target_count) {
    if (!object.has("weights")) return;
    std::vector<double> weights(object.count("weights"));
    if (weights.size() != target_count) {
        object.fault("weights",
                     "E-MESH-TARGETS",
                     "there are " + std::to_string(weights.size()) + " weights and " +
                         std::to_string(target_count) + " morph targets; they must agree");
        return;
    }
    object.numbers("weights", weights);
}

void Preflight::check_mesh(json& mesh, const TreePlace& place) {
    const json& primitives = mesh["primitives"];
    const size_t count = primitives.empty() ? 0 : array_size(primitives[0], "targets");
    target_counts_.push_back(count);
    if (mesh.contains("weights")) check_morph_weights(reader_of(mesh, place), count);
}

void Preflight::check_camera(json& camera, const TreePlace& place) {
    const std::string type = camera["type"].get<std::string>();
    const JsonReader reader = reader_of(camera, place);
    const bool perspective = type == "perspective";
    if (!perspective && type != "orthographic") {
        reader.fault("type", "E-CAM-TYPE", "accepted are perspective and orthographic");
        return;
    }
    reader.require(type);
    if (fault_.error) return;
    const TreePlace inside{&place, type};
    TreeCheck check{counts_, fault_};
    json& object = camera[type];
    check_object(object, perspective ? perspective_rules : orthographic_rules, inside, check);
    if (fault_.error || !perspective) return;
    // tinygltf says 0 where these are absent.
    const JsonReader lens = reader_of(object, inside);
    if (lens.number("aspectRatio", 1) == 0) {
        lens.fault("aspectRatio", "E-CAM-ASPECT", "the aspect ratio must be above 0");
    }
    if (lens.number("zfar", 1) == 0) {
        lens.fault("zfar", "E-CAM-CLIP", "zfar must be larger than znear");
    }
}

void Preflight::check_light(json& light, const TreePlace& place) {
    const auto range = light.find("range");
    if (range != light.end()) {
        GltfLight judged;
        judged.range = range->get<double>();
        if (!finish_range(judged)) {
            log_.warn(document_.at(place.text()),
                      "the range must be above 0; it is taken as unlimited");
            light.erase(range);
        }
    }
    if (light["type"] != "spot") return;
    if (!light.contains("spot")) light["spot"] = json::object();
    const TreePlace inside{&place, "spot"};
    TreeCheck check{counts_, fault_};
    json& spot = light["spot"];
    check_object(spot, spot_rules, inside, check);
    if (!fault_.error && !spot.contains("outerConeAngle")) spot["outerConeAngle"] = pi_d / 4;
}

void Preflight::check_lights() {
    json* extensions = object_in(tree_, "extensions");
    json* punctual = extensions == nullptr ? nullptr : object_in(*extensions, punctual_name);
    if (punctual == nullptr || fault_.error) return;
    const TreePlace top{nullptr, "extensions"};
    const TreePlace extension{&top, punctual_name};
    const TreePlace array{&extension, "lights"};
    if (reader_of(*punctual, extension).count("lights") == 0) return;
    TreeCheck check{counts_, fault_};
    json& lights = (*punctual)["lights"];
    for (size_t i = 0; i < lights.size() && !fault_.error; ++i) {
        const TreePlace place{&array, {}, i};
        check_object(lights[i], light_rules, place, check);
        if (!fault_.error) check_light(lights[i], place);
    }
}

void Preflight::check_node(json& node, const TreePlace& place) {
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale"))) {
        log_.warn(document_.at(place.text()),
                  "the node has a matrix and a translation, rotation or scale; the matrix counts");
    }
    const auto weights = node.find("weights");
    if (weights == node.end()) return;
    const auto mesh = node.find("mesh");
    if (mesh == node.end()) {
        node.erase(weights);
    } else {
        check_morph_weights(reader_of(node, place), target_counts_[mesh->get<size_t>()]);
    }
}

void Preflight::check_channel_target(json& channel, const TreePlace& place) {
    const JsonReader reader = reader_of(channel, place);
    reader.require("target");
    if (fault_.error) return;
    json& target = channel["target"];
    const TreePlace inside{&place, "target"};
    const JsonReader object = reader_of(target, inside);
    const bool points = object.has_extension(pointer_name);
    if (!points) object.require("path");
    if (fault_.error) return;
    // tinygltf insists on a node and a path, which a pointer stands for. Without a node nobody
    // looks at the path.
    if (points) target.erase("node");
    const bool has_node = target.contains("node");
    if (!has_node) target["path"] = "";
    TreeCheck check{counts_, fault_};
    check_object(target, channel_target_rules, inside, check);
    if (!fault_.error && !has_node) target["node"] = -1;
}

void Preflight::check_animation(json& animation, const TreePlace& place) {
    const auto channels = animation.find("channels");
    if (channels == animation.end()) return;
    const TreePlace array{&place, "channels"};
    for (size_t i = 0; i < channels->size() && !fault_.error; ++i)
        check_channel_target((*channels)[i], {&array, {}, i});
}

/// A texture that nobody looks up may be wrong; then tinygltf is not to see it.
void Preflight::drop_unread_occlusion() {
    const auto materials = tree_.find("materials");
    if (document_.reads_occlusion || materials == tree_.end() || !materials->is_array()) return;
    for (json& material : *materials) {
        if (!material.is_object() || !material.contains("occlusionTexture")) continue;
        JsonFault unheeded;
        TreeCheck check{counts_, unheeded};
        check_object(material["occlusionTexture"], occlusion_rules, {}, check);
        if (unheeded.error) material.erase("occlusionTexture");
    }
}

void Preflight::check() {
    for (size_t i = 1; i < counts_.size(); ++i)
        counts_[i] = array_size(tree_, tree_array_names[i].key);
    added_view_ = placeholder_view(tree_);
    drop_unread_occlusion();
    check_array("buffers", buffer_rules, &Preflight::set_buffer_aside);
    check_array("bufferViews", view_rules, &Preflight::check_view);
    check_array("accessors", accessor_rules, &Preflight::check_accessor);
    check_array("images", image_rules, &Preflight::set_image_aside);
    check_array("samplers", sampler_rules);
    check_array("textures", texture_rules);
    check_array("materials", material_rules);
    check_array("meshes", mesh_rules, &Preflight::check_mesh);
    check_array("skins", skin_rules);
    check_array("cameras", camera_rules, &Preflight::check_camera);
    check_lights();
    check_array("nodes", node_rules, &Preflight::check_node);
    check_array("animations", animation_rules, &Preflight::check_animation);
    check_array("scenes", scene_rules);
    if (fault_.error) return;
    TreeCheck check{counts_, fault_};
    check_object(tree_, root_rules, {}, check);
}

}  // namespace

void check_tree(json& tree, Document& document, Log& log, JsonFault& fault) {
    Preflight(tree, document, log, fault).check();
}

}  // namespace obscura::gltf
