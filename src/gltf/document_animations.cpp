// gltf/document_animations.cpp - reads skins and animations.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation_pointer.h"
#include "gltf/document_parts.h"
#include "gltf/list_text.h"

namespace obscura {

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

    void read(const JsonReader& object, size_t index);
    void warn() const;

private:
    const Document& document() const { return reading_.document; }
    GltfAnimationSampler read_sampler(const JsonReader& object) const;
    void read_channel(const JsonReader& object, GltfAnimation& out);
    bool read_target(const JsonReader& object, GltfChannel& out);
    bool read_pointer(const JsonReader& target, GltfChannel& out);
    bool read_node_target(const JsonReader& target, GltfChannel& out);
    bool finish_weights(GltfChannel& channel) const;
    void check_output(const JsonReader& object,
                      const GltfChannel& channel,
                      const GltfAnimationSampler& sampler) const;

    DocumentReading& reading_;
    std::vector<std::string> unknown_;  ///< pointers and paths that lead to nothing
    std::vector<std::string> fixed_;    ///< nodes with a matrix
};

GltfAnimationSampler AnimationReader::read_sampler(const JsonReader& object) const {
    const size_t accessor_count = reading_.root.count("accessors");
    GltfAnimationSampler out;
    object.require("input");
    object.require("output");
    out.input = object.index("input", accessor_count, "accessor");
    out.output = object.index("output", accessor_count, "accessor");
    const std::string mode = object.text("interpolation", "LINEAR");
    if (mode == "STEP") {
        out.interpolation = Interpolation::step;
    } else if (mode == "CUBICSPLINE") {
        out.interpolation = Interpolation::cubic_spline;
    } else if (mode != "LINEAR") {
        object.fault("interpolation", "E-ANIM-MODE", "accepted are LINEAR, STEP and CUBICSPLINE");
    }
    if (reading_.root.failed()) return out;
    const GltfAccessor& input = accessor_of(reading_, out.input);
    if (!is_float(input) || input.rows != 1 || input.columns != 1 || input.count == 0) {
        object.fault("input", "E-ANIM-INPUT", "accepted is SCALAR of float, one number or more");
    }
    return out;
}

/// Sets the width of a channel of weights; false: there are none to be changed.
bool AnimationReader::finish_weights(GltfChannel& channel) const {
    int mesh = channel.target;
    if (channel.path == ChannelPath::weights) {
        mesh = document().nodes[static_cast<size_t>(channel.target)].mesh;
    }
    if (mesh < 0) return false;
    const size_t count = document().meshes[static_cast<size_t>(mesh)].target_count;
    if (channel.element >= 0) return static_cast<size_t>(channel.element) < count;
    channel.width = count;
    return count != 0;
}

bool AnimationReader::read_pointer(const JsonReader& target, GltfChannel& out) {
    const JsonReader object = target.extension(pointer_name);
    object.require("pointer");
    const std::string pointer = object.text("pointer");
    const std::optional<PointedProperty> found = find_property(reading_.root.object(), pointer);
    if (!found) {
        unknown_.push_back(pointer);
        return false;
    }
    out.path = found->path;
    out.width = found->width;
    out.element = found->element;
    if (found->path == ChannelPath::json) {
        out.pointer = pointer;
    } else {
        out.target = found->target;
    }
    return found->in_use;
}

bool AnimationReader::read_node_target(const JsonReader& target, GltfChannel& out) {
    out.target = target.index("node", document().nodes.size(), "node");
    if (out.target < 0) return false;  // glTF 2.0, animation.channel.target: to be ignored
    const std::string path = target.text("path");
    out.width = path == "rotation" ? 4 : 3;
    if (path == "translation") {
        out.path = ChannelPath::translation;
    } else if (path == "rotation") {
        out.path = ChannelPath::rotation;
    } else if (path == "scale") {
        out.path = ChannelPath::scale;
    } else if (path == "weights") {
        out.path = ChannelPath::weights;
    } else {
        unknown_.push_back(path);
        return false;
    }
    return true;
}

/// False: the channel is left out.
bool AnimationReader::read_target(const JsonReader& object, GltfChannel& out) {
    object.require("target");
    const JsonReader target = object.child("target");
    const bool points = target.has_extension(pointer_name);
    if (!points && !reading_.root.failed()) target.require("path");
    const bool known = points ? read_pointer(target, out) : read_node_target(target, out);
    if (!known || reading_.root.failed()) return false;
    if (out.path == ChannelPath::weights || out.path == ChannelPath::mesh_weights) {
        if (finish_weights(out)) return true;
        unknown_.push_back(target.pointer());
        return false;
    }
    const bool moves = out.path == ChannelPath::translation || out.path == ChannelPath::rotation ||
                       out.path == ChannelPath::scale;
    if (!moves) return true;
    const GltfNode& node = document().nodes[static_cast<size_t>(out.target)];
    if (!node.has_matrix) return true;
    fixed_.push_back(node.name.empty() ? "node " + std::to_string(out.target) : node.name);
    return false;
}

/// The values must be of the type that the path asks for, and as many as there are times.
void AnimationReader::check_output(const JsonReader& object,
                                   const GltfChannel& channel,
                                   const GltfAnimationSampler& sampler) const {
    const GltfAccessor& input = accessor_of(reading_, sampler.input);
    const GltfAccessor& output = accessor_of(reading_, sampler.output);
    const bool weights =
        channel.path == ChannelPath::weights || channel.path == ChannelPath::mesh_weights;
    const bool pointed = !weights && channel.path > ChannelPath::scale;
    const bool may_be_integer = channel.path == ChannelPath::rotation || weights;
    const size_t rows = weights ? 1 : channel.width;
    const bool number_fits = pointed || is_float(output) || (may_be_integer && output.normalized);
    if (output.columns != 1 || static_cast<size_t>(output.rows) != rows || !number_fits) {
        object.fault("sampler",
                     "E-ANIM-OUTPUT",
                     "accessor " + std::to_string(sampler.output) +
                         " has not the type that the target asks for: " + std::to_string(rows) +
                         " components of float" +
                         (may_be_integer ? " or of normalized integers" : ""));
    }
    const uint64_t each = (weights ? channel.width : 1) *
                          (sampler.interpolation == Interpolation::cubic_spline ? 3U : 1U);
    if (output.count % each != 0 || output.count / each != input.count) {
        object.fault("sampler",
                     "E-ANIM-COUNT",
                     "accessor " + std::to_string(sampler.output) + " has " +
                         std::to_string(output.count) + " values; for " +
                         std::to_string(input.count) + " times it must have " +
                         std::to_string(each) + " for each");
    }
}

void AnimationReader::read_channel(const JsonReader& object, GltfAnimation& out) {
    GltfChannel channel;
    object.require("sampler");
    channel.sampler = object.index("sampler", out.samplers.size(), "animation sampler");
    if (!read_target(object, channel) || channel.sampler < 0) return;
    check_output(object, channel, out.samplers[static_cast<size_t>(channel.sampler)]);
    out.channels.push_back(std::move(channel));
}

void AnimationReader::read(const JsonReader& object, size_t index) {
    GltfAnimation out;
    out.name = object.text("name");
    if (out.name.empty()) out.name = "animation " + std::to_string(index);
    object.each("samplers", [&](const JsonReader& sampler, size_t) {
        out.samplers.push_back(read_sampler(sampler));
    });
    object.each("channels", [&](const JsonReader& channel, size_t) {
        if (!reading_.root.failed()) read_channel(channel, out);
    });
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

void read_inverse_bind_matrices(const DocumentReading& reading,
                                const JsonReader& skin,
                                GltfSkin& out) {
    out.inverse_bind_matrices =
        skin.index("inverseBindMatrices", reading.root.count("accessors"), "accessor");
    if (out.inverse_bind_matrices < 0 || reading.root.failed()) return;
    const GltfAccessor& accessor = accessor_of(reading, out.inverse_bind_matrices);
    if (!is_float(accessor) || accessor.rows != 4 || accessor.columns != 4) {
        skin.fault("inverseBindMatrices", "E-SKIN-MATRICES", "accepted is MAT4 of float");
    }
    if (accessor.count < out.joints.size()) {
        skin.fault("inverseBindMatrices",
                   "E-SKIN-MATRICES",
                   "there are " + std::to_string(accessor.count) + " matrices for " +
                       std::to_string(out.joints.size()) + " joints; each must have one");
    }
}

}  // namespace

void read_skins(DocumentReading& reading) {
    const size_t node_count = reading.root.count("nodes");
    reading.root.each("skins", [&](const JsonReader& skin, size_t index) {
        GltfSkin out;
        out.name = skin.text("name");
        if (out.name.empty()) out.name = "skin " + std::to_string(index);
        skin.require("joints");
        out.joints = skin.indices("joints", node_count, "node");
        if (out.joints.empty()) {
            skin.fault("joints", "E-SKIN-JOINT", "a skin must have one joint or more");
        }
        skin.index("skeleton", node_count, "node");  // a hint for editors: it changes nothing
        read_inverse_bind_matrices(reading, skin, out);
        reading.document.skins.push_back(std::move(out));
    });
}

void read_animations(DocumentReading& reading) {
    if (reading.root.failed()) return;
    AnimationReader reader(reading);
    reading.root.each("animations", [&](const JsonReader& animation, size_t index) {
        if (!reading.root.failed()) reader.read(animation, index);
    });
    reader.warn();
}

}  // namespace obscura
