// gltf/parse/document_animations.cpp - reads skins and animations.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_animations.h"

#include "gltf/parse/animation_pointer.h"
#include "gltf/parse/list_text.h"

namespace obscura::gltf {

namespace {

constexpr const char* pointer_name = "KHR_animation_pointer";

const GltfAccessor& accessor_of(const DocumentReading& reading, int accessor) {
    return reading.document.accessors[static_cast<size_t>(accessor)];
}

bool is_float(const GltfAccessor& accessor) {
    return accessor.component == ComponentType::float32 && !accessor.normalized;
}

/// Reads the animations of a document.
class AnimationReader {
public:
    explicit AnimationReader(DocumentReading& reading) : reading_(reading) {}

    void read(const tinygltf::Animation& file, const ModelElement& place, size_t index);
    void warn() const;

private:
    const Document& document() const { return reading_.document; }
    GltfAnimationSampler read_sampler(const tinygltf::AnimationSampler& file,
                                      const ModelElement& place) const;
    void read_channel(const tinygltf::AnimationChannel& file,
                      const ModelElement& place,
                      GltfAnimation& out);
    bool read_target(const tinygltf::AnimationChannel& file,
                     const ModelElement& place,
                     GltfChannel& out);
    bool set_property(const std::string& pointer, GltfChannel& out);
    bool read_pointer(const ModelElement& target, GltfChannel& out);
    bool read_node_target(const tinygltf::AnimationChannel& file, GltfChannel& out);
    bool finish_weights(GltfChannel& channel) const;
    void check_output(const ModelElement& place,
                      const GltfChannel& channel,
                      const GltfAnimationSampler& sampler) const;

    DocumentReading& reading_;
    std::vector<std::string> unknown_;  ///< pointers and paths that lead to nothing
    std::vector<std::string> fixed_;    ///< nodes with a matrix
};

GltfAnimationSampler AnimationReader::read_sampler(const tinygltf::AnimationSampler& file,
                                                   const ModelElement& place) const {
    GltfAnimationSampler out;
    out.input = file.input;
    out.output = file.output;
    if (file.interpolation == "STEP") {
        out.interpolation = Interpolation::step;
    } else if (file.interpolation == "CUBICSPLINE") {
        out.interpolation = Interpolation::cubic_spline;
    } else if (file.interpolation != "LINEAR") {
        place.fault("interpolation", "E-ANIM-MODE", "accepted are LINEAR, STEP and CUBICSPLINE");
    }
    const GltfAccessor& input = accessor_of(reading_, out.input);
    if (!is_float(input) || input.rows != 1 || input.columns != 1 || input.count == 0) {
        place.fault("input", "E-ANIM-INPUT", "accepted is SCALAR of float, one number or more");
    }
    return out;
}

/// Sets the width of a channel of weights; false: there are none to be changed.
bool AnimationReader::finish_weights(GltfChannel& channel) const {
    const AnimatedProperty& property = channel.property;
    int mesh = property.target;
    if (property.path == ChannelPath::weights) {
        mesh = document().nodes[static_cast<size_t>(property.target)].mesh;
    }
    if (mesh < 0) return false;
    const size_t count = document().meshes[static_cast<size_t>(mesh)].target_count;
    if (property.element >= 0) return static_cast<size_t>(property.element) < count;
    channel.width = count;
    return count != 0;
}

bool AnimationReader::set_property(const std::string& pointer, GltfChannel& out) {
    const std::optional<PointedProperty> found = find_property(document(), pointer);
    if (!found) {
        unknown_.push_back(pointer);
        return false;
    }
    out.property = found->property;
    out.width = found->width;
    return found->in_use;
}

bool AnimationReader::read_pointer(const ModelElement& target, GltfChannel& out) {
    const ValueReader object = target.extension(pointer_name);
    object.require("pointer");
    return set_property(object.text("pointer"), out);
}

bool AnimationReader::read_node_target(const tinygltf::AnimationChannel& file, GltfChannel& out) {
    const int node = file.target_node;
    if (node < 0) return false;  // glTF 2.0, animation.channel.target: to be ignored
    const std::string& path = file.target_path;
    if (path == "translation" || path == "rotation" || path == "scale" || path == "weights") {
        return set_property("/nodes/" + std::to_string(node) + "/" + path, out);
    }
    unknown_.push_back(path);
    return false;
}

/// False: the channel is left out.
bool AnimationReader::read_target(const tinygltf::AnimationChannel& file,
                                  const ModelElement& place,
                                  GltfChannel& out) {
    const ModelElement target = place.child("target", file.target_extensions);
    const bool points = target.has_extension(pointer_name);
    const bool known = points ? read_pointer(target, out) : read_node_target(file, out);
    if (!known || reading_.failed()) return false;
    const ChannelPath path = out.property.path;
    if (path == ChannelPath::weights || path == ChannelPath::mesh_weights) {
        if (finish_weights(out)) return true;
        unknown_.push_back(target.pointer());
        return false;
    }
    if (!moves_node(path)) return true;
    const int number = out.property.target;
    const GltfNode& node = document().nodes[static_cast<size_t>(number)];
    if (!node.has_matrix) return true;
    fixed_.push_back(node.name.empty() ? "node " + std::to_string(number) : node.name);
    return false;
}

/// The values must be of the type that the path asks for, and as many as there are times.
void AnimationReader::check_output(const ModelElement& place,
                                   const GltfChannel& channel,
                                   const GltfAnimationSampler& sampler) const {
    const GltfAccessor& input = accessor_of(reading_, sampler.input);
    const GltfAccessor& output = accessor_of(reading_, sampler.output);
    const ChannelPath path = channel.property.path;
    const bool weights = path == ChannelPath::weights || path == ChannelPath::mesh_weights;
    const bool pointed = !weights && !moves_node(path);
    const bool may_be_integer = path == ChannelPath::rotation || weights;
    const size_t rows = weights ? 1 : channel.width;
    const bool number_fits = pointed || is_float(output) || (may_be_integer && output.normalized);
    if (output.columns != 1 || static_cast<size_t>(output.rows) != rows || !number_fits) {
        place.fault("sampler",
                    "E-ANIM-OUTPUT",
                    "accessor " + std::to_string(sampler.output) +
                        " has not the type that the target asks for: " + std::to_string(rows) +
                        " components of float" +
                        (may_be_integer ? " or of normalized integers" : ""));
    }
    const uint64_t each = (weights ? channel.width : 1) *
                          (sampler.interpolation == Interpolation::cubic_spline ? 3U : 1U);
    if (output.count % each != 0 || output.count / each != input.count) {
        place.fault("sampler",
                    "E-ANIM-COUNT",
                    "accessor " + std::to_string(sampler.output) + " has " +
                        std::to_string(output.count) + " values; for " +
                        std::to_string(input.count) + " times it must have " +
                        std::to_string(each) + " for each");
    }
}

void AnimationReader::read_channel(const tinygltf::AnimationChannel& file,
                                   const ModelElement& place,
                                   GltfAnimation& out) {
    GltfChannel channel;
    channel.sampler = file.sampler;
    const size_t count = out.samplers.size();
    if (static_cast<size_t>(channel.sampler) >= count) {
        place.fault("sampler",
                    "E-DOC-INDEX",
                    "there is no animation sampler " + std::to_string(channel.sampler) +
                        ": the asset has " + std::to_string(count));
        return;
    }
    if (!read_target(file, place, channel)) return;
    check_output(place, channel, out.samplers[static_cast<size_t>(channel.sampler)]);
    out.channels.push_back(channel);
}

void AnimationReader::read(const tinygltf::Animation& file,
                           const ModelElement& place,
                           size_t index) {
    GltfAnimation out;
    out.name = name_or(file.name, "animation", index);
    for (size_t i = 0; i < file.samplers.size() && !reading_.failed(); ++i) {
        const tinygltf::AnimationSampler& sampler = file.samplers[i];
        out.samplers.push_back(read_sampler(
            sampler, place.child("samplers/" + std::to_string(i), sampler.extensions)));
    }
    for (size_t i = 0; i < file.channels.size() && !reading_.failed(); ++i) {
        const tinygltf::AnimationChannel& channel = file.channels[i];
        read_channel(
            channel, place.child("channels/" + std::to_string(i), channel.extensions), out);
    }
    reading_.document.animations.push_back(std::move(out));
}

void AnimationReader::warn() const {
    if (!unknown_.empty()) {
        reading_.log.warn(document().file,
                          "animation channels that lead to nothing that can be animated are not "
                          "played: " +
                              list_text(unknown_));
    }
    if (!fixed_.empty()) {
        reading_.log.warn(
            document().file,
            "nodes with a matrix cannot be animated; they stay as they are: " + list_text(fixed_));
    }
}

void check_inverse_bind_matrices(const DocumentReading& reading,
                                 const ModelElement& place,
                                 const GltfSkin& skin) {
    if (skin.inverse_bind_matrices < 0) return;
    const GltfAccessor& accessor = accessor_of(reading, skin.inverse_bind_matrices);
    if (!is_float(accessor) || accessor.rows != 4 || accessor.columns != 4) {
        place.fault("inverseBindMatrices", "E-SKIN-MATRICES", "accepted is MAT4 of float");
    }
    if (accessor.count < skin.joints.size()) {
        place.fault("inverseBindMatrices",
                    "E-SKIN-MATRICES",
                    "there are " + std::to_string(accessor.count) + " matrices for " +
                        std::to_string(skin.joints.size()) + " joints; each must have one");
    }
}

}  // namespace

void read_skins(DocumentReading& reading) {
    const auto read = [&](const tinygltf::Skin& skin, const ModelElement& place, size_t index) {
        GltfSkin out;
        out.name = name_or(skin.name, "skin", index);
        out.joints = skin.joints;
        if (out.joints.empty()) {
            place.fault("joints", "E-SKIN-JOINT", "a skin must have one joint or more");
        }
        out.inverse_bind_matrices = skin.inverseBindMatrices;
        check_inverse_bind_matrices(reading, place, out);
        reading.document.skins.push_back(std::move(out));
    };
    each_element(reading, "skins", reading.model.skins, read);
}

void read_animations(DocumentReading& reading) {
    AnimationReader reader(reading);
    each_element(reading,
                 "animations",
                 reading.model.animations,
                 [&](const tinygltf::Animation& animation, const ModelElement& place, size_t i) {
                     reader.read(animation, place, i);
                 });
    reader.warn();
}

}  // namespace obscura::gltf
