// math/exact.h - exact sums and products by error-free transformations.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A number and its rounding error: value + error is exact.
template <typename F>
struct Exact {
    F value, error;
};

/// a * b + c, rounded once. By intrinsics because xsimd 8 does not fuse for AVX-512.
#if defined(__AVX512F__)
#define OBSCURA_FUSED
OBSCURA_INLINE Lanes fused(Lanes a, Lanes b, Lanes c) {
    return BatchF(_mm512_fmadd_ps(a.v, b.v, c.v));
}
#elif defined(__FMA__) && defined(__AVX__)
#define OBSCURA_FUSED
OBSCURA_INLINE Lanes fused(Lanes a, Lanes b, Lanes c) {
    return BatchF(_mm256_fmadd_ps(a.v, b.v, c.v));
}
#elif defined(__aarch64__)
#define OBSCURA_FUSED
OBSCURA_INLINE Lanes fused(Lanes a, Lanes b, Lanes c) {
    return BatchF(vfmaq_f32(c.v, a.v, b.v));
}
#endif

/// a + b with its exact rounding error.
/// Source  Knuth, The Art of Computer Programming 2, section 4.2.2, theorem B
template <typename F>
OBSCURA_INLINE Exact<F> two_sum(const F& a, const F& b) {
    const F sum = a + b;
    const F b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a * b with its exact rounding error, as long as both are normal numbers.
/// Source  Dekker, "A floating-point technique for extending the available precision", 1971, for
///         processors without fused multiply-add
OBSCURA_INLINE Exact<double> two_product(double a, double b) {
    const double product = a * b;
    return {product, __builtin_fma(a, b, -product)};
}

OBSCURA_INLINE Exact<float> two_product(float a, float b) {
    const double exact = static_cast<double>(a) * static_cast<double>(b);
    const auto product = static_cast<float>(exact);
    return {product, static_cast<float>(exact - static_cast<double>(product))};
}

OBSCURA_INLINE Exact<Lanes> two_product(Lanes a, Lanes b) {
    const Lanes product = a * b;
#if defined(OBSCURA_FUSED)
    return {product, fused(a, b, -product)};
#else
    const Lanes splitter(4097.0f);  // 2^12 + 1: halves of 12 bits
    const Lanes a_scaled = splitter * a;
    const Lanes b_scaled = splitter * b;
    const Lanes a_high = a_scaled - (a_scaled - a);
    const Lanes b_high = b_scaled - (b_scaled - b);
    const Lanes a_low = a - a_high;
    const Lanes b_low = b - b_high;
    const Lanes rest = ((a_high * b_high - product) + a_high * b_low) + a_low * b_high;
    return {product, rest + a_low * b_low};
#endif
}

/// a * b + c with an error of one rounding, or slightly more without fused multiply-add.
OBSCURA_INLINE double multiply_add(double a, double b, double c) {
    return __builtin_fma(a, b, c);
}

OBSCURA_INLINE float multiply_add(float a, float b, float c) {
    return static_cast<float>(static_cast<double>(a) * static_cast<double>(b) +
                              static_cast<double>(c));
}

OBSCURA_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
#if defined(OBSCURA_FUSED)
    return fused(a, b, c);
#else
    const Exact<Lanes> product = two_product(a, b);
    const Exact<Lanes> sum = two_sum(product.value, c);
    return sum.value + (sum.error + product.error);
#endif
}

/// a * b - c * d to about two units in the last place, however close the products are.
/// Source  Kahan, "On the Cost of Floating-Point Computation Without Extra-Precise Arithmetic",
///         2004; error bound: Jeannerod et al., Mathematics of Computation 82, 2013
template <typename F>
OBSCURA_INLINE F difference_of_products(const F& a, const F& b, const F& c, const F& d) {
    const Exact<F> second = two_product(c, d);
    return multiply_add(a, b, F(-second.value)) - second.error;
}

/// Cross product, every component as good as difference_of_products.
template <typename F>
OBSCURA_INLINE Vec3<F> exact_cross(const Vec3<F>& a, const Vec3<F>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y),
            difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
