// gltf/geometry/mesh_shading.cpp - a primitive's normals and tangents: checked or made.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_shading.h"

#include "gltf/geometry/tangents.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obscura {

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
Vec3d triangle_normal(const MeshPart& part, size_t triangle) {
    const Vec3d a = load3(part.positions, part.indices[3 * triangle]);
    const Vec3d b = load3(part.positions, part.indices[3 * triangle + 1]);
    const Vec3d c = load3(part.positions, part.indices[3 * triangle + 2]);
    return cross(b - a, c - a);
}

/// Unit vector; a zero or broken one becomes +Z.
Vec3d unit_or_z(const Vec3d& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0) || !std::isfinite(length)) return {0, 0, 1};
    return v * (1.0 / length);
}

/// Makes normals unit; returns which vertices have none that can be used.
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
void repair_normals(MeshPart& part) {
    const std::vector<char> bad = normalize_normals(part.normals);
    const auto is_bad = [&](uint32_t vertex) { return bad[vertex] != 0; };
    if (std::none_of(part.indices.begin(), part.indices.end(), is_bad)) return;
    part.issues |= issue_bit(MeshIssue::bad_normals);
    std::vector<double> sums(part.normals.size(), 0.0);
    for (size_t corner = 0; corner < part.indices.size(); ++corner) {
        const size_t vertex = part.indices[corner];
        if (bad[vertex] == 0) continue;
        const Vec3d n = triangle_normal(part, corner / 3);
        sums[3 * vertex] += n.x;
        sums[3 * vertex + 1] += n.y;
        sums[3 * vertex + 2] += n.z;
    }
    for (size_t i = 0; i < bad.size(); ++i) {
        if (bad[i] == 0) continue;
        store3(part.normals, i, unit_or_z({sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]}));
    }
}

/// Makes given tangents unit, w 1 or -1; false when one that is used has no length.
bool normalize_tangents(MeshPart& part) {
    std::vector<char> bad(part.tangents.size() / 4, 0);
    for (size_t i = 0; i < bad.size(); ++i) {
        float* t = &part.tangents[4 * i];
        const double length = std::hypot(t[0], t[1], t[2]);
        bad[i] = !(length > 1e-12) || !std::isfinite(length);
        for (int axis = 0; axis < 3; ++axis) {
            t[axis] = bad[i] != 0 ? 0.0f : static_cast<float>(t[axis] / length);
        }
        t[3] = t[3] < 0 ? -1.0f : 1.0f;
    }
    const auto is_bad = [&](uint32_t vertex) { return bad[vertex] != 0; };
    return std::none_of(part.indices.begin(), part.indices.end(), is_bad);
}

void append_copy(std::vector<float>& values, size_t vertex, size_t width) {
    for (size_t i = 0; i < width && !values.empty(); ++i) {
        values.push_back(values[vertex * width + i]);
    }
}

/// Doubles a vertex with all its attributes but the tangent.
uint32_t append_vertex(MeshPart& part, size_t vertex) {
    append_copy(part.positions, vertex, 3);
    append_copy(part.normals, vertex, 3);
    append_copy(part.colors, vertex, 4);
    for (std::vector<float>& set : part.uvs)
        append_copy(set, vertex, 2);
    return static_cast<uint32_t>(part.positions.size() / 3 - 1);
}

/// Gives every corner its own vertex.
void unweld(MeshPart& part) {
    const auto spread = [&](std::vector<float>& values, size_t width) {
        if (values.empty()) return;
        std::vector<float> out;
        out.reserve(part.indices.size() * width);
        for (const uint32_t vertex : part.indices) {
            const float* from = &values[vertex * width];
            out.insert(out.end(), from, from + width);
        }
        values = std::move(out);
    };
    spread(part.positions, 3);
    spread(part.normals, 3);
    spread(part.colors, 4);
    for (std::vector<float>& set : part.uvs)
        spread(set, 2);
    for (size_t i = 0; i < part.indices.size(); ++i)
        part.indices[i] = static_cast<uint32_t>(i);
}

/// Gives every triangle its own normal.
void make_flat(MeshPart& part) {
    unweld(part);
    part.normals.resize(part.positions.size());
    for (size_t i = 0; i < part.indices.size(); ++i) {
        store3(part.normals, i, unit_or_z(triangle_normal(part, i / 3)));
    }
}

/// Turns tangents of corners into tangents of vertices: a vertex whose corners disagree is doubled.
void weld_tangents(MeshPart& part, const std::vector<float>& corners) {
    constexpr uint32_t none = UINT32_MAX;
    constexpr int longest_search = 64;  // beyond it, vertices are doubled without looking
    const size_t vertices = part.positions.size() / 3;
    std::vector<uint32_t> next(vertices, none);  // other copies of the same vertex
    std::vector<char> taken(vertices, 0);
    part.tangents.assign(vertices * 4, 0.0f);
    for (size_t corner = 0; corner < part.indices.size(); ++corner) {
        const float* tangent = &corners[4 * corner];
        const auto agrees = [&](uint32_t vertex) {
            return taken[vertex] == 0 ||
                   std::equal(tangent, tangent + 4, &part.tangents[4 * vertex]);
        };
        const uint32_t first = part.indices[corner];
        uint32_t vertex = first;
        for (int i = 0; vertex != none && !agrees(vertex) && i < longest_search; ++i) {
            vertex = next[vertex];
        }
        if (vertex == none || !agrees(vertex)) {
            vertex = append_vertex(part, first);
            part.tangents.resize(part.tangents.size() + 4);
            next.push_back(next[first]);
            taken.push_back(0);
            next[first] = vertex;
        }
        taken[vertex] = 1;
        std::copy(tangent, tangent + 4, &part.tangents[4 * static_cast<size_t>(vertex)]);
        part.indices[corner] = vertex;
    }
}

/// The UVs through the texture's transform: tangents follow the picture as it lies on the surface.
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

void finish_shading(MeshPart& part, const MaterialNeeds& needs) {
    if (!part.normals.empty()) repair_normals(part);
    if (!needs.tangents) {
        part.tangents.clear();
        return;
    }
    if (!part.tangents.empty()) {
        if (normalize_tangents(part)) return;
        part.issues |= issue_bit(MeshIssue::bad_tangents);
    }
    const auto uv_set = static_cast<size_t>(needs.normal_map.uv_set);
    if (part.uvs[uv_set].empty()) {  // nothing says which way they would point
        part.tangents.clear();
        return;
    }
    if (part.normals.empty()) make_flat(part);
    const std::vector<float> uvs = transformed_uvs(part.uvs[uv_set], needs.normal_map);
    const TangentMesh mesh{part.positions, part.normals, uvs, part.indices};
    std::vector<float> corners = make_tangents(mesh);
    if (!part.keeps_layout) {
        weld_tangents(part, corners);
        return;
    }
    unweld(part);  // which corners may share a vertex would change from pose to pose
    part.tangents = std::move(corners);
}

}  // namespace obscura
