// gltf/geometry/mesh_append.cpp - transforms a primitive and appends it to the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_append.h"

#include "gltf/geometry/cofactors.h"
#include "gltf/geometry/farthest_position.h"
#include "gltf/parse/node_graph.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace obscura::gltf {

namespace {

constexpr size_t max_vertices = (1U << 29) - 1;  // four floats a vertex stay below 2^31
constexpr size_t max_words = (1U << 31) - 1;     // what an int32 offset reaches
/// Transforms a direction in place and makes it unit; the zero vector stays.
void turn(float* v, const Affined& map, double sign) {
    const Vec3d turned = transform_vector(map, Vec3d{v[0], v[1], v[2]});
    const double length = std::hypot(turned.x, turned.y, turned.z);
    if (!(length > 0) || !std::isfinite(length)) return;
    const double scale = sign / length;
    v[0] = static_cast<float>(turned.x * scale);
    v[1] = static_cast<float>(turned.y * scale);
    v[2] = static_cast<float>(turned.z * scale);
}

/// Appends an attribute and returns the base that an absolute vertex number is added to.
int32_t append_attribute(LargeArray<float>& attributes,
                         const std::vector<float>& values,
                         size_t first_vertex,
                         size_t width) {
    if (values.empty()) return no_attribute;
    const auto base =
        static_cast<int64_t>(attributes.size()) - static_cast<int64_t>(first_vertex * width);
    attributes.insert(attributes.end(), values.begin(), values.end());
    return static_cast<int32_t>(base);
}

size_t attribute_floats(const MeshPrimitive& primitive) {
    size_t out = primitive.normals.size() + primitive.tangents.size() + primitive.colors.size();
    for (const std::vector<float>& set : primitive.uvs)
        out += set.size();
    return out;
}

}  // namespace

bool bake_primitive(MeshPrimitive& primitive, const Affined& world_from_mesh) {
    // A flattened mesh has no inside: it keeps its winding, whatever rounding makes of its volume.
    const bool mirrors = determinant(world_from_mesh) < 0 && !is_singular(world_from_mesh);
    const double sign = mirrors ? -1 : 1;
    const Affined normal_map = cofactors(world_from_mesh);
    for (size_t i = 0; i < primitive.positions.size(); i += 3) {
        float* p = &primitive.positions[i];
        const Vec3d moved = transform_point(world_from_mesh, Vec3d{p[0], p[1], p[2]});
        p[0] = static_cast<float>(moved.x);
        p[1] = static_cast<float>(moved.y);
        p[2] = static_cast<float>(moved.z);
        const bool near = std::abs(p[0]) <= farthest_position &&
                          std::abs(p[1]) <= farthest_position &&
                          std::abs(p[2]) <= farthest_position;
        if (!near) return false;
    }
    for (size_t i = 0; i < primitive.normals.size(); i += 3)
        turn(&primitive.normals[i], normal_map, sign);
    for (size_t i = 0; i < primitive.tangents.size(); i += 4) {
        turn(&primitive.tangents[i], world_from_mesh, 1);
        primitive.tangents[i + 3] *= static_cast<float>(sign);
    }
    if (sign < 0 && primitive.corners == 3) {
        for (size_t i = 0; i < primitive.indices.size(); i += 3) {
            std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
        }
    }
    return true;
}

const char* broken_limit(const ArraySizes& sizes) {
    if (sizes.vertices > max_vertices) return "E-LIMIT-VERTICES";
    if (sizes.corners > max_words) return "E-LIMIT-TRIANGLES";
    if (sizes.attribute_floats > max_words) return "E-LIMIT-ATTRIBUTES";
    return nullptr;
}

Result<Primitive> append_primitive(Scene& scene,
                                   const MeshPrimitive& primitive,
                                   const std::string& where) {
    const size_t first_vertex = scene.positions.size() / 3;
    const char* limit = broken_limit({first_vertex + primitive.positions.size() / 3,
                                      scene.indices.size() + primitive.indices.size(),
                                      scene.attributes.size() + attribute_floats(primitive)});
    if (limit != nullptr) {
        return fail(ExitCode::refused,
                    limit,
                    where,
                    "the scene is too large for 32-bit numbers; accepted are 2^29 - 1 vertices, "
                    "2^31 - 1 triangle corners and 2^31 - 1 attribute floats");
    }
    Primitive out;
    out.first_triangle = static_cast<int32_t>(scene.indices.size() / 3);
    out.triangle_count = static_cast<int32_t>(primitive.indices.size() / 3);
    out.normal_base = append_attribute(scene.attributes, primitive.normals, first_vertex, 3);
    out.tangent_base = append_attribute(scene.attributes, primitive.tangents, first_vertex, 4);
    out.color_base = append_attribute(scene.attributes, primitive.colors, first_vertex, 4);
    for (size_t set = 0; set < primitive.uvs.size(); ++set) {
        out.uv_base[set] = append_attribute(scene.attributes, primitive.uvs[set], first_vertex, 2);
    }
    scene.positions.insert(
        scene.positions.end(), primitive.positions.begin(), primitive.positions.end());
    for (const uint32_t index : primitive.indices) {
        scene.indices.push_back(static_cast<uint32_t>(first_vertex) + index);
    }
    return out;
}

}  // namespace obscura::gltf
