// stages/wavefront_aov.cpp - AOVs between the stages: their columns, and what paths find later.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_aov.h"

#include "base/stopwatch.h"
#include "stages/wavefront_slots.h"

#include <algorithm>

namespace obscura {

namespace {

/// Whether the AOV `albedo` of a batch's samples is followed beyond their first hits, as it is
/// where there are paths.
///
/// Out     work.looking_for_albedo. Returns AovColumns::passed_on
float* begin_albedo(const WavefrontInput& in, int count, Workspace& work) {
    const bool wanted = std::find(in.aovs.begin(), in.aovs.end(), Aov::albedo) != in.aovs.end();
    const bool follows = wanted && in.kind == WavefrontKind::path;
    work.looking_for_albedo = follows ? count : 0;
    if (!follows) return nullptr;
    work.passed_on.resize(padded_batch_size);
    return work.passed_on.data();
}

}  // namespace

std::span<const AovOutput> aovs_in_samples(std::span<const Aov> aovs, Workspace& work) {
    const SampleColumns& samples = work.samples;
    float* const columns[] = {samples.r, samples.g, samples.b, samples.a};
    size_t next = 0;
    work.aov_outputs.clear();
    for (const Aov aov : aovs) {
        AovOutput output{aov, {}};
        for (int c = 0; c < channel_count(aov); ++c)
            output.columns[c] = columns[next++];
        work.aov_outputs.push_back(output);
    }
    return work.aov_outputs;
}

void write_aovs(const WavefrontInput& in,
                int count,
                std::span<const AovOutput> outputs,
                Workspace& work,
                WavefrontCounters& c) {
    if (outputs.empty()) return;
    const SumOfTime time(c.seconds.shade);
    in.stages->aovs(in.scene,
                    in.batch,
                    count,
                    {.paths = work.paths[0],
                     .hits = work.hits,
                     .time = slot_times(in, work),
                     .outputs = outputs,
                     .passed_on = begin_albedo(in, count, work),
                     .frames = in.frames});
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
