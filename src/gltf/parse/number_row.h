// gltf/parse/number_row.h - one number, or a short list of them, of what a glTF file describes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace obscura {

/// The default is none.
struct NumberLimits {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// Where the JSON object of a T has numbers, and which member they are. Reading and animating both
/// go by such rows.
template <typename T>
struct NumberRow {
    const char* place;  ///< from the object on, as in a JSON pointer
    std::span<double> (*numbers)(T&);
    NumberLimits limits = {};  ///< what they are clamped to
};

inline std::span<double> span_of(double& number) {
    return {&number, 1};
}

template <size_t N>
std::span<double> span_of(std::array<double, N>& numbers) {
    return numbers;
}

/// NumberRow::numbers of a member.
template <auto member, typename T>
std::span<double> numbers_of(T& owner) {
    return span_of(owner.*member);
}

inline double clamped(double number, const NumberLimits& limits) {
    return std::clamp(number, limits.low, limits.high);
}

}  // namespace obscura
