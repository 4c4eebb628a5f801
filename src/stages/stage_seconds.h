// stages/stage_seconds.h - how long the stages took.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace obscura {

/// Seconds in each stage, summed over threads. Camera and bounce rays are counted separately.
struct StageSeconds {
    double camera = 0;
    double intersect_camera = 0;
    double intersect_bounce = 0;
    double shade = 0;
    double shadow = 0;
    double accumulate = 0;

    double intersect() const { return intersect_camera + intersect_bounce; }
    double sum() const { return camera + intersect() + shade + shadow + accumulate; }
    void add(const StageSeconds& other) {
        camera += other.camera;
        intersect_camera += other.intersect_camera;
        intersect_bounce += other.intersect_bounce;
        shade += other.shade;
        shadow += other.shadow;
        accumulate += other.accumulate;
    }
};

/// One stage under the name that reports give it.
struct NamedSeconds {
    const char* name;
    double seconds;
};

/// The stages in the order of the wavefront pipeline.
inline std::array<NamedSeconds, 5> by_stage(const StageSeconds& s) {
    return {{{"camera", s.camera},
             {"intersect", s.intersect()},
             {"shade", s.shade},
             {"shadow", s.shadow},
             {"accumulate", s.accumulate}}};
}

}  // namespace obscura
