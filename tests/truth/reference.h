// tests/truth/reference.h - known radiances: quadratures of the BRDF in double precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "surface/bsdf.h"

#include <cmath>
#include <functional>
#include <vector>

namespace obscura::test {

inline BsdfParams<double> exact_bsdf(const Material& m) {
    const double roughness = static_cast<double>(m.roughness);
    return {{static_cast<double>(m.base_color[0]),
             static_cast<double>(m.base_color[1]),
             static_cast<double>(m.base_color[2])},
            static_cast<double>(m.metallic),
            std::max(roughness * roughness, static_cast<double>(min_ggx_alpha))};
}

inline Vec3d polar_direction(double cos_theta, double phi) {
    const double s = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
    return {s * std::cos(phi), s * std::sin(phi), cos_theta};
}

/// Integral over the hemisphere of value_cos(wo, wi) * incoming(wi), red channel, by two regular
/// grids: one dense at the specular lobe, one uniform in cosine. Each point is weighted by its
/// grid's fraction of the two densities, so that each grid only counts what it resolves.
inline double reflected(const BsdfParams<double>& p,
                        const Vec3d& wo,
                        const std::function<double(const Vec3d&)>& incoming) {
    constexpr int n_theta = 600;
    constexpr int n_phi = 240;
    // Polar angle of the half vector: tan(theta) = alpha * t / (1 - t), t uniform in (0, 1).
    const auto half_density = [&](double cos_h, double cos_oh) {
        const double tangent = std::sqrt(std::max(0.0, 1.0 - cos_h * cos_h)) / cos_h;
        const double ratio = tangent / p.alpha;
        const double one_minus_t = 1.0 / (1.0 + ratio);
        const double dtheta_dt = p.alpha / (one_minus_t * one_minus_t) / (1.0 + tangent * tangent);
        const double sine = std::max(cos_h * tangent, 1e-300);
        return 1.0 / (2.0 * pi_d * sine * dtheta_dt * 4.0 * cos_oh);
    };
    const auto contribution = [&](const Vec3d& wi) {
        if (wi.z <= 0) return 0.0;
        const Vec3d h = normalize(wo + wi);
        const double by_half = half_density(h.z, dot(wo, h));
        const double by_cosine = wi.z / pi_d;
        return evaluate_bsdf(p, wo, wi).value_cos.x * incoming(wi) / (by_half + by_cosine);
    };
    double sum = 0;
    for (int i = 0; i < n_theta; ++i) {
        const double t = (i + 0.5) / n_theta;
        const double theta = std::atan(p.alpha * t / (1.0 - t));
        for (int j = 0; j < n_phi; ++j) {
            const double phi = 2.0 * pi_d * (j + 0.5) / n_phi;
            const Vec3d h = polar_direction(std::cos(theta), phi);
            const double cosine = dot(wo, h);
            if (cosine > 0) sum += contribution(h * (2.0 * cosine) - wo);
            sum += contribution(polar_direction(std::sqrt(t), phi));
        }
    }
    return sum / (n_theta * n_phi);
}

/// Mean and standard error of one channel over all pixels of a film.
struct Mean {
    double value = 0;
    double error = 0;
};

inline Mean film_mean(const Film& film, size_t channel = 0) {
    const size_t channels = film.channels.size();
    const size_t count = film.pixels.size() / channels;
    double sum = 0;
    double squares = 0;
    for (size_t i = 0; i < count; ++i) {
        const double v = static_cast<double>(film.pixels[i * channels + channel]);
        sum += v;
        squares += v * v;
    }
    const double mean = sum / static_cast<double>(count);
    const double variance = std::max(0.0, squares / static_cast<double>(count) - mean * mean);
    return {mean, std::sqrt(variance / static_cast<double>(count))};
}

}  // namespace obscura::test
