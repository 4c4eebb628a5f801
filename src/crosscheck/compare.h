// crosscheck/compare.h - compares two answers about one ray and classifies differences.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

namespace obscura::crosscheck {

/// A position on a triangle, and the triangle's normal, as Embree returns them.
struct SaidPlace {
    double u = 0, v = 0;  ///< weights of the second and of the third corner
    Vec3d ng;             ///< in the triangle's own space; its length is twice the area
    bool has_uv = false;
    bool has_ng = false;
};

/// One answer about a ray.
struct Answer {
    double t = INFINITY;
    Item item;
    bool any = false;      ///< occlusion: something is hit, without its name
    SaidPlace place = {};  ///< judged separately: see place_check.h

    bool found() const { return any || item.primitive >= 0; }
    bool operator==(const Answer& other) const {
        return t == other.t && item == other.item && any == other.any;
    }
};

inline Answer answer_of(const TrueHit& hit) {
    return {hit.t, hit.item};
}

/// From best to worst; `agree` to `edge_on` are within 4 ulp of an edge.
enum class Verdict : int {
    agree,
    equal_depth,  ///< another item that is there too, within 4 ulp: neighbours on a common edge
                  ///< that the ray passes, or coincident surfaces
    edge,         ///< different, and rays moved by at most 4 ulp have the other answer
    crack,        ///< within 4 ulp of an edge too, but no such ray has both answers: a ray that
                  ///< went between two neighbours
    edge_on,      ///< beside a triangle, but rounding decides on which side of two or three edges:
                  ///< seen edge-on, or past a sharp corner; through a curve segment, but rounding
                  ///< decides whether the ray meets its cone: seen along its axis
    place,        ///< the item is there, but u, v or Ng belong to another position or triangle
    item,         ///< something is there, but not the named item
    depth,        ///< the same item at another depth
    missed,       ///< no hit, or only behind the expected one
    false_hit,    ///< a hit where nothing is, or in front of the expected one
};
inline constexpr size_t verdict_count = 10;

/// Largest distance from a ray to boxes of items whose edges can explain an occlusion.
inline constexpr double beside_ulps = 16;

struct Comparison {
    Verdict verdict = Verdict::agree;
    /// How far the ray must be moved to explain a difference; infinite: no explanation.
    double ulps = 0;
};

/// Compares `got` with `expected`.
///
/// When depths agree and items differ, the item of `got` must be met at that depth by the ray
/// itself or by one at most edge_ulps away.
///
/// The ulp is that of the largest number on the ray's way to the hit (TrueScene::rounding_m).
/// Depths agree when the two points are at most depth_ulps apart along the surface's normal. Any
/// other difference counts as `edge` when both answers are true for rays that are at most edge_ulps
/// away from this one, where it begins and where it hits. It counts as `crack` when no such ray has
/// the answer, but all that was passed by has an edge within edge_ulps, and what was hit is there
/// within edge_ulps or has an edge there. Occlusion does not say what was hit: any item with an
/// edge within edge_ulps explains it. The seam between the cone and the end cap of a curve segment
/// counts as such an edge where rounding does not tell them apart (SegmentRounding). It counts as
/// `edge_on` when the ray passes the edges' infinite lines so closely that the signs on which
/// Embree's test (triangle_intersector_pluecker.h) is built are rounding alone: edge_ulps of the
/// edges' ends and the worst case of seven roundings.
Comparison compare(const TrueScene& scene,
                   const TrueRay& ray,
                   const Answer& expected,
                   const Answer& got);

}  // namespace obscura::crosscheck
