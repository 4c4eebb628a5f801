// render/camera_bodies.cpp - finds the bodies around a camera by counting their boundaries.
// SPDX-License-Identifier: Apache-2.0
#include "render/camera_bodies.h"

#include <array>

namespace obscura {

namespace {

using Crossings = std::array<int, most_media + 1>;  // by number of the medium

int32_t medium_of(const Scene& scene, int32_t primitive) {
    const auto row = static_cast<size_t>(scene.primitives[static_cast<size_t>(primitive)].material);
    const int32_t layers = scene.materials[row].layers;
    return layers < 0 ? 0 : scene.layers[static_cast<size_t>(layers)].medium;
}

/// One query; the columns have the padding that Accel asks for.
struct OneHit {
    static constexpr size_t rows = 32;
    std::array<float, rows> t = {}, u = {}, v = {};
    std::array<int32_t, rows> instance = {}, primitive = {}, triangle = {};

    HitColumns columns() {
        return {t.data(), u.data(), v.data(), instance.data(), primitive.data(), triangle.data()};
    }
};

/// Counts the boundaries of each medium from a point to the end of the scene.
Crossings count_crossings(const Accel& accel,
                          const Scene& scene,
                          const Vec3f& point,
                          const Vec3f& direction) {
    constexpr int most_hits = 10000;
    constexpr float step = 1e-5f;  // beyond a hit, by the size of what is looked at
    const float size = max_component(abs(point)) + length(scene.bounds.high - scene.bounds.low);
    Crossings crossings = {};
    Vec3f origin = point;
    for (int n = 0; n < most_hits; ++n) {
        OneHit hit;
        const RayColumns ray{&origin.x,
                             &origin.y,
                             &origin.z,
                             &direction.x,
                             &direction.y,
                             &direction.z,
                             nullptr,
                             nullptr,
                             1};
        accel.intersect(ray, hit.columns(), Coherence::incoherent, {});
        if (hit.primitive[0] < 0) break;
        ++crossings[static_cast<size_t>(medium_of(scene, hit.primitive[0]))];
        origin = origin + direction * (hit.t[0] + step * size);
    }
    return crossings;
}

}  // namespace

uint32_t bodies_around(const Accel& accel, const Scene& scene, const Vec3f& point) {
    if (scene.media.size() < 2) return 0;
    const std::array directions = {normalize(Vec3f{0.61f, 0.53f, -0.59f}),
                                   normalize(Vec3f{-0.47f, 0.29f, 0.83f}),
                                   normalize(Vec3f{0.11f, -0.91f, 0.39f})};
    Crossings votes = {};
    for (const Vec3f& direction : directions) {
        const Crossings crossings = count_crossings(accel, scene, point, direction);
        for (size_t medium = 1; medium < votes.size(); ++medium)
            votes[medium] += crossings[medium] % 2;
    }
    uint32_t bodies = 0;
    int shift = 16;
    for (size_t medium = votes.size() - 1; medium > 0 && shift >= 0; --medium) {
        if (2 * votes[medium] < static_cast<int>(directions.size())) continue;
        bodies |= static_cast<uint32_t>(medium) << static_cast<uint32_t>(shift);
        shift -= 8;
    }
    return bodies;
}

}  // namespace obscura
