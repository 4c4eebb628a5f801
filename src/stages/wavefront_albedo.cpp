// stages/wavefront_albedo.cpp - follows paths through mirrors and glass for the AOV `albedo`.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_albedo.h"

#include "base/stopwatch.h"

#include <algorithm>

namespace obscura {

float* begin_albedo(const WavefrontInput& in, int count, Workspace& work) {
    const bool wanted = std::find(in.aovs.begin(), in.aovs.end(), Aov::albedo) != in.aovs.end();
    const bool follows = wanted && in.kind == WavefrontKind::path;
    work.looking_for_albedo = follows ? count : 0;
    if (!follows) return nullptr;
    work.passed_on.resize(padded_batch_size);
    return work.passed_on.data();
}

void look_for_albedo(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c) {
    const SumOfTime time(c.seconds.shade);
    const auto is_albedo = [](const AovOutput& output) { return output.aov == Aov::albedo; };
    const AlbedoColumns columns{
        .paths = work.paths[0],
        .hits = work.hits,
        .time = moves(in.scene.motion) ? work.slot_time.data() : nullptr,
        .shared = work.shared_faces.empty() ? nullptr : work.shared_faces.data(),
        .followed_paths = work.paths[1],
        .followed_hits = work.random_walk_hits,
        .passed_on = work.passed_on.data(),
        .albedo = *std::find_if(work.aov_outputs.begin(), work.aov_outputs.end(), is_albedo)};
    work.looking_for_albedo = in.stages->follow_albedo(in.scene, in.batch, bounce, count, columns);
}

}  // namespace obscura
