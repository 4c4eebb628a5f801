// session/statistics.h - the --stats file: times, memory, counters and warnings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "session/render_request.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// Figures of one frame of a sequence.
struct FrameStatistics {
    int number = 0;
    double time_s = 0;
    double load_s = 0;
    double build_s = 0;
    double render_s = 0;
    double write_s = 0;
};

/// Everything that --stats writes beside the request; for a sequence the sums over all frames and
/// the memory of the last one.
struct RenderStatistics {
    std::string isa;
    std::string embree;
    int threads = 0;
    double load_s = 0;  ///< the whole file, with parse_s and decode_s
    double parse_s = 0;
    double decode_s = 0;  ///< images
    double build_s = 0;
    double render_s = 0;
    double write_s = 0;
    double total_s = 0;
    RenderCounters counters;
    std::optional<SamplesTaken> adaptive;  ///< of a sequence the sums, and the extremes
    size_t bvh_bytes = 0;
    size_t geometry_bytes = 0;
    size_t texture_bytes = 0;
    size_t film_bytes = 0;
    std::vector<std::string> warnings;
    gltf::Degraded degraded;              ///< of a sequence the maximum over frames
    std::vector<FrameStatistics> frames;  ///< empty for a single image
};

/// Adds the counters of one more frame.
void add_counters(const RenderCounters& from, RenderCounters& to);

/// Adds the samples of one more frame.
void add_samples(const SamplesTaken& from, std::optional<SamplesTaken>& to);

/// Keeps the greater of each count.
void add_degraded(const gltf::Degraded& from, gltf::Degraded& to);

/// Rays of every kind.
uint64_t total_rays(const RenderCounters& counters);

/// The JSON document; docs/cli.md explains the keys.
std::string statistics_json(const RenderRequest& request, const RenderStatistics& statistics);

/// True when more than one sample in a million was not finite: exit code 76.
bool too_many_nonfinite(const RenderCounters& counters);

}  // namespace obscura
