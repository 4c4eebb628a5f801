// stages/wavefront_visibility.h - holdouts, and light behind what casts no shadow.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// Visibility flags of what ray i hit; 0: none.
inline uint8_t flags_of_hit(const WavefrontInput& in, const HitColumns& hits, int i) {
    if (in.visibility == nullptr || hits.primitive[i] < 0) return 0;
    return in.visibility->of(hits.primitive[i], hits.instance[i]);
}

/// After stage 2 of camera rays: those that hit a holdout or a catcher count as misses. Behind a
/// holdout there is nothing, not even the background; those at catchers wait in work.catcher.
void part_camera_hits(const WavefrontInput& in, int count, Workspace& work);

/// A bounce whose paths in work.paths[0] have their hits, before they are shaded.
struct LitBounce {
    const WavefrontInput& in;
    int bounce = 0;
    ShadeColumns columns;
};

/// Adds the light that bounced rays would find without the surfaces that cast no shadow, as the
/// shadow rays of light sampling do, so that both strategies of MIS find the same light. Rays off
/// smooth surfaces find less of it, or mirrors would show a surface and the light behind it at
/// once: beyond a density of 1/sr, they count in inverse proportion to it. None of these rays is
/// recorded.
///
/// Out     work.samples; work.paths[1] is overwritten
void add_light_behind(const LitBounce& lit, int count, Workspace& work, WavefrontCounters& c);

}  // namespace obscura
