// stages/raycast_notes.h - records what --integrator raycast does for one pixel, light by light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

#include <vector>

namespace obscura {

/// One light's contribution to a pixel.
struct NotedLight {
    int number = 0;      ///< punctual lights first, then RaycastView::centres
    bool asked = false;  ///< a shadow ray was made; else no light can come from there
    Vec3f start = {0, 0, 0}, direction = {0, 0, 0};
    float distance_m = 0;
    Vec3f offered = {0, 0, 0};  ///< its radiance if nothing is in the way
    Vec3f arrived = {0, 0, 0};
};

/// Filled while one pixel is traced, the first of its batch.
struct RaycastNotes {
    Vec3f origin = {0, 0, 0}, direction = {0, 0, 0};
    float passes = 1;  ///< transmittance of the splats before the hit
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

    /// Called once a range of at most one light is shaded, before its shadow ray is traced. The
    /// first range brings the light that needs no shadow ray.
    void add_offer(const RaycastRange& range, int shadows, const RaycastColumns& columns) {
        const SampleView samples = columns.samples;
        if (range.first_light == 0) unshadowed = {samples.r[0], samples.g[0], samples.b[0]};
        if (range.lights == 0) return;
        NotedLight light;
        light.number = range.first_light;
        light.asked = shadows > 0;
        if (light.asked) {
            const ShadowView shadow = columns.shadows;
            light.start = {shadow.ox[0], shadow.oy[0], shadow.oz[0]};
            light.direction = {shadow.dx[0], shadow.dy[0], shadow.dz[0]};
            light.distance_m = shadow.tfar[0];
            light.offered = {shadow.r[0], shadow.g[0], shadow.b[0]};
            before_ = {samples.r[0], samples.g[0], samples.b[0]};
        }
        lights.push_back(light);
    }

    /// Called once its shadow ray is traced, if there was one.
    ///
    /// In  occluded: as stage 4 left it; thin walls may let a part through
    void add_arrival(uint8_t occluded, const RaycastColumns& columns) {
        if (lights.empty() || !lights.back().asked) return;
        const SampleView samples = columns.samples;
        Vec3f& arrived = lights.back().arrived;
        if (occluded == 0)
            arrived = {columns.shadows.r[0], columns.shadows.g[0], columns.shadows.b[0]};
        if (occluded != waits_at_thin_wall) return;
        arrived = Vec3f{samples.r[0], samples.g[0], samples.b[0]} - before_;
    }

private:
    Vec3f before_ = {0, 0, 0};
};

}  // namespace obscura
