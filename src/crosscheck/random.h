// crosscheck/random.h - repeatable random numbers in double, one stream for every ray.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/warp.h"

#include <cmath>
#include <cstdint>

namespace obscura::crosscheck {

/// Source  Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014
class RandomStream {
public:
    explicit RandomStream(uint64_t stream) : state_(stream * 0xD1342543DE82EF95ULL) { next(); }

    uint64_t next() {
        state_ += 0x9E3779B97F4A7C15ULL;
        uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31);
    }
    /// In [0, 1).
    double unit() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// Below `count`, which is not 0.
    size_t below(size_t count) {
        return static_cast<size_t>(unit() * static_cast<double>(count)) % count;
    }
    Vec3d direction() {
        const double y = between(-1, 1);
        const double turn = 2 * pi_d * unit();
        const double ring = std::sqrt(1 - y * y);
        return {ring * std::cos(turn), y, ring * std::sin(turn)};
    }

private:
    uint64_t state_;
};

}  // namespace obscura::crosscheck
