// gltf/geometry/instancing.cpp - EXT_mesh_gpu_instancing: one node places its mesh many times.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/instancing.h"

#include "gltf/parse/trs.h"

namespace obscura::gltf {

namespace {

constexpr const char* instancing_name = "EXT_mesh_gpu_instancing";

/// Reads one attribute's accessor index and checks that accessor's type.
int read_transform_accessor(const DocumentReading& reading,
                            const ValueReader& attributes,
                            const char* name) {
    const std::vector<GltfAccessor>& accessors = reading.document.accessors;
    const int number = attributes.index(name, accessors.size(), "accessor");
    if (number < 0) return number;
    const GltfAccessor& accessor = accessors[static_cast<size_t>(number)];
    const bool rotation = std::string_view(name) == "ROTATION";
    const bool small =
        accessor.component == ComponentType::int8 || accessor.component == ComponentType::int16;
    const bool type_fits = (accessor.component == ComponentType::float32 && !accessor.normalized) ||
                           (rotation && small && accessor.normalized);
    if (accessor.columns != 1 || accessor.rows != (rotation ? 4 : 3) || !type_fits) {
        attributes.fault(name,
                         "E-NODE-INSTANCING",
                         rotation ? "accepted is VEC4 of float, or of normalized bytes or shorts"
                                  : "accepted is VEC3 of float");
    }
    return number;
}

/// The number of instances; 0 also where no attribute tells it.
uint64_t instance_count(const Document& document, const GltfInstancing& instancing) {
    for (const int number : {instancing.translation, instancing.rotation, instancing.scale}) {
        if (number >= 0) return document.accessors[static_cast<size_t>(number)].count;
    }
    return 0;
}

/// Reads the transforms of one node, instance by instance.
class TransformReader {
public:
    Result<void> read(const Document& document,
                      const BufferStore& buffers,
                      const GltfInstancing& instancing) {
        const auto fill = [&](int number, std::vector<float>& out) -> Result<void> {
            if (number < 0) return {};
            Result<std::vector<float>> values = read_floats(document, buffers, number, {});
            if (!values) return fail(std::move(values.error()));
            out = std::move(*values);
            return {};
        };
        Result<void> done = fill(instancing.translation, translations_);
        if (done) done = fill(instancing.rotation, rotations_);
        if (done) done = fill(instancing.scale, scales_);
        return done;
    }

    /// False: the rotation has no length.
    bool transform(size_t instance, Affined& out) const {
        std::array<double, 3> translation = {0, 0, 0};
        std::array<double, 4> rotation = {0, 0, 0, 1};
        std::array<double, 3> scale = {1, 1, 1};
        take(translations_, instance, translation);
        take(rotations_, instance, rotation);
        take(scales_, instance, scale);
        if (!normalize_quaternion(rotation)) return false;
        out = affine_from_trs(translation, rotation, scale);
        return true;
    }

private:
    template <size_t width>
    static void take(const std::vector<float>& from,
                     size_t instance,
                     std::array<double, width>& out) {
        if (from.empty()) return;
        for (size_t i = 0; i < width; ++i)
            out[i] = from[instance * width + i];
    }

    std::vector<float> translations_, rotations_, scales_;
};

Result<void> add_instances(const Document& document,
                           const BufferStore& buffers,
                           const PlacedNode& placed_node,
                           std::vector<PlacedNode>& out) {
    const size_t index = static_cast<size_t>(placed_node.node);
    const GltfInstancing& instancing = document.nodes[index].instancing;
    const uint64_t count = instance_count(document, instancing);
    if (count > max_instances || out.size() > max_instances - count) {
        return fail(ExitCode::refused,
                    "E-LIMIT-INSTANCES",
                    document.at("nodes", index),
                    "the nodes place more than " + std::to_string(max_instances) + " meshes");
    }
    TransformReader reader;
    const Result<void> done = reader.read(document, buffers, instancing);
    if (!done) return done;
    out.reserve(out.size() + count);
    for (uint64_t i = 0; i < count; ++i) {
        Affined node_from_instance;
        if (!reader.transform(i, node_from_instance)) {
            return fail(ExitCode::bad_data,
                        "E-NODE-INSTANCING",
                        document.at("nodes", index),
                        "the rotation of instance " + std::to_string(i) + " has no length");
        }
        out.push_back(placed_node);
        out.back().node_from_mesh = node_from_instance;
        out.back().world_from_node = compose(placed_node.world_from_node, node_from_instance);
    }
    return {};
}

}  // namespace

bool is_instanced(const GltfInstancing& instancing) {
    return instancing.translation >= 0 || instancing.rotation >= 0 || instancing.scale >= 0;
}

GltfInstancing read_instancing(const DocumentReading& reading, const ModelElement& node) {
    GltfInstancing out;
    if (!node.has_extension(instancing_name)) return out;
    const ValueReader object = node.extension(instancing_name);
    object.require("attributes");
    const ValueReader attributes = object.child("attributes");
    out.translation = read_transform_accessor(reading, attributes, "TRANSLATION");
    out.rotation = read_transform_accessor(reading, attributes, "ROTATION");
    out.scale = read_transform_accessor(reading, attributes, "SCALE");
    const uint64_t count = instance_count(reading.document, out);
    for (const int number : {out.translation, out.rotation, out.scale}) {
        if (number < 0) continue;
        const uint64_t other = reading.document.accessors[static_cast<size_t>(number)].count;
        if (other == count) continue;
        attributes.fault("",
                         "E-NODE-INSTANCING",
                         "the accessors have " + std::to_string(count) + " and " +
                             std::to_string(other) + " elements; they must agree");
    }
    return out;
}

Result<std::vector<PlacedNode>> expand_instances(const Document& document,
                                                 const BufferStore& buffers,
                                                 const std::vector<PlacedNode>& placed) {
    std::vector<PlacedNode> out;
    out.reserve(placed.size());
    for (const PlacedNode& placed_node : placed) {
        const GltfNode& node = document.nodes[static_cast<size_t>(placed_node.node)];
        if (node.mesh < 0 || !placed_node.may_show) continue;
        if (!is_instanced(node.instancing)) {
            out.push_back(placed_node);
            continue;
        }
        const Result<void> done = add_instances(document, buffers, placed_node, out);
        if (!done) return fail(done.error());
    }
    return out;
}

}  // namespace obscura::gltf
