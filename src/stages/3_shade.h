// stages/3_shade.h - stage 3: hits become radiance, shadow rays and the next rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/column_lanes.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Number of groups whose memory is prefetched together, so that their waits overlap.
inline constexpr int groups_ahead = 8;

/// The hits of one group at their paths' times; see hits_or_first.
///
/// In  columns: with hits, shared and time, as ShadeColumns has them
template <typename Columns>
OBSCURA_INLINE HitLanes
hits_of_paths(const Columns& columns, int i, Mask exists, const PathLanes& path) {
    HitLanes hit = hits_or_first(columns.hits, i, exists);
    hit.shared = columns.shared;
    if (columns.time != nullptr) {
        hit.time = gather<Lanes>(columns.time, select(exists, as_int(path.slot), LanesI(0)));
    }
    return hit;
}

/// One bounce of path tracing.
///
/// In      columns.paths, columns.hits: `count` paths of this bounce; number: 0 for camera rays
/// In/Out  columns.distance_since_scattering: by sample index, see stages/3_thin_walls.h
/// Out     columns.next, columns.shadows: packed, at most `count` each and one per sample;
///         columns.samples: emission and environment light are added
/// Units   radiance; distance m; pdf 1/sr
/// Errors  none
/// Source  Veach, PhD thesis, 1997, ch. 9 (multiple importance sampling), ch. 10.4 (roulette)
ShadeCounts shade(const SceneView& scene,
                  const BatchSettings& batch,
                  int number,
                  int count,
                  const ShadeColumns& columns);

/// Ambient occlusion: one cosine-distributed ray of limited length per hit.
/// Returns the number of shadow rays.
int shade_ao(const SceneView& scene,
             const BatchSettings& batch,
             int count,
             const ShadeColumns& columns);

/// First step of ray casting: separates hits from misses, and gives misses the background.
/// Returns the number of hits, which now come first in their columns.
int begin_raycast(const SceneView& scene,
                  const BatchSettings& batch,
                  int count,
                  const ShadeColumns& columns);

/// Shades a range of hits with a range of lights: one shadow ray for each pair. The first light
/// also adds the light that needs no shadow ray. Returns the number of shadow rays.
///
/// In      range: at most as many pairs as columns.shadows holds
/// Source  Appel, "Some Techniques for Shading Machine Renderings of Solids", AFIPS 1968
int shade_raycast(const SceneView& scene, const RaycastRange& range, const RaycastColumns& columns);

/// Writes AOVs of the first hits (see Aov), whichever they are. Misses get zero.
void write_aovs(const SceneView& scene,
                const BatchSettings& batch,
                int count,
                const AovColumns& columns);

/// Coverage of the wireframe at each ray: the edges of triangles, and on analytic shapes the lines
/// on which u or v is a multiple of an eighth. Lines are batch.wire_width_px wide.
///
/// In      columns.paths, columns.hits: index i is pixel i of the batch, moved by
///         batch.film_offset_px
/// Out     columns.samples: r = g = b in [0, 1]; a = 1 where something was hit
void write_wireframe(const SceneView& scene,
                     const BatchSettings& batch,
                     int count,
                     const WireframeColumns& columns);

/// The result of sort_hits_from_misses.
struct SortedCounts {
    int hits = 0;
    int misses = 0;
};

/// The paths that the light tree chooses a light for: one bit a path, one word a group.
struct TreeDraws {
    uint16_t by_group[batch_size / lane_count];
};

/// Moves the hits to the front of their columns and the misses to columns.misses. Hits are sorted
/// by primitive where that saves much: lanes that share a surface share its records.
///
/// In      tree_draws: null, or paths whose hits come last, so that few groups descend the tree
SortedCounts sort_hits_from_misses(int count,
                                   const ShadeColumns& columns,
                                   const TreeDraws* tree_draws = nullptr);

}  // namespace OBSCURA_ISA
}  // namespace obscura
