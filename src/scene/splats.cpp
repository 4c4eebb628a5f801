// scene/splats.cpp - Gaussian splats in world space: what rays read of them, and their colours.
// SPDX-License-Identifier: Apache-2.0
#include "scene/splats.h"

#include "surface/harmonics.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

Vec3d column(const Affined& map, int c) {
    return {map.m[0][c], map.m[1][c], map.m[2][c]};
}

}  // namespace

ShapeBox splat_box(const Affined& world_from_ball, double opacity) {
    const double least = static_cast<double>(min_splat_alpha);
    if (!(opacity >= least)) return {splat3(INFINITY), splat3(-INFINITY)};
    const double drawn = std::sqrt(2 * std::log(opacity / least));
    // Slightly enlarged: rays compute the end in single precision.
    const double reach = 1.001 * std::min(drawn, static_cast<double>(splat_reach)) + 0.001;
    float low[3];
    float high[3];
    for (int r = 0; r < 3; ++r) {
        const double* row = world_from_ball.m[r];
        const double half =
            reach * std::hypot(row[0], row[1], row[2]) + 1e-6 * std::abs(row[3]) + 1e-30;
        low[r] = static_cast<float>(row[3] - half);
        high[r] = static_cast<float>(row[3] + half);
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

void store_splat(const Affined& world_from_ball, float opacity, size_t index, SplatField& field) {
    const size_t within = index % splat_block;
    float* at = &field.blocks[(index - within) * splat_columns + within];
    const Affined ball_from_world = inverse(world_from_ball);
    const Vec3d mean = column(world_from_ball, 3);
    const double numbers[splat_columns] = {
        mean.x,
        mean.y,
        mean.z,
        ball_from_world.m[0][0],
        ball_from_world.m[0][1],
        ball_from_world.m[0][2],
        ball_from_world.m[1][0],
        ball_from_world.m[1][1],
        ball_from_world.m[1][2],
        ball_from_world.m[2][0],
        ball_from_world.m[2][1],
        ball_from_world.m[2][2],
        static_cast<double>(opacity),
    };
    constexpr double largest = 1e15;  // its square, times a direction's, is still a float
    const bool fits = std::all_of(
        numbers + 3, numbers + splat_columns, [](double x) { return std::abs(x) <= largest; });
    for (size_t i = 0; i < splat_columns; ++i)
        at[i * splat_block] = fits ? static_cast<float>(numbers[i]) : 0.0f;
    if (!fits) return;
    const ShapeBox box = splat_box(world_from_ball, static_cast<double>(opacity));
    ShapeBox& all = field.boxes[index / splat_block];
    all.low = -max3(-all.low, -box.low);
    all.high = max3(all.high, box.high);
}

Vec3f splat_color(const SplatField& field, size_t index, const Vec3f& direction) {
    const auto number = static_cast<size_t>(field.group_of_block[index / splat_block]);
    const SplatGroup& group = field.groups[number];
    const size_t splat = index - static_cast<size_t>(group.first);
    const float* base = &field.colors[group.first_color + 3 * splat];
    float rgb[3] = {base[0], base[1], base[2]};
    const auto count = static_cast<size_t>(directional_harmonics(group.degree));
    if (count > 0) {
        float y[max_harmonics];
        real_harmonics(normalize(transform_vector(group.object_from_world, direction)), y);
        const int16_t* code = &field.harmonics[group.first_harmonic + 3 * count * splat];
        float sum[3] = {0, 0, 0};
        for (size_t i = 0; i < count; ++i, code += 3) {
            for (size_t c = 0; c < 3; ++c)
                sum[c] += y[i + 1] * static_cast<float>(code[c]);
        }
        for (size_t c = 0; c < 3; ++c)
            rgb[c] += sum[c] * group.harmonic_step;
    }
    return max3(Vec3f{rgb[0], rgb[1], rgb[2]}, splat3(0.0f));
}

size_t splat_bytes(const SplatField& field) {
    return field.blocks.size() * sizeof(float) + field.boxes.size() * sizeof(ShapeBox) +
           field.group_of_block.size() * sizeof(int32_t) +
           field.groups.size() * sizeof(SplatGroup) + field.colors.size() * sizeof(float) +
           field.harmonics.size() * sizeof(int16_t);
}

}  // namespace obscura
