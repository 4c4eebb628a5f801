// stages/wavefront_aov.h - AOVs between the stages: their columns, and what paths find later.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// AOVs whose channels are written to the samples, one after the other.
///
/// Out     work.aov_outputs
std::span<const AovOutput> aovs_in_samples(std::span<const Aov> aovs, Workspace& work);

/// Stage 3 for AOVs, before shading moves the paths: path i is sample i.
void write_aovs(const WavefrontInput& in,
                int count,
                std::span<const AovOutput> outputs,
                Workspace& work,
                WavefrontCounters& c);

/// Stage 3 of a later bounce, before shading: samples whose paths have come to a rough surface get
/// their albedo.
///
/// In/Out  work.passed_on, work.looking_for_albedo, work.aov_outputs
void look_for_albedo(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c);

}  // namespace obscura
