// accel/tied_hits.h - hits on edges of triangles, where the neighbour is met in the same place.
// SPDX-License-Identifier: Apache-2.0
//
// An edge may lie on a side of the boxes around its triangles. Whether Embree then looks into both
// depends on the other rays of the packet. Obscura takes what a ray of its own finds there: of
// triangles that are equally near, that with the lowest ids.
#pragma once

#include "accel/accel_impl.h"
#include "accel/single_sided.h"

#include <limits>

namespace obscura {

/// The hit that a query with a filter has found so far.
struct LowestHit {
    float t = std::numeric_limits<float>::infinity();
    int32_t instance = 0, geometry = 0, triangle = 0;  ///< in the order of NearestHits

    /// Whether a candidate of a filter function is nearer, or as near and has lower ids. If so, it
    /// is the one from now on; if not, the filter is to reject it.
    bool takes(const RTCFilterFunctionNArguments* args, unsigned i);
};

/// Settles which hit a ray has where it meets the edge of a mesh's triangle.
///
/// In      context: of the query
/// In/Out  hit: Embree's result for the rays from `first` on; columns: their hits
void settle_tied_hits(const Accel::Impl& impl,
                      const QueryContext& context,
                      RTCHit16& hit,
                      int first,
                      const RaysAndHits& columns);

}  // namespace obscura
