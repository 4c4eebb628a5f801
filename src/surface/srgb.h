// surface/srgb.h - the sRGB curve between 8-bit codes and linear light, as a formula and as tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"

#include <cstdint>

namespace obscura {

/// Linear light of the 256 codes; plain data, so that lanes can gather from it.
extern const float srgb_to_linear_table[256];

/// Tables of srgb8_from_linear: a first guess for each of 4096 equal steps of linear light, and for
/// each code the smallest linear light that rounds to it. The narrowest code is wider than a step,
/// so that the guess is right or one too low.
struct Srgb8Encoder {
    float least[257];
    uint8_t guess[4097];
};
extern const Srgb8Encoder srgb8_encoder;

/// Linear light of an encoded value.
///
/// In      encoded, any finite value; negative ones follow the line near zero
/// Source  IEC 61966-2-1:1999, section 5.2
float linear_from_srgb(float encoded) noexcept;

/// The inverse of linear_from_srgb.
float srgb_from_linear(float linear) noexcept;

inline namespace OBSCURA_ISA {

/// The 8-bit code nearest to srgb_from_linear(linear) * 255; clamps to [0, 1], NaN becomes 0.
OBSCURA_INLINE uint8_t srgb8_from_linear(float linear) noexcept {
    const float inside = linear > 0.0f ? (linear < 1.0f ? linear : 1.0f) : 0.0f;
    const uint32_t guess = srgb8_encoder.guess[static_cast<int32_t>(inside * 4096.0f)];
    return static_cast<uint8_t>(guess + (inside >= srgb8_encoder.least[guess + 1] ? 1U : 0U));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
