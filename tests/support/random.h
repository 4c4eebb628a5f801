// tests/support/random.h - a small generator of random numbers with fixed seeds, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// Source  O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
///         for Random Number Generation", HMC-CS-2014-0905, 2014: XSH RR 64/32
class Pcg32 {
public:
    explicit Pcg32(uint64_t seed) {
        next_uint();
        state_ += seed;
        next_uint();
    }

    uint32_t next_uint() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + 1442695040888963407ULL;
        const auto mixed = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<uint32_t>(old >> 59);
        return mixed >> turn | mixed << ((32U - turn) & 31U);
    }

    /// In [0, 1), 24 bits.
    float next_float() { return static_cast<float>(next_uint() >> 8) * 0x1p-24F; }

    /// In [0, 1), 32 bits.
    double next_double() { return next_uint() * 0x1p-32; }

private:
    uint64_t state_ = 0;
};

}  // namespace obscura
