// image/rgb_primaries.h - RGB primaries as chromaticities, and their matrices to CIE XYZ.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace obscura {

using Xyz = std::array<double, 3>;
using Matrix3 = std::array<Xyz, 3>;  ///< rows

struct Chromaticity {
    double x = 0, y = 0;
};

/// Red, green and blue.
using RgbPrimaries = std::array<Chromaticity, 3>;

/// Source  ITU-T H.273, table 2: primaries 1, 9 and 12
inline constexpr Chromaticity d65 = {0.3127, 0.3290};
inline constexpr RgbPrimaries rec709_primaries = {{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}}};
inline constexpr RgbPrimaries rec2020_primaries = {
    {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}};
inline constexpr RgbPrimaries p3_primaries = {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}};

/// Source  SMPTE ST 2065-1:2012, section 4.1; Academy S-2014-004, section 4.1
inline constexpr Chromaticity aces_white = {0.32168, 0.33767};
inline constexpr RgbPrimaries ap0_primaries = {
    {{0.7347, 0.2653}, {0.0000, 1.0000}, {0.0001, -0.0770}}};
inline constexpr RgbPrimaries ap1_primaries = {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}};

/// XYZ of a chromaticity, with Y = 1.
constexpr Xyz white_xyz(const Chromaticity& c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

constexpr Xyz product(const Matrix3& m, const Xyz& v) {
    Xyz out = {};
    for (size_t row = 0; row < 3; ++row)
        out[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
    return out;
}

constexpr Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 out = {};
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column) {
            for (size_t k = 0; k < 3; ++k)
                out[row][column] += a[row][k] * b[k][column];
        }
    }
    return out;
}

/// By Cramer's rule; the matrix must not be singular.
constexpr Matrix3 inverse(const Matrix3& m) {
    const auto cofactor = [&](size_t row, size_t column) {
        const size_t r1 = (row + 1) % 3, r2 = (row + 2) % 3;
        const size_t c1 = (column + 1) % 3, c2 = (column + 2) % 3;
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    };
    const double determinant =
        m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    Matrix3 out = {};
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column)
            out[row][column] = cofactor(column, row) / determinant;
    }
    return out;
}

/// The matrix that takes linear RGB to XYZ with Y = 1 for white.
///
/// Source  SMPTE RP 177-1993, section 3.3
constexpr Matrix3 xyz_from_rgb(const RgbPrimaries& primaries, const Chromaticity& white = d65) {
    Matrix3 columns = {};
    for (size_t c = 0; c < 3; ++c) {
        const Xyz color = white_xyz(primaries[c]);
        for (size_t row = 0; row < 3; ++row)
            columns[row][c] = color[row];
    }
    const Xyz scale = product(inverse(columns), white_xyz(white));
    for (Xyz& row : columns) {
        for (size_t c = 0; c < 3; ++c)
            row[c] *= scale[c];
    }
    return columns;
}

/// The chromatic adaptation from one white to another, both in XYZ.
///
/// Source  ICC.1:2010, annex E: the linearised Bradford transform
constexpr Matrix3 bradford_adaptation(const Xyz& from, const Xyz& to) {
    constexpr Matrix3 cone = {
        {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    const Xyz source = product(cone, from);
    const Xyz target = product(cone, to);
    Matrix3 scaled = cone;
    for (size_t row = 0; row < 3; ++row) {
        for (double& value : scaled[row])
            value *= target[row] / source[row];
    }
    return product(inverse(cone), scaled);
}

}  // namespace obscura
