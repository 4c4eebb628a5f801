// accel/single_sided.h - backs that camera rays pass, and what is then cut away for other rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

/// A direction in the world, at a time.
struct TimedDirection {
    Vec3f world;
    float time;
};

TimedDirection direction_of(const RayColumns& rays, int row);

/// True when a face shows its back to whoever looks along a direction.
///
/// In   ng: Embree's, which is in object space; a mirroring instance turns both the winding and
///      glTF's rule: only the object-space sign matters
bool shows_back(const Accel::Impl& impl,
                const SceneRows& rows,
                const Vec3f& ng,
                const TimedDirection& direction);

/// The same, of a face that camera rays pass.
bool is_hidden_back(const Accel::Impl& impl,
                    const SceneRows& rows,
                    const Vec3f& ng,
                    const TimedDirection& direction);

/// A face where a ray meets it.
struct MetFace {
    SceneRows rows;
    Vec3f ng;   ///< as Embree says
    Vec3f met;  ///< world
    float time;
};

/// Whether the face is one of those that are cut away.
bool is_cut_away(const Accel::Impl& impl, const CutFaces& cut, const MetFace& face);

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
