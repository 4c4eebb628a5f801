// tests/surface/harmonics_test.cpp - polynomials against associated Legendre functions.
// SPDX-License-Identifier: Apache-2.0
#include "surface/harmonics.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <cmath>
#include <numbers>

namespace obscura {
namespace {

/// Normalised real spherical harmonic with the Condon-Shortley phase, by its definition with
/// associated Legendre functions, which the standard library has without the phase.
double defined_harmonic(unsigned l, int m, const Vec3d& d) {
    const auto order = static_cast<unsigned>(std::abs(m));
    const double ratio = std::tgamma(l - order + 1) / std::tgamma(l + order + 1);
    const double norm = std::sqrt((2 * l + 1) / (4 * std::numbers::pi) * ratio);
    const double legendre = std::assoc_legendre(l, order, d.z);
    if (m == 0) return norm * legendre;
    const double phi = std::atan2(d.y, d.x);
    const double wave = m > 0 ? std::cos(order * phi) : std::sin(order * phi);
    return (order % 2 == 1 ? -1 : 1) * std::sqrt(2.0) * norm * legendre * wave;
}

TEST(Harmonics, AreThoseOfTheDefinition) {
    Pcg32 random(21);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d d = normalize(Vec3d{
            random.next_double() - 0.5, random.next_double() - 0.5, random.next_double() - 0.5});
        double exact[max_harmonics];
        real_harmonics(d, exact);
        float single[max_harmonics];
        real_harmonics(
            Vec3f{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)},
            single);
        for (int l = 0; l <= 3; ++l) {
            for (int m = -l; m <= l; ++m) {
                const int k = l * l + l + m;
                const double truth = defined_harmonic(static_cast<unsigned>(l), m, d);
                EXPECT_NEAR(exact[k], truth, 1e-6) << l << " " << m;
                EXPECT_NEAR(static_cast<double>(single[k]), truth, 1e-5) << l << " " << m;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
