// accel/single_sided.h - backs that camera rays pass, and what is then cut away for other rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

/// Rays and what they hit.
struct RaysAndHits {
    const RayColumns& rays;
    const HitColumns& hits;
};

/// Looks behind the hidden backs among a packet's hits, and notes them in context.passed_backs.
///
/// In      hit: as Embree wrote the rows from `first` on
/// In/Out  columns: their hits
void pass_hidden_backs(const Accel::Impl& impl,
                       const QueryContext& context,
                       const RTCHit16& hit,
                       int first,
                       const RaysAndHits& columns);

/// Asks the row's ray again where it met a surface of which context.cutaway takes faces away for
/// this ray, now without these.
void pass_cutaway(const Accel::Impl& impl,
                  const QueryContext& context,
                  int row,
                  const RaysAndHits& columns);

/// False when nothing that context.cutaway leaves lies in (0, tfar) of the row's ray, which is
/// known to meet something; planes without end apart.
bool is_hidden_beside_cutaway(const Accel::Impl& impl,
                              const QueryContext& context,
                              int row,
                              const RayColumns& rays);

}  // namespace obscura
