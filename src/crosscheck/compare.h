// crosscheck/compare.h - whether two answers about one ray agree, and how they differ.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

namespace obscura {

/// Where on a triangle, and how it lies, as Embree says it.
struct SaidPlace {
    double u = 0, v = 0;  ///< weights of the second and of the third corner
    Vec3d ng;             ///< in the triangle's own space, as long as two of its areas
    bool has_uv = false;
    bool has_ng = false;
};

/// What somebody says about a ray.
struct Answer {
    double t = INFINITY;
    Item item;
    bool any = false;      ///< occlusion: something is hit, and nobody says what
    SaidPlace place = {};  ///< judged by itself: see place_check.h

    bool found() const { return any || item.primitive >= 0; }
    bool operator==(const Answer& other) const {
        return t == other.t && item == other.item && any == other.any;
    }
};

inline Answer answer_of(const TrueHit& hit) {
    return {hit.t, hit.item};
}

/// From best to worst; `agree` to `edge_on` are within 4 ulp of an edge.
enum class Finding : int {
    agree,
    equal_depth,  ///< another item that is there too, within 4 ulp: neighbours on a common edge
                  ///< that the ray passes, surfaces in one place
    edge,         ///< different, and rays moved by at most 4 ulp have the other answer
    crack,        ///< within 4 ulp of an edge too, but no such ray has both answers: a ray that
                  ///< went between two neighbours
    edge_on,      ///< beside a triangle, but rounding decides on which side of two or three edges:
                  ///< seen edge-on, or past a sharp corner; through a piece of a line, but rounding
                  ///< decides whether the ray meets its cone: seen along its axis
    place,        ///< the item is there, but u, v or Ng are of another place or triangle
    item,         ///< something is there, but not the item that is named
    depth,        ///< the same item at another depth
    missed,       ///< not hit, or only behind the expected hit
    false_hit,    ///< hit where nothing is, or in front of the expected hit
};
inline constexpr size_t verdicts = 10;

/// How far from a ray the boxes of items may be whose edges can explain an occlusion.
inline constexpr double beside_ulps = 16;

struct Comparison {
    Finding verdict = Finding::agree;
    /// Of a difference: how far the ray must be moved to explain it; infinite: no explanation.
    double ulps = 0;
};

/// Compares `got` with `expected`.
///
/// Where depths agree and items do not, the item of `got` must be met by the ray itself or by one
/// at most edge_ulps away, at that depth.
///
/// The ulp is that of the largest number on the ray's way to the hit (TrueScene::rounding_m).
/// Depths agree when the two points are at most depth_ulps apart along the surface's normal. Any
/// other difference counts as `edge` when both answers are true for rays that are at most edge_ulps
/// away from this one, where it begins and where it hits. It counts as `crack` when no such ray has
/// the answer, but all that was passed by has an edge within edge_ulps, and what was hit is there
/// within edge_ulps or has an edge there; of occlusion, which says not what was hit, something must
/// have an edge within edge_ulps. A place where the cone and the ball of a line's piece touch
/// counts as such an edge where rounding does not tell them apart (PieceTest). It counts as
/// `edge_on` when the ray passes the edges' endless lines so closely that the signs on which
/// Embree's test (triangle_intersector_pluecker.h) is built are rounding alone: edge_ulps of the
/// edges' ends and the worst case of seven roundings.
Comparison compare(const TrueScene& scene,
                   const TrueRay& ray,
                   const Answer& expected,
                   const Answer& got);

}  // namespace obscura
