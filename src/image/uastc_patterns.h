// image/uastc_patterns.h - UASTC's patterns that partition a block's texels into subsets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace obscura {

inline constexpr size_t max_uastc_subsets = 3;

struct UastcPattern {
    std::array<uint8_t, 16> subset = {};                 ///< of each texel
    std::array<uint8_t, max_uastc_subsets> anchor = {};  ///< each subset's first texel
};

/// The lists of patterns; each mode with subsets uses one of them.
enum class UastcPatternList { one, two, two_of_mode_7, three };

/// Pattern `index` of a list; nullptr where the list is shorter. List `one` has one pattern.
const UastcPattern* uastc_pattern(UastcPatternList list, uint32_t index);

}  // namespace obscura
