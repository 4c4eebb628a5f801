// stages/contribution_limit.h - limits what one contribution adds to a sample, by --clamp-*.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "stages/path_state.h"

namespace obscura {

/// The most that any channel of a contribution may have; 0: there is no limit. What the eye sees
/// without any scattering is never limited.
///
/// In      scatterings: between the eye and the light
inline float contribution_limit(const BatchSettings& batch, int scatterings) {
    if (scatterings == 0) return 0;
    return scatterings == 1 ? batch.clamp_direct : batch.clamp_indirect;
}

inline namespace OBSCURA_ISA {

/// Scales light so that its greatest channel keeps within a limit: its colour stays.
///
/// In      limit: as contribution_limit returns it
template <typename F>
OBSCURA_INLINE Vec3<F> limit_contribution(const Vec3<F>& light, float limit) {
    if (!(limit > 0)) return light;
    return light * (F(limit) / max(max_component(light), F(limit)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
