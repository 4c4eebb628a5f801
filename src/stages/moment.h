// stages/moment.h - the two poses around a time, and the fraction between them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/transform.h"
#include "stages/path_state.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The pose before a time, and the fraction of the interval to the next one.
struct Moment {
    LanesI step;
    Lanes fraction;
};

/// In  time: 0 when the shutter opens, 1 when it closes; steps: at least 2
OBSCURA_INLINE Moment moment_of(int steps, Lanes time) {
    const Lanes position = time * Lanes(static_cast<float>(steps - 1));
    const LanesI step = min(max(to_int(position), LanesI(0)), LanesI(steps - 2));
    return {step, position - from_int<Lanes>(step)};
}

/// Entry by entry, as Embree blends its instances.
OBSCURA_INLINE Affine<Lanes> blend(const Affine<Lanes>& a, const Affine<Lanes>& b, Lanes fraction) {
    Affine<Lanes> out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = a.m[r][c] + (b.m[r][c] - a.m[r][c]) * fraction;
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
