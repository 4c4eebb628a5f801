// gltf/geometry/mesh_append.cpp - moves a primitive to the world, into the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_append.h"

#include "gltf/geometry/cofactors.h"
#include "gltf/parse/node_graph.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace obscura {

namespace {

constexpr size_t most_vertices = (1U << 29) - 1;  // four floats a vertex stay below 2^31
constexpr size_t most_words = (1U << 31) - 1;     // what an int32 offset reaches
constexpr float farthest_position = 1e18f;

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

/// Appends a block and returns the base that an absolute vertex number is added to.
int32_t append_block(LargeArray<float>& attributes,
                     const std::vector<float>& block,
                     size_t first_vertex,
                     size_t width) {
    if (block.empty()) return no_attribute;
    const auto base =
        static_cast<int64_t>(attributes.size()) - static_cast<int64_t>(first_vertex * width);
    attributes.insert(attributes.end(), block.begin(), block.end());
    return static_cast<int32_t>(base);
}

size_t attribute_floats(const MeshPart& part) {
    size_t out = part.normals.size() + part.tangents.size() + part.colors.size();
    for (const std::vector<float>& set : part.uvs)
        out += set.size();
    return out;
}

}  // namespace

bool bake_part(MeshPart& part, const Affined& world_from_mesh) {
    // What is flattened has no inside: its winding stays, whatever rounding makes of the volume.
    const bool mirrors = determinant(world_from_mesh) < 0 && !is_singular(world_from_mesh);
    const double sign = mirrors ? -1 : 1;
    const Affined normal_map = cofactors(world_from_mesh);
    for (size_t i = 0; i < part.positions.size(); i += 3) {
        float* p = &part.positions[i];
        const Vec3d moved = transform_point(world_from_mesh, Vec3d{p[0], p[1], p[2]});
        p[0] = static_cast<float>(moved.x);
        p[1] = static_cast<float>(moved.y);
        p[2] = static_cast<float>(moved.z);
        const bool near = std::abs(p[0]) <= farthest_position &&
                          std::abs(p[1]) <= farthest_position &&
                          std::abs(p[2]) <= farthest_position;
        if (!near) return false;
    }
    for (size_t i = 0; i < part.normals.size(); i += 3)
        turn(&part.normals[i], normal_map, sign);
    for (size_t i = 0; i < part.tangents.size(); i += 4) {
        turn(&part.tangents[i], world_from_mesh, 1);
        part.tangents[i + 3] *= static_cast<float>(sign);
    }
    if (sign < 0 && part.corners == 3) {
        for (size_t i = 0; i < part.indices.size(); i += 3) {
            std::swap(part.indices[i + 1], part.indices[i + 2]);
        }
    }
    return true;
}

const char* broken_limit(const ArraySizes& sizes) {
    if (sizes.vertices > most_vertices) return "E-LIMIT-VERTICES";
    if (sizes.corners > most_words) return "E-LIMIT-TRIANGLES";
    if (sizes.attribute_floats > most_words) return "E-LIMIT-ATTRIBUTES";
    return nullptr;
}

Result<Primitive> append_part(Scene& scene, const MeshPart& part, const std::string& where) {
    const size_t first_vertex = scene.positions.size() / 3;
    const char* limit = broken_limit({first_vertex + part.positions.size() / 3,
                                      scene.indices.size() + part.indices.size(),
                                      scene.attributes.size() + attribute_floats(part)});
    if (limit != nullptr) {
        return fail(ExitCode::refused,
                    limit,
                    where,
                    "the scene is too large for 32-bit numbers; accepted are 2^29 - 1 vertices, "
                    "2^31 - 1 triangle corners and 2^31 - 1 attribute floats");
    }
    Primitive out;
    out.first_triangle = static_cast<int32_t>(scene.indices.size() / 3);
    out.triangle_count = static_cast<int32_t>(part.indices.size() / 3);
    out.normal_base = append_block(scene.attributes, part.normals, first_vertex, 3);
    out.tangent_base = append_block(scene.attributes, part.tangents, first_vertex, 4);
    out.color_base = append_block(scene.attributes, part.colors, first_vertex, 4);
    for (size_t set = 0; set < part.uvs.size(); ++set) {
        out.uv_base[set] = append_block(scene.attributes, part.uvs[set], first_vertex, 2);
    }
    scene.positions.insert(scene.positions.end(), part.positions.begin(), part.positions.end());
    for (const uint32_t index : part.indices) {
        scene.indices.push_back(static_cast<uint32_t>(first_vertex) + index);
    }
    return out;
}

}  // namespace obscura
