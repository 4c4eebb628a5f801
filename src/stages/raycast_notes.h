// stages/raycast_notes.h - what --integrator raycast does for one pixel, light by light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

#include <vector>

namespace obscura {

/// One light's share of a pixel.
struct NotedLight {
    int number = 0;      ///< punctual lights first, then RaycastView::centres
    bool asked = false;  ///< a shadow ray was made; else no light can come from there
    Vec3f start = {0, 0, 0}, direction = {0, 0, 0};
    float distance_m = 0;
    Vec3f offered = {0, 0, 0};  ///< radiance that is seen if nothing is in the way
    Vec3f arrived = {0, 0, 0};
};

/// Filled by a walk of one pixel, the first of its batch.
struct RaycastNotes {
    Vec3f origin = {0, 0, 0}, direction = {0, 0, 0};
    float passes = 1;  ///< share of the light from the hit that splats before it leave
    float t = 0;
    int32_t instance = -1, primitive = -1, triangle = -1;  ///< primitive -1: nothing was hit
    Vec3f unshadowed = {0, 0, 0};  ///< emission, the environment, the headlight, splats
    std::vector<NotedLight> lights;

    void add_ray(const PathView& path, const HitView& hit) {
        origin = {path.ox[0], path.oy[0], path.oz[0]};
        direction = {path.dx[0], path.dy[0], path.dz[0]};
        passes = path.tr[0];
        t = hit.t[0];
        instance = hit.instance[0];
        primitive = hit.primitive[0];
        triangle = hit.triangle[0];
    }

    /// Once a range of at most one light is shaded, before its shadow ray is asked. What needs no
    /// shadow ray comes with the first range.
    void add_offer(const RaycastRange& range, int shadows, const RaycastColumns& rows) {
        const SampleView samples = rows.samples;
        if (range.first_light == 0) unshadowed = {samples.r[0], samples.g[0], samples.b[0]};
        if (range.lights == 0) return;
        NotedLight light;
        light.number = range.first_light;
        light.asked = shadows > 0;
        if (light.asked) {
            const ShadowView shadow = rows.shadows;
            light.start = {shadow.ox[0], shadow.oy[0], shadow.oz[0]};
            light.direction = {shadow.dx[0], shadow.dy[0], shadow.dz[0]};
            light.distance_m = shadow.tfar[0];
            light.offered = {shadow.r[0], shadow.g[0], shadow.b[0]};
            before_ = {samples.r[0], samples.g[0], samples.b[0]};
        }
        lights.push_back(light);
    }

    /// Once its shadow ray is answered, if there was one.
    ///
    /// In  occluded: as stage 4 left it; thin walls may let a part through
    void add_arrival(uint8_t occluded, const RaycastColumns& rows) {
        if (lights.empty() || !lights.back().asked) return;
        const SampleView samples = rows.samples;
        Vec3f& arrived = lights.back().arrived;
        if (occluded == 0) arrived = {rows.shadows.r[0], rows.shadows.g[0], rows.shadows.b[0]};
        if (occluded != waits_at_wall) return;
        arrived = Vec3f{samples.r[0], samples.g[0], samples.b[0]} - before_;
    }

private:
    Vec3f before_ = {0, 0, 0};
};

}  // namespace obscura
