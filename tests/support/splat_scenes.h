// tests/support/splat_scenes.h - Gaussian splats in memory, and their effect on a ray in double.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace obscura::test {

struct TestSplat {
    Affined world_from_ball;
    float opacity = 1;
    Vec3f color = {1, 1, 1};
    std::vector<float> harmonics = {};  ///< of the degrees 1 and above, 3 numbers a function
};

/// Adds one group of splats, which all have harmonics of one degree.
inline void add_splats(Scene& scene, const std::vector<TestSplat>& splats, bool linear = true) {
    SplatField& field = scene.splats;
    SplatGroup group;
    group.first = static_cast<int32_t>(field.boxes.size() * splat_block);
    group.count = static_cast<int32_t>(splats.size());
    group.linear = linear;
    group.first_color = field.colors.size();
    group.first_harmonic = field.harmonics.size();
    float largest = 0;
    for (const TestSplat& splat : splats) {
        field.colors.insert(field.colors.end(), {splat.color.x, splat.color.y, splat.color.z});
        while (3 * static_cast<size_t>(directional_harmonics(group.degree)) <
               splat.harmonics.size())
            ++group.degree;
        for (const float x : splat.harmonics)
            largest = std::max(largest, std::fabs(x));
    }
    group.harmonic_step = largest / 32767;
    for (const TestSplat& splat : splats) {
        for (const float x : splat.harmonics)
            field.harmonics.push_back(static_cast<int16_t>(std::lround(x / group.harmonic_step)));
    }
    const size_t blocks = field.boxes.size() + (splats.size() + splat_block - 1) / splat_block;
    field.blocks.resize(blocks * splat_block_floats);
    field.boxes.resize(blocks, {splat3(INFINITY), splat3(-INFINITY)});
    field.group_of_block.resize(blocks, static_cast<int32_t>(field.groups.size()));
    field.groups.push_back(group);
    for (size_t i = 0; i < splats.size(); ++i) {
        store_splat(splats[i].world_from_ball,
                    splats[i].opacity,
                    static_cast<size_t>(group.first) + i,
                    field);
        const auto& m = splats[i].world_from_ball.m;
        const Vec3f mean{
            static_cast<float>(m[0][3]), static_cast<float>(m[1][3]), static_cast<float>(m[2][3])};
        scene.bounds.high = max3(scene.bounds.high, mean);
        scene.bounds.low = -max3(-scene.bounds.low, -mean);
    }
}

/// A round splat.
inline Affined ball(const Vec3d& centre, double sigma) {
    Affined out;
    const double at[3] = {centre.x, centre.y, centre.z};
    for (int r = 0; r < 3; ++r) {
        out.m[r][r] = sigma;
        out.m[r][3] = at[r];
    }
    return out;
}

/// Where a line is closest to a splat's centre, by the covariance matrix.
struct TruePassage {
    double t, squared;  ///< squared: distance in standard deviations
};

inline TruePassage true_passage(const Affined& map, const Vec3d& origin, const Vec3d& direction) {
    Affined covariance;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            covariance.m[r][c] = 0;
            for (int k = 0; k < 3; ++k)
                covariance.m[r][c] += map.m[r][k] * map.m[c][k];
        }
    }
    const Affined precision = inverse(covariance);
    const Vec3d to_mean = Vec3d{map.m[0][3], map.m[1][3], map.m[2][3]} - origin;
    const Vec3d weighted = transform_vector(precision, direction);
    const double along = dot(to_mean, weighted);
    const double size = dot(direction, weighted);
    const double all = dot(to_mean, transform_vector(precision, to_mean));
    return {along / size, all - along * along / size};
}

/// The light that such a splat absorbs, cut off where KHR_gaussian_splatting's kernel ends.
inline double true_alpha(double opacity, double squared) {
    const double alpha = opacity * std::exp(-squared / 2);
    return squared <= 9 && alpha >= 1.0 / 255 ? alpha : 0;
}

}  // namespace obscura::test
