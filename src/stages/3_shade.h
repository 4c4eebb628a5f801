// stages/3_shade.h - stage 3: hits become radiance, shadow rays and the next rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/rows.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Groups that ask for far memory together: while one group's is on its way, the others are served.
inline constexpr int groups_ahead = 8;

/// The hits of one group at their paths' times; see hits_or_first.
///
/// In  rows: with hits, shared and time, as ShadeRows has them
template <typename Rows>
OBSCURA_INLINE HitLanes hits_of_paths(const Rows& rows, int i, Mask exists, const PathLanes& path) {
    HitLanes hit = hits_or_first(rows.hits, i, exists);
    hit.shared = rows.shared;
    if (rows.time != nullptr) {
        hit.time = gather<Lanes>(rows.time, select(exists, as_int(path.slot), LanesI(0)));
    }
    return hit;
}

/// One bounce of path tracing.
///
/// In      rows.paths, rows.hits: `count` rows of this bounce; number: 0 for camera rays
/// In/Out  rows.passed: by slot, see stages/3_walls.h
/// Out     rows.next, rows.shadows: at most `count` rows each, packed, one a slot; rows.samples:
///         emission and environment light are added
/// Units   radiance; distance m; pdf 1/sr
/// Errors  none
/// Source  Veach, PhD thesis, 1997, ch. 9 (multiple importance sampling), ch. 10.4 (roulette)
ShadeCounts shade(const SceneView& scene,
                  const BatchSettings& batch,
                  int number,
                  int count,
                  const ShadeRows& rows);

/// Ambient occlusion: one cosine-distributed ray of limited length a hit.
/// Returns the number of shadow rows.
int shade_ao(const SceneView& scene, const BatchSettings& batch, int count, const ShadeRows& rows);

/// First step of ray casting: parts hits from misses, and gives misses the background.
/// Returns the number of hits, which are now the first rows.
int begin_raycast(const SceneView& scene,
                  const BatchSettings& batch,
                  int count,
                  const ShadeRows& rows);

/// Light that reaches some of the hits from some of the lights: one shadow row for each pair, and
/// with the first light what needs none. Returns the number of shadow rows.
///
/// In      range: at most as many pairs as rows.shadows holds
/// Source  Appel, "Some Techniques for Shading Machine Renderings of Solids", AFIPS 1968
int shade_raycast(const SceneView& scene, const RaycastRange& range, const RaycastColumns& rows);

/// Quantities of the first hit (see Quantity), without light. Misses leave zero.
void write_quantity(const SceneView& scene,
                    const BatchSettings& batch,
                    Quantity quantity,
                    int count,
                    const AovColumns& rows);

/// How much of a line's width lies around each ray: the edges of triangles, and on analytic shapes
/// the lines on which u or v is a multiple of an eighth. Lines are batch.wire_width_px wide.
///
/// In      rows.paths, rows.hits: row i is pixel i of the batch, moved by batch.film_offset_px
/// Out     rows.samples: r = g = b in [0, 1]; a = 1 where something was hit
void write_wireframe(const SceneView& scene,
                     const BatchSettings& batch,
                     int count,
                     const AovColumns& rows);

/// Moves the hits together at the front of their columns, those of one primitive side by side where
/// that saves much (lanes that share a surface share its rows of tables), and the misses to
/// rows.misses.
struct SortedCounts {
    int hits = 0;
    int misses = 0;
};
SortedCounts sort_hits_from_misses(int count, const ShadeRows& rows);

}  // namespace OBSCURA_ISA
}  // namespace obscura
