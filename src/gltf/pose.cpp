// gltf/pose.cpp - poses a document: writes animated values at a time into it.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/pose.h"

#include "base/setting_names.h"
#include "gltf/parse/animation_pointer.h"
#include "gltf/parse/camera_extension.h"
#include "gltf/parse/finish_material.h"
#include "gltf/parse/trs.h"

#include <algorithm>
#include <charconv>
#include <numeric>

namespace obscura::gltf {

namespace {

void set_weights(int element,
                 const std::vector<double>& value,
                 size_t count,
                 std::vector<double>& weights) {
    weights.resize(count, 0.0);
    if (element < 0) {
        weights = value;
    } else {
        weights[static_cast<size_t>(element)] = value[0];
    }
}

void set_node_weights(int element,
                      const std::vector<double>& value,
                      Document& document,
                      GltfNode& node) {
    const GltfMesh& mesh = document.meshes[static_cast<size_t>(node.mesh)];
    if (node.weights.empty()) node.weights = mesh.weights;
    set_weights(element, value, mesh.target_count, node.weights);
}

/// The quaternion of a node or of an environment.
template <typename AnyDocument>
auto& quaternion_of(const AnimatedProperty& property, AnyDocument& document) {
    const auto target = static_cast<size_t>(property.target);
    return property.path == ChannelPath::rotation ? document.nodes[target].trs.rotation
                                                  : document.environments[target].rotation;
}

bool is_quaternion_element(const AnimatedProperty& property) {
    const bool turns = property.path == ChannelPath::rotation ||
                       property.path == ChannelPath::environment_rotation;
    return turns && property.element >= 0;
}

/// Brings a quaternion of which single numbers were written to length 1.
Result<void> finish_quaternion(const AnimatedProperty& property, Document& document) {
    const bool of_node = property.path == ChannelPath::rotation;
    const auto target = static_cast<size_t>(property.target);
    if (!normalize_quaternion(quaternion_of(property, document))) {
        const std::string place =
            of_node ? document.at("nodes", target)
                    : document.at("extensions/EXT_lights_image_based/lights", target);
        return fail(ExitCode::bad_data,
                    of_node ? "E-NODE-ROTATION" : "E-LIGHT-ROTATION",
                    place + "/rotation",
                    "the quaternion has no length");
    }
    if (of_node) {
        GltfNode& node = document.nodes[target];
        node.parent_from_node = affine_from_trs(node.trs);
    }
    return {};
}

/// What a camera has where one of its numbers is animated.
CameraGiven given_numbers(const AnimatedProperty& property, const GltfCamera& stored) {
    GltfCamera camera = stored;  // entries point into cameras that may be changed
    CameraGiven given{.aspect = camera.aspect != 0, .zfar = camera.zfar_m != 0};
    if (property.path != ChannelPath::camera) return given;
    const auto entries = camera.orthographic ? orthographic_entries : perspective_entries;
    const double* number = entries[static_cast<size_t>(property.entry)].numbers(camera).data();
    given.aspect = given.aspect || number == &camera.aspect;
    given.zfar = given.zfar || number == &camera.zfar_m;
    return given;
}

Result<void> finish_animated_camera(int number, const CameraGiven& given, Document& document) {
    const auto index = static_cast<size_t>(number);
    GltfCamera& camera = document.cameras[index];
    const std::string place = document.at("cameras", index) + "/";
    if (const auto fault = finish_camera(camera, given)) {
        const char* type = camera.orthographic ? "orthographic/" : "perspective/";
        return fail(ExitCode::bad_data, fault->id, place + type + fault->key, fault->message);
    }
    if (const auto wrong = clipping_fault(camera.settings)) {
        return fail(ExitCode::bad_data,
                    camera_value_id,
                    place + "extensions/" + camera_extension_name + "/far",
                    *wrong);
    }
    return {};
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

void Animator::add(Track track, const Document& document) {
    const AnimatedProperty& property = track.channel.property;
    switch (property.path) {
        case ChannelPath::material:
        case ChannelPath::texture_transform:
            has_materials_ = true;
            break;
        case ChannelPath::camera:
        case ChannelPath::lens:
        case ChannelPath::blades:
            cameras_.push_back(
                {property.target,
                 given_numbers(property, document.cameras[static_cast<size_t>(property.target)])});
            break;
        default:
            break;
    }
    if (is_quaternion_element(property)) {
        quaternions_.push_back({property, quaternion_of(property, document)});
    }
    tracks_.push_back(std::move(track));
}

Result<Animator> Animator::create(const Document& document,
                                  const BufferStore& buffers,
                                  const std::vector<int>& animations) {
    Animator out;
    for (const int number : animations) {
        const GltfAnimation& animation = document.animations[static_cast<size_t>(number)];
        for (const GltfChannel& channel : animation.channels) {
            const GltfAnimationSampler& sampler =
                animation.samplers[static_cast<size_t>(channel.sampler)];
            KeyframeKind kind{sampler.interpolation, channel.width, false};
            kind.quaternion = is_quaternion(channel.property);
            Result<Keyframes> keys = read_keyframes(document, buffers, sampler, kind);
            if (!keys) return fail(std::move(keys.error()));
            out.add({channel, std::move(*keys)}, document);
        }
    }
    return out;
}

bool Animator::plays() const {
    return std::any_of(
        tracks_.begin(), tracks_.end(), [](const Track& track) { return track.fixed.empty(); });
}

void Animator::set(const SetValue& wanted, const Document& document) {
    const auto known = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) {
        return !track.fixed.empty() && track.channel.property == wanted.channel.property;
    });
    if (known == tracks_.end()) {
        add({wanted.channel, {}, wanted.value}, document);
        return;
    }
    known->fixed = wanted.value;
    std::rotate(known, known + 1, tracks_.end());  // the latest one counts
}

bool Animator::mark(Document& document) const {
    bool is_new = false;
    const auto set_flag = [&](bool& flag) {
        is_new = is_new || !flag;
        flag = true;
    };
    for (const Track& track : tracks_) {
        const ChannelPath path = track.channel.property.path;
        const auto target = static_cast<size_t>(track.channel.property.target);
        if (path == ChannelPath::weights) set_flag(document.nodes[target].bends);
        if (path == ChannelPath::mesh_weights) set_flag(document.meshes[target].bends);
        if (moves_node(path) || path == ChannelPath::visible)
            set_flag(document.nodes[target].moves);
    }
    return is_new;
}

Result<void> Animator::apply(const Track& track, Document& document, double time_s) const {
    const std::vector<double> value =
        track.fixed.empty() ? sample(track.keys, time_s) : track.fixed;
    const AnimatedProperty& property = track.channel.property;
    const auto target = static_cast<size_t>(property.target);
    switch (property.path) {
        case ChannelPath::weights:
            set_node_weights(property.element, value, document, document.nodes[target]);
            return {};
        case ChannelPath::mesh_weights: {
            GltfMesh& mesh = document.meshes[target];
            set_weights(property.element, value, mesh.target_count, mesh.weights);
            return {};
        }
        case ChannelPath::visible:
            document.nodes[target].visible = value[0] >= 0.5;
            return {};
        default:
            break;
    }
    const Result<void> done = set_property(property, value, document);
    if (done && moves_node(property.path)) {
        GltfNode& node = document.nodes[target];
        node.parent_from_node = affine_from_trs(node.trs);
    }
    return done;
}

Result<void> Animator::pose(Document& document, double time_s) const {
    for (const Quaternion& quaternion : quaternions_)
        quaternion_of(quaternion.property, document) = quaternion.stored;
    Result<void> done;
    for (size_t i = 0; i < tracks_.size() && done; ++i)
        done = apply(tracks_[i], document, time_s);
    for (size_t i = 0; i < quaternions_.size() && done; ++i)
        done = finish_quaternion(quaternions_[i].property, document);
    for (size_t i = 0; i < cameras_.size() && done; ++i)
        done = finish_animated_camera(cameras_[i].number, cameras_[i].given, document);
    if (done && has_materials_) finish_materials(document);
    return done;
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
                    setting("animation"),
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

}  // namespace obscura::gltf
