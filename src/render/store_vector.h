// render/store_vector.h - vectors in double become the floats of the tables that stages read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace obscura {

/// Out  out: 3 floats
inline void store(const Vec3d& v, float* out) {
    out[0] = static_cast<float>(v.x);
    out[1] = static_cast<float>(v.y);
    out[2] = static_cast<float>(v.z);
}

}  // namespace obscura
