// render/counts.cpp - counters of rays and faults: sums, differences, and as numbers of a file.
// SPDX-License-Identifier: Apache-2.0
#include "render/counts.h"

namespace obscura {

namespace {

template <typename Counters>
void add_all(const Counters& from, RenderCounters& to) {
    to.paths += from.paths;
    to.camera_rays += from.camera_rays;
    to.bounce_rays += from.bounce_rays;
    to.shadow_rays += from.shadow_rays;
    to.refused_rays += from.refused_rays;
    to.nonfinite_samples += from.nonfinite_samples;
}

}  // namespace

void add_counts(const WavefrontCounters& from, RenderCounters& to) {
    add_all(from, to);
}

void add_counts(const RenderCounters& from, RenderCounters& to) {
    add_all(from, to);
}

RenderCounters counted_since(const RenderCounters& before, const WavefrontCounters& now) {
    RenderCounters out;
    out.paths = now.paths - before.paths;
    out.camera_rays = now.camera_rays - before.camera_rays;
    out.bounce_rays = now.bounce_rays - before.bounce_rays;
    out.shadow_rays = now.shadow_rays - before.shadow_rays;
    out.refused_rays = now.refused_rays - before.refused_rays;
    out.nonfinite_samples = now.nonfinite_samples - before.nonfinite_samples;
    return out;
}

std::array<uint64_t, 6> counters_in_file(const RenderCounters& counters) {
    return {counters.paths,
            counters.camera_rays,
            counters.bounce_rays,
            counters.shadow_rays,
            counters.refused_rays,
            counters.nonfinite_samples};
}

RenderCounters counters_from_file(const std::array<uint64_t, 6>& counters) {
    RenderCounters out;
    out.paths = counters[0];
    out.camera_rays = counters[1];
    out.bounce_rays = counters[2];
    out.shadow_rays = counters[3];
    out.refused_rays = counters[4];
    out.nonfinite_samples = counters[5];
    return out;
}

}  // namespace obscura
