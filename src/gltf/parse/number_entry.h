// gltf/parse/number_entry.h - table entries that locate the numbers of glTF objects.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace obscura::gltf {

/// The default is none.
struct NumberLimits {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// Where the JSON object of a T has numbers, and which member they are. Reading and animating both
/// use these entries.
template <typename T>
struct NumberEntry {
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

/// NumberEntry::numbers of a member.
template <auto member, typename T>
std::span<double> numbers_of(T& owner) {
    return span_of(owner.*member);
}

inline double clamped(double number, const NumberLimits& limits) {
    return std::clamp(number, limits.low, limits.high);
}

}  // namespace obscura::gltf
