// accel/single_sided.h - back faces of single-sided meshes, which camera rays pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

/// A direction in the world, at a time.
struct TimedDirection {
    Vec3f world;
    float time;
};

TimedDirection direction_of(const RayColumns& rays, int index);

/// True when a ray of this direction meets the back of the face.
///
/// In   ng: Embree's, which is in object space; a mirroring instance turns both the winding and
///      glTF's rule: only the object-space sign matters
bool shows_back(const Accel::Impl& impl,
                const SceneRecords& records,
                const Vec3f& ng,
                const TimedDirection& direction);

/// True when camera rays pass the face: its material is single-sided and they meet its back.
bool is_hidden_back(const Accel::Impl& impl,
                    const SceneRecords& records,
                    const Vec3f& ng,
                    const TimedDirection& direction);

/// A face and the point where a ray hits it.
struct MetFace {
    SceneRecords records;
    Vec3f ng;   ///< Embree's
    Vec3f met;  ///< world
    float time;
};

/// Whether the face is cut away.
bool is_cut_away(const Accel::Impl& impl, const CutFaces& cut, const MetFace& face);

/// Rays and what they hit.
struct RaysAndHits {
    const RayColumns& rays;
    const HitColumns& hits;
};

/// Replaces hits on hidden back faces by the next hits, and records them in context.passed_backs.
///
/// In      hit: Embree's result for the rays from `first` on
/// In/Out  columns: their hits
void pass_hidden_backs(const Accel::Impl& impl,
                       const QueryContext& context,
                       const RTCHit16& hit,
                       int first,
                       const RaysAndHits& columns);

/// If a ray hit a surface that has faces in context.cutaway for this ray, traces it again without
/// these.
void pass_cutaway(const Accel::Impl& impl,
                  const QueryContext& context,
                  int index,
                  const RaysAndHits& columns);

/// For an occluded ray: false if only faces cut away by context.cutaway lie in (0, tfar). Does not
/// test infinite planes.
bool is_occluded_despite_cutaway(const Accel::Impl& impl,
                                 const QueryContext& context,
                                 int index,
                                 const RayColumns& rays);

}  // namespace obscura
