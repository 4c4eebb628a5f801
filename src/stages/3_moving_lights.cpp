// stages/3_moving_lights.cpp - punctual lights and light triangles at the time of the hit.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_moving_lights.h"

#include "stages/moment.h"

namespace obscura {
inline namespace OBSCURA_ISA {

void sample_moving_punctual(const SceneView& scene,
                            LanesI index,
                            Lanes time,
                            const Vec3<Lanes>& from,
                            PunctualSample<Lanes>& out) {
    const LightView& lights = scene.lights;
    const Moment moment = moment_of(scene.motion.steps, time);
    const LanesI at = index * LanesI(scene.motion.steps) + moment.step;
    const bool profiles = lights.profiles.records != nullptr;
    const auto before = read_punctual<Lanes>(lights.moving_punctual, at, profiles);
    const auto after = read_punctual<Lanes>(lights.moving_punctual, at + LanesI(1), profiles);
    out = sample_punctual<Lanes>(blend(before, after, moment.fraction), from, lights.profiles);
}

TriangleCorners<Lanes> moved_light_corners(const SceneView& scene,
                                           LanesI index,
                                           Lanes time,
                                           const TriangleCorners<Lanes>& still) {
    const TableRecord<Lanes, TriangleLight> light(scene.lights.triangles, index);
    const LanesI first = light.integer<&TriangleLight::motion>();
    const Mask moves = first >= LanesI(0);
    if (none(moves)) return still;
    const Moment moment = moment_of(scene.motion.steps, time);
    const LanesI at = select(moves, first + moment.step, LanesI(0));
    const TableRecord<Lanes, MovingTriangle> before(scene.lights.moving_triangles, at);
    const TableRecord<Lanes, MovingTriangle> after(scene.lights.moving_triangles,
                                                   select(moves, at + LanesI(1), LanesI(0)));
    const auto corner = [&]<auto member>(Member<member>, const Vec3<Lanes>& otherwise) {
        const auto mix = [&](int k) {
            const Lanes from = before.number<member>(k);
            return from + (after.number<member>(k) - from) * moment.fraction;
        };
        return select(moves, Vec3<Lanes>{mix(0), mix(1), mix(2)}, otherwise);
    };
    TriangleCorners<Lanes> out = still;
    out.p0 = corner(Member<&MovingTriangle::p0>{}, still.p0);
    out.e1 = corner(Member<&MovingTriangle::e1>{}, still.e1);
    out.e2 = corner(Member<&MovingTriangle::e2>{}, still.e2);
    // The probability of choosing the triangle stays while its area changes.
    const Lanes area = Lanes(0.5f) * length(cross(out.e1, out.e2));
    const Lanes choice = still.pdf_area * still.area;
    out.area = select(moves, area, still.area);
    out.pdf_area = select(moves, choice / max(area, Lanes(1e-36f)), still.pdf_area);
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
