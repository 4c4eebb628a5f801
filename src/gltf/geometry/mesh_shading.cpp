// gltf/geometry/mesh_shading.cpp - checks a primitive's normals and tangents, or makes them.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_shading.h"

#include "gltf/geometry/tangents.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obscura::gltf {

namespace {

Vec3d load3(const std::vector<float>& values, size_t index) {
    return {values[3 * index], values[3 * index + 1], values[3 * index + 2]};
}

void store3(std::vector<float>& values, size_t index, const Vec3d& v) {
    values[3 * index] = static_cast<float>(v.x);
    values[3 * index + 1] = static_cast<float>(v.y);
    values[3 * index + 2] = static_cast<float>(v.z);
}

/// Twice the area as a vector; positions up to 1e18 do not overflow in double.
Vec3d triangle_normal(const MeshPrimitive& primitive, size_t triangle) {
    const Vec3d a = load3(primitive.positions, primitive.indices[3 * triangle]);
    const Vec3d b = load3(primitive.positions, primitive.indices[3 * triangle + 1]);
    const Vec3d c = load3(primitive.positions, primitive.indices[3 * triangle + 2]);
    return cross(b - a, c - a);
}

/// Unit vector; a zero or broken one becomes +Z.
Vec3d unit_or_z(const Vec3d& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0) || !std::isfinite(length)) return {0, 0, 1};
    return v * (1.0 / length);
}

/// Makes normals unit; returns the vertices without a usable normal.
std::vector<char> normalize_normals(std::vector<float>& normals) {
    std::vector<char> bad(normals.size() / 3, 0);
    for (size_t i = 0; i < bad.size(); ++i) {
        const Vec3d n = load3(normals, i);
        const double length = std::hypot(n.x, n.y, n.z);
        bad[i] = !(length > 1e-12) || !std::isfinite(length);
        store3(normals, i, bad[i] != 0 ? Vec3d{0, 0, 0} : n * (1.0 / length));
    }
    return bad;
}

/// Gives bad normals the area-weighted mean of the triangles around.
void repair_normals(MeshPrimitive& primitive) {
    const std::vector<char> bad = normalize_normals(primitive.normals);
    const auto is_bad = [&](uint32_t vertex) { return bad[vertex] != 0; };
    if (std::none_of(primitive.indices.begin(), primitive.indices.end(), is_bad)) return;
    primitive.issues |= issue_bit(MeshIssue::bad_normals);
    std::vector<double> sums(primitive.normals.size(), 0.0);
    for (size_t corner = 0; corner < primitive.indices.size(); ++corner) {
        const size_t vertex = primitive.indices[corner];
        if (bad[vertex] == 0) continue;
        const Vec3d n = triangle_normal(primitive, corner / 3);
        sums[3 * vertex] += n.x;
        sums[3 * vertex + 1] += n.y;
        sums[3 * vertex + 2] += n.z;
    }
    for (size_t i = 0; i < bad.size(); ++i) {
        if (bad[i] == 0) continue;
        store3(primitive.normals, i, unit_or_z({sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]}));
    }
}

/// Makes given tangents unit, w 1 or -1; false when one that is used has no length.
bool normalize_tangents(MeshPrimitive& primitive) {
    std::vector<char> bad(primitive.tangents.size() / 4, 0);
    for (size_t i = 0; i < bad.size(); ++i) {
        float* t = &primitive.tangents[4 * i];
        const double length = std::hypot(t[0], t[1], t[2]);
        bad[i] = !(length > 1e-12) || !std::isfinite(length);
        for (int axis = 0; axis < 3; ++axis) {
            t[axis] = bad[i] != 0 ? 0.0f : static_cast<float>(t[axis] / length);
        }
        t[3] = t[3] < 0 ? -1.0f : 1.0f;
    }
    const auto is_bad = [&](uint32_t vertex) { return bad[vertex] != 0; };
    return std::none_of(primitive.indices.begin(), primitive.indices.end(), is_bad);
}

void append_copy(std::vector<float>& values, size_t vertex, size_t width) {
    for (size_t i = 0; i < width && !values.empty(); ++i) {
        values.push_back(values[vertex * width + i]);
    }
}

/// Doubles a vertex with all its attributes but the tangent.
uint32_t append_vertex(MeshPrimitive& primitive, size_t vertex) {
    append_copy(primitive.positions, vertex, 3);
    append_copy(primitive.normals, vertex, 3);
    append_copy(primitive.colors, vertex, 4);
    for (std::vector<float>& set : primitive.uvs)
        append_copy(set, vertex, 2);
    return static_cast<uint32_t>(primitive.positions.size() / 3 - 1);
}

/// Gives every corner its own vertex.
void unweld(MeshPrimitive& primitive) {
    const auto spread = [&](std::vector<float>& values, size_t width) {
        if (values.empty()) return;
        std::vector<float> out;
        out.reserve(primitive.indices.size() * width);
        for (const uint32_t vertex : primitive.indices) {
            const float* from = &values[vertex * width];
            out.insert(out.end(), from, from + width);
        }
        values = std::move(out);
    };
    spread(primitive.positions, 3);
    spread(primitive.normals, 3);
    spread(primitive.colors, 4);
    for (std::vector<float>& set : primitive.uvs)
        spread(set, 2);
    for (size_t i = 0; i < primitive.indices.size(); ++i)
        primitive.indices[i] = static_cast<uint32_t>(i);
}

/// Gives every triangle its own normal.
void make_flat(MeshPrimitive& primitive) {
    unweld(primitive);
    primitive.normals.resize(primitive.positions.size());
    for (size_t i = 0; i < primitive.indices.size(); ++i) {
        store3(primitive.normals, i, unit_or_z(triangle_normal(primitive, i / 3)));
    }
}

/// Turns tangents of corners into tangents of vertices: a vertex whose corners disagree is doubled.
void weld_tangents(MeshPrimitive& primitive, const std::vector<float>& corners) {
    constexpr uint32_t none = UINT32_MAX;
    constexpr int longest_search = 64;  // beyond it, vertices are doubled without looking
    const size_t vertices = primitive.positions.size() / 3;
    std::vector<uint32_t> next(vertices, none);  // other copies of the same vertex
    std::vector<char> taken(vertices, 0);
    primitive.tangents.assign(vertices * 4, 0.0f);
    for (size_t corner = 0; corner < primitive.indices.size(); ++corner) {
        const float* tangent = &corners[4 * corner];
        const auto agrees = [&](uint32_t vertex) {
            return taken[vertex] == 0 ||
                   std::equal(tangent, tangent + 4, &primitive.tangents[4 * vertex]);
        };
        const uint32_t first = primitive.indices[corner];
        uint32_t vertex = first;
        for (int i = 0; vertex != none && !agrees(vertex) && i < longest_search; ++i) {
            vertex = next[vertex];
        }
        if (vertex == none || !agrees(vertex)) {
            vertex = append_vertex(primitive, first);
            primitive.tangents.resize(primitive.tangents.size() + 4);
            next.push_back(next[first]);
            taken.push_back(0);
            next[first] = vertex;
        }
        taken[vertex] = 1;
        std::copy(tangent, tangent + 4, &primitive.tangents[4 * static_cast<size_t>(vertex)]);
        primitive.indices[corner] = vertex;
    }
}

/// The UVs through the texture's transform: tangents follow the image as it lies on the surface.
std::vector<float> transformed_uvs(const std::vector<float>& uvs, const TextureSlot& slot) {
    std::vector<float> out(uvs.size());
    const float* m = slot.uv_from_mesh;
    for (size_t i = 0; i < uvs.size(); i += 2) {
        out[i] = m[0] * uvs[i] + m[1] * uvs[i + 1] + m[2];
        out[i + 1] = m[3] * uvs[i] + m[4] * uvs[i + 1] + m[5];
    }
    return out;
}

}  // namespace

void finish_shading(MeshPrimitive& primitive, const MaterialNeeds& needs) {
    if (!primitive.normals.empty()) repair_normals(primitive);
    if (!needs.tangents) {
        primitive.tangents.clear();
        return;
    }
    if (!primitive.tangents.empty()) {
        if (normalize_tangents(primitive)) return;
        primitive.issues |= issue_bit(MeshIssue::bad_tangents);
    }
    const auto uv_set = static_cast<size_t>(needs.normal_map.uv_set);
    if (primitive.uvs[uv_set].empty()) {  // nothing says which way they would point
        primitive.tangents.clear();
        return;
    }
    if (primitive.normals.empty()) make_flat(primitive);
    const std::vector<float> uvs = transformed_uvs(primitive.uvs[uv_set], needs.normal_map);
    const TangentMesh mesh{primitive.positions, primitive.normals, uvs, primitive.indices};
    std::vector<float> corners = make_tangents(mesh);
    if (!primitive.is_deformed) {
        weld_tangents(primitive, corners);
        return;
    }
    unweld(primitive);  // which corners may share a vertex would change from pose to pose
    primitive.tangents = std::move(corners);
}

}  // namespace obscura::gltf
