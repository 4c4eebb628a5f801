// stages/1_shutter.cpp - stage 1, if something moves: draws a shutter time for every path.
// SPDX-License-Identifier: Apache-2.0
#include "stages/1_shutter.h"

#include "math/sampler.h"
#include "stages/3_tables.h"
#include "stages/moment.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// The camera's movement since the shutter opened.
OBSCURA_INLINE Affine<Lanes> camera_moved(const MotionView& motion, Lanes time) {
    const Moment moment = moment_of(motion.camera_steps, time);
    const TableRecord<Lanes, Affinef> before(motion.camera, moment.step);
    const TableRecord<Lanes, Affinef> after(motion.camera, moment.step + LanesI(1));
    return blend(read_affine(before), read_affine(after), moment.fraction);
}

}  // namespace

void open_shutter(const SceneView& scene,
                  bool through_centres,
                  int count,
                  const PathColumns& paths,
                  float* time) {
    for (int i = 0; i < count; i += lane_count) {
        Lanes at(0.5f);
        if (!through_centres) {
            const Vec2<LanesU> bits =
                sobol_pair(load(paths.key + i), load(paths.sample + i), shutter_pair);
            at = unit_float<Lanes>(bits.x);
        }
        store(time + i, at);
        if (scene.motion.camera == nullptr) continue;
        const Affine<Lanes> moved = camera_moved(scene.motion, at);
        const Vec3<Lanes> origin = load3(paths.ox, paths.oy, paths.oz, i);
        const Vec3<Lanes> direction = load3(paths.dx, paths.dy, paths.dz, i);
        store3(paths.ox, paths.oy, paths.oz, i, transform_point(moved, origin));
        store3(paths.dx, paths.dy, paths.dz, i, normalize(transform_vector(moved, direction)));
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
