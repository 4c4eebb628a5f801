// math/sampler.h - the random numbers of a path: Owen-scrambled Sobol points, padded in pairs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/reverse_bits.h"
#include "math/vec.h"

namespace obscura {

/// The uses of the pairs of random numbers. A path's pair index is `bounce * pairs_per_bounce +
/// use`; bounce 0 is the camera's.
///
/// To add a use: append it before `count`. This changes the noise of every image, not its mean.
enum class RandomUse : uint32_t { film, bsdf, roulette, light, texture, count };

inline constexpr uint32_t pairs_per_bounce = static_cast<uint32_t>(RandomUse::count);

/// Pair index of the point on the lens: greater than those of any bounce, so that a lens does not
/// shift the other pairs.
inline constexpr uint32_t lens_pair = 0x4C454E53U;

/// Likewise of the shutter time.
inline constexpr uint32_t shutter_pair = 0x53485554U;

/// Likewise of the wavelength that dispersion gives a path.
inline constexpr uint32_t wavelength_pair = 0x57415645U;

inline namespace OBSCURA_ISA {

/// A bijection of 32-bit words in which every output bit depends on every input bit.
/// Source  the "lowbias32" finalizer found by search, C. Wellons, "Hash Function Prospector", 2018
template <typename U>
OBSCURA_INLINE U hash_word(U x) {
    x = x ^ (x >> 16);
    x = x * U(0x7FEB352DU);
    x = x ^ (x >> 15);
    x = x * U(0x846CA68BU);
    return x ^ (x >> 16);
}

/// Key of a pixel's random numbers: depends on seed and absolute pixel coordinates only.
template <typename U>
OBSCURA_INLINE U pixel_key(const U& x, const U& y, uint32_t seed_low, uint32_t seed_high) {
    U key = hash_word(U(x + U(hash_word(seed_low))));  // seeds must not shift the pattern
    key = hash_word(U(key ^ (y * U(0x9E3779B9U))));
    return hash_word(U(key + U(seed_high)));
}

/// The random numbers of a pixel: those of `key` from number `first` on.
template <typename U>
struct PixelSequence {
    U key, first;
};

/// Side of the blocks of pixels that share one sequence in z_order_sequence.
inline constexpr uint32_t z_order_side = 64;

/// The pixels of a block follow one another along a Z-shaped curve, each with 2^sample_bits
/// numbers: what neighbours draw is stratified together, and their errors cancel.
///
/// In      x, y: of the pixel, also below 0; sample_bits: up to 20
/// Source  Ahmed and Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
///         Hierarchical Ordering of Pixels", ACM Transactions on Graphics 39(6), 2020. sobol_pair
///         scrambles the order anew for every pair.
template <typename U>
OBSCURA_INLINE PixelSequence<U> z_order_sequence(
    const U& x, const U& y, uint32_t seed_low, uint32_t seed_high, int sample_bits) {
    const auto spread = [](U bits) {
        bits = bits & U(z_order_side - 1);
        bits = (bits | (bits << 4)) & U(0x0F0FU);
        bits = (bits | (bits << 2)) & U(0x3333U);
        return U((bits | (bits << 1)) & U(0x5555U));
    };
    const U along = spread(x) | (spread(y) << 1);
    return {pixel_key(U(x >> 6), U(y >> 6), seed_low, seed_high), along << sample_bits};
}

/// Owen scrambling; input and result have their bits reversed.
/// Source  Laine and Karras, "Stratified Sampling for Stochastic Transparency", 2011; constants of
///         N. Vegdahl, "Building a Better LK Hash", 2021
template <typename U>
OBSCURA_INLINE U owen_scramble_reversed(U x, const U& seed) {
    x = x ^ (x * U(0x3D20ADEAU));
    x = x + seed;
    x = x * ((seed >> 16) | U(1U));
    x = x ^ (x * U(0x05526C56U));
    return x ^ (x * U(0x53A22864U));
}

/// Second Sobol dimension of an index, bits reversed: the matrix is the Pascal triangle modulo 2.
/// Source  Ahmed, "An Implementation Algorithm of 2D Sobol Sequence Fast, Elegant, and Compact",
///         2024
template <typename U>
OBSCURA_INLINE U sobol_second_reversed(U x) {
    x = x ^ ((x >> 1) & U(0x55555555U));
    x = x ^ ((x >> 2) & U(0x33333333U));
    x = x ^ ((x >> 4) & U(0x0F0F0F0FU));
    x = x ^ ((x >> 8) & U(0x00FF00FFU));
    return x ^ (x >> 16);
}

/// One two-dimensional point, each number a full 32-bit fraction.
///
/// In      key: pixel_key; index_reversed: reverse_bits(sample number), which in a PixelSequence
///         begins at `first`; pair: see RandomUse
/// Source  Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020: shuffled, padded points
template <typename U>
OBSCURA_INLINE Vec2<U> sobol_pair(const U& key, const U& index_reversed, uint32_t pair) {
    const U seed = hash_word(U(key + U(pair * 0x9E3779B9U)));
    const U index = reverse_bits(owen_scramble_reversed(index_reversed, seed));
    const U first = owen_scramble_reversed(index, U(seed * U(0x9E6C63D3U) + U(0x68BC21EBU)));
    const U second = owen_scramble_reversed(sobol_second_reversed(index),
                                            U(seed * U(0xC2B2AE35U) + U(0x02E5BE93U)));
    return {reverse_bits(first), reverse_bits(second)};
}

/// A 32-bit fraction as a number in [0, 1); keeps 24 bits.
template <typename F>
OBSCURA_INLINE F unit_float(const UintOf<F>& bits) {
    return from_int<F>(as_int(bits >> 8)) * F(1.0f / 16777216.0f);
}

/// Converts an unsigned integer, rounded once.
template <typename F>
OBSCURA_INLINE F float_from_uint(const UintOf<F>& u) {
    return from_int<F>(as_int(u >> 16)) * F(65536.0f) + from_int<F>(as_int(u & UintOf<F>(0xFFFFU)));
}

template <typename F>
OBSCURA_INLINE Vec2<F> unit_pair(const Vec2<UintOf<F>>& bits) {
    return {unit_float<F>(bits.x), unit_float<F>(bits.y)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
