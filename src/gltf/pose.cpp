// gltf/pose.cpp - writes the values of animations at a time into a document.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/pose.h"

#include "gltf/document_parts.h"
#include "gltf/trs.h"

#include <algorithm>
#include <charconv>
#include <numeric>

namespace obscura {

namespace {

using nlohmann::json;

constexpr const char* lights_name = "KHR_lights_punctual";

/// The parts that pointers change through their readers, and what those readers look at.
json readable_parts(const json& tree) {
    json out = json::object();
    for (const char* key : {"materials", "cameras", "textures"}) {
        if (tree.contains(key)) out[key] = tree[key];
    }
    const auto extensions = tree.find("extensions");
    if (extensions != tree.end() && extensions->contains(lights_name)) {
        out["extensions"][lights_name] = (*extensions)[lights_name];
    }
    return out;
}

void set_weights(const GltfChannel& channel,
                 const std::vector<double>& value,
                 size_t count,
                 std::vector<double>& weights) {
    weights.resize(count, 0.0);
    if (channel.element < 0) {
        weights = value;
    } else {
        weights[static_cast<size_t>(channel.element)] = value[0];
    }
}

/// A node's light profile.
void set_profile(const GltfChannel& channel, const std::vector<double>& value, GltfNode& node) {
    if (channel.path == ChannelPath::profile_multiplier) {
        node.ies.multiplier = std::max(value[0], 0.0);
        return;
    }
    for (size_t i = 0; i < 3; ++i)
        node.ies.color[i] = std::clamp(value[i], 0.0, 1.0);
}

void set_environment(const GltfChannel& channel,
                     const std::vector<double>& value,
                     GltfEnvironment& light) {
    if (channel.path == ChannelPath::environment_intensity) {
        light.intensity = std::max(value[0], 0.0);
        return;
    }
    std::copy_n(value.begin(), 4, light.rotation.begin());
}

void set_node(const GltfChannel& channel, const std::vector<double>& value, Document& document) {
    GltfNode& node = document.nodes[static_cast<size_t>(channel.target)];
    switch (channel.path) {
        case ChannelPath::translation:
            std::copy_n(value.begin(), 3, node.trs.translation.begin());
            break;
        case ChannelPath::rotation:
            std::copy_n(value.begin(), 4, node.trs.rotation.begin());
            break;
        case ChannelPath::scale:
            std::copy_n(value.begin(), 3, node.trs.scale.begin());
            break;
        case ChannelPath::profile_multiplier:
        case ChannelPath::profile_color:
            set_profile(channel, value, node);
            return;
        case ChannelPath::visible:
            node.visible = value[0] >= 0.5;
            return;
        default: {
            const GltfMesh& mesh = document.meshes[static_cast<size_t>(node.mesh)];
            if (node.weights.empty()) node.weights = mesh.weights;
            set_weights(channel, value, mesh.target_count, node.weights);
            return;
        }
    }
    node.parent_from_node = affine_from_trs(node.trs);
}

std::string list_animations(const Document& document) {
    if (document.animations.empty()) return "it has none";
    std::string out = "it has ";
    for (size_t i = 0; i < document.animations.size(); ++i) {
        out +=
            (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + document.animations[i].name + "\"";
    }
    return out;
}

std::vector<int> all_animations(const Document& document) {
    std::vector<int> out(document.animations.size());
    std::iota(out.begin(), out.end(), 0);
    return out;
}

}  // namespace

Result<Animator> Animator::create(const json& tree,
                                  const Document& document,
                                  const BufferStore& buffers,
                                  const std::vector<int>& animations) {
    Animator out;
    bool has_pointers = false;
    for (const int number : animations) {
        const GltfAnimation& animation = document.animations[static_cast<size_t>(number)];
        for (const GltfChannel& channel : animation.channels) {
            const GltfAnimationSampler& sampler =
                animation.samplers[static_cast<size_t>(channel.sampler)];
            KeyframeKind kind{sampler.interpolation, channel.width, false};
            kind.quaternion = is_quaternion(channel.path);
            Result<Keyframes> keys = read_keyframes(document, buffers, sampler, kind);
            if (!keys) return fail(std::move(keys.error()));
            out.tracks_.push_back({channel, std::move(*keys)});
            has_pointers = has_pointers || channel.path == ChannelPath::json;
        }
    }
    if (has_pointers) out.tree_ = readable_parts(tree);
    return out;
}

void Animator::mark(Document& document) const {
    for (const Track& track : tracks_) {
        const auto target = static_cast<size_t>(track.channel.target);
        switch (track.channel.path) {
            case ChannelPath::weights:
                document.nodes[target].bends = true;
                break;
            case ChannelPath::mesh_weights:
                document.meshes[target].bends = true;
                break;
            case ChannelPath::translation:
            case ChannelPath::rotation:
            case ChannelPath::scale:
            case ChannelPath::visible:
                document.nodes[target].moves = true;
                break;
            default:
                break;  // lights, cameras and materials
        }
    }
}

void Animator::apply(const Track& track, Document& document, double time_s) {
    const std::vector<double> value = sample(track.keys, time_s);
    const GltfChannel& channel = track.channel;
    if (channel.path == ChannelPath::json) {
        json& property = tree_[json::json_pointer(channel.pointer)];
        property = value.size() == 1 ? json(value[0]) : json(value);
    } else if (channel.path == ChannelPath::mesh_weights) {
        GltfMesh& mesh = document.meshes[static_cast<size_t>(channel.target)];
        set_weights(channel, value, mesh.target_count, mesh.weights);
    } else if (channel.path == ChannelPath::environment_intensity ||
               channel.path == ChannelPath::environment_rotation) {
        set_environment(channel, value, document.environments[static_cast<size_t>(channel.target)]);
    } else {
        set_node(channel, value, document);
    }
}

/// Materials, cameras and lights are read from the changed JSON as they were from the file's.
Result<void> Animator::read_again(Document& document) const {
    JsonFault fault;
    fault.file = document.file;
    Log silent(Verbosity::quiet);  // the file's own oddities have been told
    const JsonReader root(tree_, "", fault);
    DocumentReading reading{root, document, silent};
    document.materials.clear();
    document.cameras.clear();
    document.lights.clear();
    read_materials(reading);
    read_cameras(reading);
    read_lights(reading);
    if (fault.error) return fail(std::move(*fault.error));
    return {};
}

Result<void> Animator::pose(Document& document, double time_s) {
    for (const Track& track : tracks_)
        apply(track, document, time_s);
    return tree_.is_null() ? Result<void>{} : read_again(document);
}

Result<std::vector<int>> choose_animations(const Document& document,
                                           const std::optional<std::string>& choice,
                                           bool has_time) {
    const int count = static_cast<int>(document.animations.size());
    if (!choice) return has_time && count > 0 ? std::vector<int>{0} : std::vector<int>{};
    if (*choice == "none") return std::vector<int>{};
    if (*choice == "all") return all_animations(document);
    const auto refuse = [&](const char* id, const std::string& message) {
        return fail(ExitCode::usage,
                    id,
                    "--animation",
                    message + "; " + list_animations(document) + "; accepted are all and none too");
    };
    std::vector<int> named;
    for (int i = 0; i < count; ++i) {
        if (document.animations[static_cast<size_t>(i)].name == *choice) named.push_back(i);
    }
    if (named.size() == 1) return named;
    if (named.size() > 1) {
        return refuse("E-ANIM-AMBIGUOUS",
                      "several animations are called \"" + *choice + "\": give one's index");
    }
    int index = -1;
    const auto [end, error] =
        std::from_chars(choice->data(), choice->data() + choice->size(), index);
    const bool is_number = error == std::errc() && end == choice->data() + choice->size();
    if (is_number && index >= 0 && index < count) return std::vector<int>{index};
    return refuse("E-ANIM-UNKNOWN", "the asset has no animation \"" + *choice + "\"");
}

}  // namespace obscura
