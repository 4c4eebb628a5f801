// crosscheck/truth_records.h - converts scene records for the search in double.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

namespace obscura::crosscheck {

/// World space from a line segment's: lines are always in world space.
inline Affined world_from(const SegmentFrame<double>& frame) {
    Affined out;
    const Vec3d columns[4] = {
        frame.axes.tangent, frame.axes.normal, -frame.axes.bitangent, frame.centre};
    for (int c = 0; c < 4; ++c) {
        out.m[0][c] = columns[c].x;
        out.m[1][c] = columns[c].y;
        out.m[2][c] = columns[c].z;
    }
    return out;
}

inline Vec3f corner(const Scene& scene, size_t index) {
    const float* p = &scene.positions[3 * static_cast<size_t>(scene.indices[index])];
    return {p[0], p[1], p[2]};
}

/// Corners of a mesh's triangle, in the mesh's space.
inline Triangle<float> corners_of(const Scene& scene, const Item& item) {
    const Primitive& primitive = scene.primitives[static_cast<size_t>(item.primitive)];
    const size_t first = 3 * static_cast<size_t>(primitive.first_triangle + item.element);
    return {corner(scene, first), corner(scene, first + 1), corner(scene, first + 2)};
}

inline Triangle<double> in_double(const Triangle<float>& t) {
    return {{t.a.x, t.a.y, t.a.z}, {t.b.x, t.b.y, t.b.z}, {t.c.x, t.c.y, t.c.z}};
}

}  // namespace obscura::crosscheck
