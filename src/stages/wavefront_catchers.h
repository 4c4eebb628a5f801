// stages/wavefront_catchers.h - shadow catchers and the background, seen directly or through glass.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// Begins a batch.
void begin_catchers(Workspace& work);

/// Camera ray i, after stage 2: whether a catcher is what it meets first. Then it waits in
/// work.catcher, and counts as a miss.
///
/// In      flags: of what it hit, see VisibilityFlags
bool meet_catcher(const WavefrontInput& in, int i, uint8_t flags, Workspace& work);

// Paths that have met nothing but clear glass see catchers, too (--transparent-glass), and where
// the image shows no environment, they see its background in place of that. The parts of the two
// that glass lets through leave the alpha of their samples.

/// Whether paths are told apart by that.
inline bool looks_through_glass(const WavefrontInput& in) {
    return in.batch.clear_spread >= 0;
}

/// Stage 2 of a bounce is done, beyond the first: finds the paths that look through clear glass
/// alone at a catcher, which wait in work.catcher and count as misses, or at the background.
void look_through_glass(
    const WavefrontInput& in, int bounce, int count, Workspace& work, WavefrontCounters& c);

/// Ends these paths, before stage 3 would shade them.
void end_behind_glass(Workspace& work);

/// After stage 3 of a bounce: shades the catchers that were met there, whose next rays follow the
/// `count` paths of work.paths[0]. Moves the background behind the catchers, and the light in front
/// of them, out of work.samples.
///
/// Out     work.shadows; sizes of columns; work.paths[1] is overwritten
CatcherCounts leave_catchers(const WavefrontInput& in, int bounce, int count, Workspace& work);

/// When all light has arrived: moves that of catchers from work.samples to work.catcher, and the
/// light in front of them back. Returns how many of their samples were not finite; each counts as
/// unlit.
uint64_t settle_catchers(Workspace& work);

/// Makes some reflections of catchers the paths of work.paths[0].
void take_reflections(const CatcherReflections& reflections, Workspace& work);

/// Keeps the paths that hit something; returns their number.
int keep_hits(int count, Workspace& work);

}  // namespace obscura
