// stages/shared_faces.h - coincident faces of several media, which a path crosses all at once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "stages/stages.h"

#include <vector>

namespace obscura {

/// A path's hit as its probe sees it; see ProbeColumns.
struct Probe {
    float depth = 0;      ///< of the hit, along the probe
    float height = 0;     ///< of the path's start, before the hit
    float clearance = 0;  ///< of the hit
};

/// The coincident faces that a path crosses at a hit.
struct CoincidentFaces {
    bool found = false;  ///< false: the hit face is alone
    Crossing face;       ///< the one that counts: of the medium that dominates on one side
    SharedFaces crossed;
};

/// Finds the faces that a path crosses together with the one that it hit.
///
/// Which of them Embree reports first is random. So the media before and behind all of them decide:
/// the face of the dominant medium there (scene/media.h) becomes the path's hit.
///
/// In      hit: t along the probe; faces: all that the probe crosses, with or without the hit
/// Source  priorities: Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images", Journal
///         of Graphics Tools 7(2), 2002; they do not treat coincident faces
CoincidentFaces find_coincident_faces(const Probe& probe,
                                      const Crossing& hit,
                                      std::vector<Crossing>& faces);

/// The inputs of the search for coincident faces.
struct CoincidenceQuery {
    const Accel& accel;
    const int32_t* touching_media;  ///< by primitive
    SeeThrough see_through;         ///< of the paths' rays; cutaway: by path index
};

/// Searches along the probes for faces that coincide with the hits. Where there are any, the face
/// to shade replaces the hit, at the position where the path's own ray meets it.
///
/// In/Out  hits: those of `columns`; shared: by sample index; written where faces coincide.
///         Returns the number of such hits.
int resolve_coincident_faces(const CoincidenceQuery& query,
                             int probes,
                             const ProbeColumns& columns,
                             const HitColumns& hits,
                             SharedFaces* shared);

}  // namespace obscura
