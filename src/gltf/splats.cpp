// gltf/splats.cpp - the colours of Gaussian splats that are drawn as points.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/splats.h"

#include "surface/srgb.h"

#include <algorithm>

namespace obscura {

std::vector<float> splat_colors(const std::vector<float>& harmonics,
                                const std::vector<float>& opacities,
                                bool linear) {
    constexpr float harmonic_0 = 0.28209479f;  // sqrt(1 / pi) / 2
    constexpr float middle = 0.5f;
    const size_t count = harmonics.size() / 3;
    std::vector<float> out;
    out.reserve(count * 4);
    for (size_t i = 0; i < count; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            const float raw = std::clamp(harmonics[3 * i + c] * harmonic_0 + middle, 0.0f, 1.0f);
            out.push_back(linear ? raw : linear_from_srgb(raw));
        }
        out.push_back(opacities.empty() ? 1.0f : opacities[i]);
    }
    return out;
}

}  // namespace obscura
