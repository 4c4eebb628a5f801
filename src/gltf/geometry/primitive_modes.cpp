// gltf/geometry/primitive_modes.cpp - turns vertices in order into points, lines, triangles.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/primitive_modes.h"

#include <utility>

namespace obscura::gltf {

namespace {

/// Pairs of neighbours, or of every second vertex and its neighbour.
ElementList line_list(const std::vector<uint32_t>& order, int mode) {
    ElementList out;
    const size_t step = mode == lines_mode ? 2 : 1;
    out.leftover = order.size() < 2 || (mode == lines_mode && order.size() % 2 != 0);
    const auto add = [&](uint32_t from, uint32_t to) {
        if (from != to) out.vertices.insert(out.vertices.end(), {from, to});
    };
    for (size_t i = 0; i + 1 < order.size(); i += step)
        add(order[i], order[i + 1]);
    if (mode == line_loop_mode && order.size() > 1) add(order.back(), order.front());
    return out;
}

}  // namespace

uint64_t triangle_count(int mode, uint64_t vertex_count) {
    if (mode == triangles_mode) return vertex_count / 3;
    return mode > triangles_mode && vertex_count > 2 ? vertex_count - 2 : 0;
}

ElementList element_list(std::vector<uint32_t> order, int mode) {
    if (mode == points_mode) return {std::move(order), false};
    if (is_point_or_line_mode(mode)) return line_list(order, mode);
    const size_t triangles = triangle_count(mode, order.size());
    if (mode == triangles_mode) {
        const bool leftover = order.size() % 3 != 0;
        order.resize(triangles * 3);
        return {std::move(order), leftover};
    }
    ElementList out;
    out.leftover = triangles == 0;
    out.vertices.reserve(triangles * 3);
    for (size_t i = 0; i < triangles; ++i) {
        uint32_t a = mode == triangle_strip_mode ? order[i] : order[0];
        uint32_t b = order[i + 1];
        uint32_t c = order[i + 2];
        // glTF 2.0 section 3.7.2.1: i, i+2, i+1
        if (mode == triangle_strip_mode && i % 2 == 1) std::swap(b, c);
        if (a == b || b == c || a == c) continue;
        out.vertices.insert(out.vertices.end(), {a, b, c});
    }
    return out;
}

}  // namespace obscura::gltf
