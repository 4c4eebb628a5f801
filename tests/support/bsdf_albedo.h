// tests/support/bsdf_albedo.h - the BRDF's directional albedo by quadrature in double.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/bsdf.h"

#include <cmath>

namespace obscura::test {

/// A view direction with this cosine, off the axes.
inline Vec3d view_direction(double cosine) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {0.8 * sine, -0.6 * sine, cosine};
}

inline BsdfParams<double> bsdf_of(const Vec3d& base, double metallic, double roughness) {
    return {base, metallic, std::max(roughness * roughness, static_cast<double>(min_ggx_alpha))};
}

struct AlbedoResult {
    Vec3d albedo;  ///< integral of f cos
    double pdf;    ///< integral of the density above the horizon
    Vec3d single;  ///< of the metal's facets alone, after one bounce
    double once;   ///< the same, of facets that reflect everything
};

/// D G / (4 cos_o cos_i) of GGX with height-correlated Smith masking, by its Lambda.
inline double single_bounce(const Vec3d& wo, const Vec3d& wi, double alpha) {
    const Vec3d h = normalize(wo + wi);
    const auto lambda = [&](const Vec3d& w) {
        const double tangent2 = (1 - w.z * w.z) / (w.z * w.z);
        return (std::sqrt(1 + alpha * alpha * tangent2) - 1) / 2;
    };
    const double a2 = alpha * alpha;
    const double d = h.z * h.z * (a2 - 1) + 1;
    return a2 / (pi_d * d * d) / (1 + lambda(wo) + lambda(wi)) / (4 * wo.z * wi.z);
}

/// Tilt of a microfacet normal as the fraction `t` of GGX normals that are less tilted, then as 1 -
/// sqrt(1 - t), which is dense at the steep ones that grazing views see.
inline double slope_from_unit(double x, double alpha) {
    const double steep = 1 - x;
    return alpha * std::sqrt(1 / (steep * steep) - 1);
}

/// Density, per solid angle, of directions mirrored at normals uniform in that number.
inline double mirrored_density(const Vec3d& wo, const Vec3d& wi, double alpha) {
    const Vec3d h = normalize(wo + wi);
    const double slope = std::sqrt(h.x * h.x + h.y * h.y) / h.z;
    const double steep = alpha / std::sqrt(slope * slope + alpha * alpha);
    return ggx_distribution(h, alpha) * h.z / (4 * dot(wo, h)) / (2 * steep);
}

/// Integrates over two grids, one dense at the specular lobe and one for the diffuse; each point is
/// weighted by its grid's fraction of both densities (the balance heuristic), so that the sum is
/// right for any alpha and any angle. Independent of sample_bsdf.
inline AlbedoResult quadrature_albedo(const BsdfParams<double>& p, const Vec3d& wo) {
    constexpr int rows = 300;
    constexpr int columns = 160;
    constexpr double cell = 1.0 / (rows * columns);
    const LobeWeights<double> lobes = lobe_weights(p, wo.z);
    AlbedoResult sum{{0, 0, 0}, 0, {0, 0, 0}, 0};
    const Vec3d white{1, 1, 1};
    const auto add = [&](const Vec3d& wi) {
        if (!(wi.z > 0)) return;
        const BsdfValue<double> at = evaluate_bsdf(p, lobes, wo, wi);
        const double weight = cell / (mirrored_density(wo, wi, p.alpha) + wi.z / pi_d);
        sum.albedo = sum.albedo + at.value_cos * weight;
        sum.pdf += at.pdf * weight;
        const double once = single_bounce(wo, wi, p.alpha) * wi.z * weight;
        const double rise = std::pow(1 - dot(wo, normalize(wo + wi)), 5);
        sum.single = sum.single + (p.base_color + (white - p.base_color) * rise) * once;
        sum.once += once;
    };
    for (int r = 0; r < rows; ++r) {
        const double t = (r + 0.5) / rows;
        const double slope = slope_from_unit(t, p.alpha);
        for (int c = 0; c < columns; ++c) {
            const double turn = 2 * pi_d * (c + 0.5) / columns;
            const Vec3d h = normalize(Vec3d{slope * std::cos(turn), slope * std::sin(turn), 1.0});
            const double cosine = dot(wo, h);
            if (cosine > 0) add(h * (2 * cosine) - wo);
            const double radius = std::sqrt(t);
            add({radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1 - t)});
        }
    }
    return sum;
}

}  // namespace obscura::test
