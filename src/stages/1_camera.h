// stages/1_camera.h - stage 1: film points become rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"
#include "stages/doors.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// In      batch.pixel_x/y, samples, first_sample: which film points
/// Out     out: one row a slot, in slot order; samples: cleared
/// Units   metres; key and sample feed math/sampler.h
/// Errors  none
void make_camera_rays(const BatchSettings& batch,
                      int count,
                      const PathRows& out,
                      const SampleRows& samples);

}  // namespace OBSCURA_ISA
}  // namespace obscura
