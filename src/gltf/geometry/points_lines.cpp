// gltf/geometry/points_lines.cpp - glTF points become spheres, lines become round curves.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/points_lines.h"

#include "gltf/geometry/mesh_append.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

constexpr float unset_radius = 1;

/// Vertices of a primitive, in the order in which they get the numbers from `first` on.
struct NumberedVertices {
    std::vector<uint32_t> vertices;
    size_t first = 0;
};

/// Appends an attribute of `width` floats a vertex; returns its base.
int32_t append_attribute(Scene& scene,
                         const std::vector<float>& values,
                         size_t width,
                         const NumberedVertices& numbered) {
    if (values.empty()) return no_attribute;
    const int64_t base = static_cast<int64_t>(scene.attributes.size()) -
                         static_cast<int64_t>(numbered.first * width);
    for (const uint32_t vertex : numbered.vertices) {
        const auto from = values.begin() + static_cast<std::ptrdiff_t>(size_t{vertex} * width);
        scene.attributes.insert(
            scene.attributes.end(), from, from + static_cast<std::ptrdiff_t>(width));
    }
    return static_cast<int32_t>(base);
}

void append_attributes(Scene& scene,
                       const MeshPrimitive& primitive,
                       const NumberedVertices& numbered,
                       Primitive& out) {
    out.color_base = append_attribute(scene, primitive.colors, 4, numbered);
    out.normal_base = append_attribute(scene, primitive.normals, 3, numbered);
    for (size_t set = 0; set < primitive.uvs.size(); ++set)
        out.uv_base[set] = append_attribute(scene, primitive.uvs[set], 2, numbered);
}

Primitive append_points(Scene& scene, const MeshPrimitive& primitive, SphereOrders* orders) {
    std::vector<float> positions;
    positions.reserve(primitive.indices.size() * 3);
    for (const uint32_t vertex : primitive.indices) {
        const float* p = &primitive.positions[size_t{vertex} * 3];
        positions.insert(positions.end(), p, p + 3);
    }
    const ParticleRange range = append_spheres(positions, {unset_radius}, scene, orders);
    NumberedVertices numbered{{}, static_cast<size_t>(range.first)};
    for (const uint32_t point : range.order)
        numbered.vertices.push_back(primitive.indices[point]);
    Primitive out;
    out.geometry = static_cast<int32_t>(GeometryKind::spheres);
    out.first_triangle = range.first;
    out.triangle_count = range.count;
    append_attributes(scene, primitive, numbered, out);
    return out;
}

/// Consecutive segments share a point, so that Embree knows that they are connected.
Primitive append_lines(Scene& scene, const MeshPrimitive& primitive) {
    const auto position = [&](uint32_t vertex) { return &primitive.positions[size_t{vertex} * 3]; };
    const size_t first = scene.curve_points.size() / 4;
    Primitive out;
    out.geometry = static_cast<int32_t>(GeometryKind::curves);
    out.first_triangle = static_cast<int32_t>(scene.curve_segments.size());
    std::vector<uint32_t> vertices;
    const auto add_point = [&](uint32_t vertex) {
        const float* p = position(vertex);
        scene.curve_points.insert(scene.curve_points.end(), {p[0], p[1], p[2], unset_radius});
        vertices.push_back(vertex);
    };
    for (size_t i = 0; i + 1 < primitive.indices.size(); i += 2) {
        const uint32_t from = primitive.indices[i];
        const uint32_t to = primitive.indices[i + 1];
        if (std::equal(position(from), position(from) + 3, position(to))) continue;
        if (vertices.empty() || vertices.back() != from) add_point(from);
        const size_t point = first + vertices.size() - 1;
        scene.curve_segments.push_back(static_cast<uint32_t>(point));
        add_point(to);
        ++out.triangle_count;
    }
    append_attributes(scene, primitive, {vertices, first}, out);
    return out;
}

}  // namespace

Result<Primitive> append_points_lines(Scene& scene,
                                      const MeshPrimitive& primitive,
                                      const std::string& where,
                                      SphereOrders* orders) {
    const bool points = primitive.corners == 1;
    const size_t added = primitive.indices.size();
    if (points && added > max_spheres - scene.spheres.size() / 4) {
        return fail(
            ExitCode::refused, "E-LIMIT-SPHERES", where, "at most 2^29 spheres are accepted");
    }
    const size_t vertices = points ? 0 : scene.curve_points.size() / 4 + added;
    size_t width = (primitive.colors.empty() ? 0 : 4) + (primitive.normals.empty() ? 0 : 3);
    for (const std::vector<float>& uvs : primitive.uvs)
        width += uvs.empty() ? 0 : 2;
    const size_t floats = scene.attributes.size() + added * width;
    const char* limit = broken_limit({vertices, 0, floats});
    if (limit != nullptr) {
        return fail(ExitCode::refused,
                    limit,
                    where,
                    "the scene is too large for 32-bit numbers; accepted are 2^29 - 1 points on "
                    "lines and 2^31 - 1 attribute floats");
    }
    const Primitive out =
        points ? append_points(scene, primitive, orders) : append_lines(scene, primitive);
    (points ? scene.info.points_in_world : scene.info.line_segments_in_world) +=
        static_cast<size_t>(out.triangle_count);
    return out;
}

}  // namespace obscura::gltf
