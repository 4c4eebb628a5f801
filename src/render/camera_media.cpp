// render/camera_media.cpp - finds the media that a camera is inside of, by counting crossings.
// SPDX-License-Identifier: Apache-2.0
#include "render/camera_media.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

namespace obscura {

namespace {

using Crossings = std::array<int, max_media + 1>;  // by number of the medium

/// Counts the boundaries of each medium along a ray from a point through the whole scene.
Crossings count_crossings(const Accel& accel, const Vec3f& point, const Vec3f& direction) {
    const RayColumns ray{.ox = &point.x,
                         .oy = &point.y,
                         .oz = &point.z,
                         .dx = &direction.x,
                         .dy = &direction.y,
                         .dz = &direction.z,
                         .tfar = nullptr,
                         .key = nullptr,
                         .count = 1};
    std::vector<Crossing> faces;
    constexpr uint8_t passes = camera_rays_pass | bounce_rays_pass;
    accel.list_crossings(ray, 0, {.passes = passes}, faces);
    std::sort(faces.begin(), faces.end(), [](const Crossing& a, const Crossing& b) {
        return std::tie(a.medium, a.enters, a.t) < std::tie(b.medium, b.enters, b.t);
    });
    Crossings crossings = {};
    const Crossing* last = nullptr;
    for (const Crossing& face : faces) {
        // A ray through an edge hits both adjacent faces: they count once.
        constexpr float rounding = 1e-6f;
        const bool again = last != nullptr && last->medium == face.medium &&
                           last->enters == face.enters && face.t - last->t <= rounding * face.t;
        if (!again) ++crossings[static_cast<size_t>(face.medium)];
        last = &face;
    }
    return crossings;
}

}  // namespace

uint32_t medium_stack_around(const Accel& accel, const Scene& scene, const Vec3f& point) {
    if (scene.media.size() < 2) return 0;
    const std::array directions = {normalize(Vec3f{0.61f, 0.53f, -0.59f}),
                                   normalize(Vec3f{-0.47f, 0.29f, 0.83f}),
                                   normalize(Vec3f{0.11f, -0.91f, 0.39f})};
    Crossings votes = {};
    for (const Vec3f& direction : directions) {
        const Crossings crossings = count_crossings(accel, point, direction);
        for (size_t medium = 1; medium < votes.size(); ++medium)
            votes[medium] += crossings[medium] % 2;
    }
    uint32_t medium_stack = 0;
    int shift = 16;
    for (size_t medium = votes.size() - 1; medium > 0 && shift >= 0; --medium) {
        if (2 * votes[medium] < static_cast<int>(directions.size())) continue;
        medium_stack |= static_cast<uint32_t>(medium) << static_cast<uint32_t>(shift);
        shift -= 8;
    }
    return medium_stack;
}

}  // namespace obscura
