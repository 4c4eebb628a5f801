// stages/wavefront_albedo.h - follows paths through mirrors and glass for the AOV `albedo`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// Whether the AOV `albedo` of a batch's samples is followed beyond their first hits, as it is
/// where there are paths.
///
/// Out     work.looking_for_albedo. Returns AovColumns::passed_on
float* begin_albedo(const WavefrontInput& in, int count, Workspace& work);

/// Stage 3 of a later bounce, before shading: samples whose paths have come to a rough surface get
/// their albedo.
///
/// In/Out  work.passed_on, work.looking_for_albedo, work.aov_outputs
void look_for_albedo(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c);

}  // namespace obscura
