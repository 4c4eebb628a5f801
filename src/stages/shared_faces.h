// stages/shared_faces.h - faces of several bodies in the same place, which a path crosses at once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "stages/stages.h"

#include <vector>

namespace obscura {

/// A path's hit as its probe sees it; see ProbeRows.
struct Probe {
    float depth = 0;      ///< of the hit, along the probe
    float height = 0;     ///< of the path's start, before the hit
    float clearance = 0;  ///< of the hit
};

/// What a path meets at a place where several faces are.
struct Company {
    bool found = false;  ///< false: the hit face is alone
    Crossing face;       ///< the one that counts: of the body that fills the place on one side
    SharedFaces crossed;
};

/// Finds the faces that a path goes through together with the one that it hit.
///
/// Which of them Embree found first is chance, and says nothing: what counts are the bodies before
/// and behind all of them, and the face of the one that fills the place there (scene/media.h),
/// which then is the path's hit.
///
/// In      hit: t along the probe; faces: all that the probe goes through, perhaps the hit too
/// Source  bodies by precedence: Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced
///         Images", Journal of Graphics Tools 7(2), 2002; they leave out faces in the same place
Company find_company(const Probe& probe, const Crossing& hit, std::vector<Crossing>& faces);

/// What the faces around hits are asked of.
struct CompanyQuery {
    const Accel& accel;
    const int32_t* touching_bodies;  ///< by primitive
    SeeThrough see_through;          ///< of the paths' rays; cutaway: by row of these
};

/// Looks along probes for faces in the same place as the hits. Where there are, the face that
/// counts takes the place of the hit, at the place where the path's own ray meets it.
///
/// In/Out  hits: those of `rows`; shared: by slot; written where a hit has company.
///         Returns how many hits have.
int meet_company(const CompanyQuery& query,
                 int probes,
                 const ProbeRows& rows,
                 const HitRows& hits,
                 SharedFaces* shared);

}  // namespace obscura
