// gltf/geometry/deform.cpp - deforms a primitive: morph targets first, then its skin.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/deform.h"

#include "gltf/geometry/cofactors.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

constexpr size_t joints_in_set = 4;

constexpr uint32_t small_types = unsigned_types | signed_types;
constexpr AttributeRule target_position_rule = {
    "POSITION of a morph target", 3, 3, signed_types, signed_types, signed_types};
constexpr AttributeRule target_normal_rule = {
    "NORMAL of a morph target", 3, 3, signed_types, signed_types, signed_types};
constexpr AttributeRule target_tangent_rule = {
    "TANGENT of a morph target", 3, 3, signed_types, signed_types, signed_types};
constexpr AttributeRule target_uv_rule = {
    "TEXCOORD of a morph target", 2, 2, small_types, small_types, small_types};
constexpr AttributeRule target_color_rule = {
    "COLOR_0 of a morph target", 3, 4, small_types, small_types, 0};
constexpr AttributeRule weights_rule = {"WEIGHTS", 4, 4, unsigned_types, unsigned_types, 0};
constexpr AttributeRule joints_rule = {"JOINTS", 4, 4, 0, 0, 0, unsigned_types};

/// One attribute of the base mesh and where the morph targets have theirs.
struct MorphSource {
    int (*accessor)(const GltfAttributes&, size_t set);
    size_t set = 0;
    const AttributeRule& rule;
};

Result<void> morph_attribute(PrimitiveReader& reader,
                             std::span<const double> weights,
                             const MorphSource& from,
                             size_t value_width,
                             std::vector<float>& values) {
    if (values.empty()) return {};
    MorphSum sum;
    sum.value_width = value_width;
    const std::vector<GltfAttributes>& targets = reader.primitive().targets;
    for (size_t i = 0; i < std::min(weights.size(), targets.size()); ++i) {
        const int accessor = from.accessor(targets[i], from.set);
        if (weights[i] == 0 || accessor < 0) continue;
        const Result<std::vector<float>> read = read_attribute(reader, accessor, -1, from.rule);
        if (!read) return fail(read.error());
        if (sum.sums.empty()) sum.sums.assign(values.begin(), values.end());
        const GltfAccessor& record = reader.document.accessors[static_cast<size_t>(accessor)];
        sum.add(weights[i], *read, static_cast<size_t>(record.rows));
    }
    for (size_t i = 0; i < sum.sums.size(); ++i)
        values[i] = static_cast<float>(sum.sums[i]);
    return {};
}

Result<void> morph(PrimitiveReader& reader,
                   std::span<const double> weights,
                   MeshPrimitive& primitive) {
    using Attributes = const GltfAttributes&;
    const auto run = [&](const MorphSource& from, size_t width, std::vector<float>& values) {
        return morph_attribute(reader, weights, from, width, values);
    };
    Result<void> done =
        run({[](Attributes a, size_t) { return a.position; }, 0, target_position_rule},
            3,
            primitive.positions);
    if (done) {
        done = run({[](Attributes a, size_t) { return a.normal; }, 0, target_normal_rule},
                   3,
                   primitive.normals);
    }
    if (done) {
        done = run({[](Attributes a, size_t) { return a.tangent; }, 0, target_tangent_rule},
                   4,
                   primitive.tangents);
    }
    if (done) {
        done = run({[](Attributes a, size_t) { return a.color; }, 0, target_color_rule},
                   4,
                   primitive.colors);
    }
    for (size_t set = 0; set < primitive.uvs.size() && done; ++set) {
        done = run({[](Attributes a, size_t s) { return a.uv[s]; }, set, target_uv_rule},
                   2,
                   primitive.uvs[set]);
    }
    const auto has_color = [](Attributes target) { return target.color >= 0; };
    const std::vector<GltfAttributes>& targets = reader.primitive().targets;
    if (std::any_of(targets.begin(), targets.end(), has_color)) {
        // glTF 2.0, section 3.7.2.2; what is no number becomes 0
        for (float& color : primitive.colors)
            color = color > 0 ? std::min(color, 1.0F) : 0.0F;
    }
    return done;
}

/// Scales one vertex's weights to a sum of 1; false when they were wrong.
bool normalize_weights(std::span<float> weights) {
    constexpr double slack = 0.01;  // what 8-bit weights and careless exporters leave
    double sum = 0;
    bool good = true;
    for (float& weight : weights) {
        if (!(weight >= 0) || !std::isfinite(weight)) {
            good = false;
            weight = 0;
        }
        sum += double{weight};
    }
    if (!(sum > 0)) {
        weights[0] = 1;
        return false;
    }
    for (float& weight : weights)
        weight = static_cast<float>(weight / sum);
    return good && std::abs(sum - 1) <= slack;
}

/// The sets of JOINTS_n and WEIGHTS_n side by side.
Result<VertexJoints> read_joints(PrimitiveReader& reader, size_t vertices) {
    const GltfPrimitive& source = reader.primitive();
    const GltfAttributes& ids = source.draco_ids;
    const auto id_of = [](const std::vector<int>& numbers, size_t set) {
        return set < numbers.size() ? numbers[set] : -1;
    };
    VertexJoints out;
    const size_t sets = std::min(source.joints.size(), source.weights.size());
    out.influences = sets * joints_in_set;
    out.joints.resize(vertices * out.influences);
    out.weights.resize(vertices * out.influences);
    for (size_t set = 0; set < sets; ++set) {
        const Result<std::vector<float>> joints =
            read_attribute(reader, source.joints[set], id_of(ids.joints, set), joints_rule);
        if (!joints) return fail(joints.error());
        const Result<std::vector<float>> weights =
            read_attribute(reader, source.weights[set], id_of(ids.weights, set), weights_rule);
        if (!weights) return fail(weights.error());
        if (joints->empty() || weights->empty()) continue;
        for (size_t vertex = 0; vertex < vertices; ++vertex) {
            for (size_t i = 0; i < joints_in_set; ++i) {
                const size_t to = vertex * out.influences + set * joints_in_set + i;
                out.joints[to] = static_cast<uint32_t>((*joints)[vertex * joints_in_set + i]);
                out.weights[to] = (*weights)[vertex * joints_in_set + i];
            }
        }
    }
    return out;
}

Result<void> check_joints(PrimitiveReader& reader, size_t joint_count, VertexJoints& joints) {
    const size_t vertices = joints.weights.size() / joints.influences;
    for (size_t vertex = 0; vertex < vertices; ++vertex) {
        const size_t first = vertex * joints.influences;
        if (!normalize_weights(std::span(joints.weights).subspan(first, joints.influences))) {
            reader.issues |= issue_bit(MeshIssue::bad_weights);
        }
        for (size_t i = first; i < first + joints.influences; ++i) {
            if (joints.weights[i] == 0 || joints.joints[i] < joint_count) continue;
            return reader.bad("E-SKIN-JOINT",
                              "a vertex hangs on joint " + std::to_string(joints.joints[i]) +
                                  ", but the skin has only " + std::to_string(joint_count));
        }
    }
    return {};
}

Result<void> skin(PrimitiveReader& reader,
                  std::span<const Affined> world_from_bind,
                  MeshPrimitive& primitive) {
    const GltfPrimitive& source = reader.primitive();
    if (source.joints.empty() || source.weights.empty() || source.joints[0] < 0 ||
        source.weights[0] < 0) {
        primitive.issues |= issue_bit(MeshIssue::no_joints);
        return {};
    }
    Result<VertexJoints> joints = read_joints(reader, primitive.positions.size() / 3);
    if (!joints) return fail(std::move(joints.error()));
    const Result<void> checked = check_joints(reader, world_from_bind.size(), *joints);
    if (!checked) return checked;
    skin_primitive(*joints, world_from_bind, primitive);
    return {};
}

Affined mean_matrix(const VertexJoints& from,
                    size_t vertex,
                    std::span<const Affined> world_from_bind) {
    Affined out = {{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}};
    for (size_t i = vertex * from.influences; i < (vertex + 1) * from.influences; ++i) {
        const double weight = double{from.weights[i]};
        if (weight == 0) continue;
        const Affined& joint = world_from_bind[from.joints[i]];
        for (size_t r = 0; r < 3; ++r) {
            for (size_t c = 0; c < 4; ++c)
                out.m[r][c] += weight * joint.m[r][c];
        }
    }
    return out;
}

void store(const Vec3d& v, float* out) {
    out[0] = static_cast<float>(v.x);
    out[1] = static_cast<float>(v.y);
    out[2] = static_cast<float>(v.z);
}

/// Transforms a direction in place; one that the matrix flattens becomes 0.
void turn(const Affined& map, double sign, float* v) {
    const Vec3d turned = transform_vector(map, Vec3d{v[0], v[1], v[2]});
    const double length = std::hypot(turned.x, turned.y, turned.z);
    const bool squashed = !(length > 0) || !std::isfinite(length);
    store(squashed ? Vec3d{0, 0, 0} : turned * (sign / length), v);
}

}  // namespace

void MorphSum::add(double weight, std::span<const float> differences, size_t difference_width) {
    const size_t used = std::min(difference_width, value_width);
    const size_t vertices = sums.size() / value_width;
    for (size_t vertex = 0; vertex < vertices; ++vertex) {
        for (size_t i = 0; i < used; ++i) {
            sums[vertex * value_width + i] +=
                weight * double{differences[vertex * difference_width + i]};
        }
    }
}

void skin_primitive(const VertexJoints& from,
                    std::span<const Affined> world_from_bind,
                    MeshPrimitive& primitive) {
    const size_t vertices = primitive.positions.size() / 3;
    size_t mirrored = 0;
    for (size_t vertex = 0; vertex < vertices; ++vertex) {
        const Affined world = mean_matrix(from, vertex, world_from_bind);
        const double sign = determinant(world) < 0 ? -1 : 1;
        mirrored += sign < 0 ? 1U : 0U;
        float* p = &primitive.positions[3 * vertex];
        store(transform_point(world, Vec3d{p[0], p[1], p[2]}), p);
        if (!primitive.normals.empty())
            turn(cofactors(world), sign, &primitive.normals[3 * vertex]);
        if (primitive.tangents.empty()) continue;
        turn(world, 1, &primitive.tangents[4 * vertex]);
        primitive.tangents[4 * vertex + 3] *= static_cast<float>(sign);
    }
    primitive.in_world = true;
    if (2 * mirrored <= vertices) return;
    for (size_t i = 0; i < primitive.indices.size(); i += 3)
        std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
}

Result<void> deform_primitive(PrimitiveReader& reader,
                              const PrimitivePose& pose,
                              MeshPrimitive& primitive) {
    const bool morphs = !reader.primitive().targets.empty();
    const bool has_skin = !pose.world_from_bind.empty();
    if (!morphs && !has_skin) return {};
    primitive.is_deformed = true;
    Result<void> done;
    if (morphs) done = morph(reader, pose.weights, primitive);
    if (done && has_skin) done = skin(reader, pose.world_from_bind, primitive);
    return done;
}

}  // namespace obscura::gltf
