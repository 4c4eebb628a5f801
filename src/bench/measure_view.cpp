// bench/measure_view.cpp - renders one view and replays its rays on bare Embree, repeatedly.
// SPDX-License-Identifier: Apache-2.0
#include "bench/measure_view.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace obscura::bench {

namespace {

/// Replays of one kind of rays in one mode: their times, and the hits of each.
struct ModeTimes {
    ReplayMode mode;
    std::vector<double> seconds;
    uint64_t hits = 0;
};

/// Coherent packets for rays that a camera or a lamp sends; bounces go everywhere.
std::vector<ModeTimes> modes_of(RayKind kind) {
    std::vector<ModeTimes> modes = {{ReplayMode::single, {}}, {ReplayMode::packets, {}}};
    if (kind != RayKind::bounce) modes.push_back({ReplayMode::coherent_packets, {}});
    if (kind == RayKind::camera) modes.push_back({ReplayMode::coherent_streams, {}});
    return modes;
}

/// All replays of one view.
class Replays {
public:
    Replays(const Accel& accel, const RayRecording& recording)
        : accel_(accel), recording_(recording) {
        for (size_t k = 0; k < ray_kinds; ++k)
            modes_[k] = modes_of(static_cast<RayKind>(k));
    }

    void run_once() {
        for (size_t k = 0; k < ray_kinds; ++k) {
            if (recording_.count(static_cast<RayKind>(k)) == 0) continue;
            for (ModeTimes& mode : modes_[k]) {
                const ReplayResult result =
                    accel_.replay(recording_, static_cast<RayKind>(k), mode.mode);
                mode.seconds.push_back(result.seconds);
                mode.hits = result.hits;
            }
        }
    }

    /// The mode with the least median time; null without such rays.
    const ModeTimes* best(RayKind kind) const {
        const std::vector<ModeTimes>& modes = modes_[static_cast<size_t>(kind)];
        const auto median = [](const ModeTimes& m) { return spread_of(m.seconds).median; };
        const auto least = std::min_element(
            modes.begin(), modes.end(), [&](const ModeTimes& a, const ModeTimes& b) {
                return median(a) < median(b);
            });
        return least->seconds.empty() ? nullptr : &*least;
    }

    /// Seconds of the i-th replay of all kinds, each in its best mode.
    double seconds_of_run(size_t i) const {
        double sum = 0;
        for (size_t k = 0; k < ray_kinds; ++k) {
            const ModeTimes* mode = best(static_cast<RayKind>(k));
            if (mode != nullptr) sum += mode->seconds[i];
        }
        return sum;
    }

private:
    const Accel& accel_;
    const RayRecording& recording_;
    std::array<std::vector<ModeTimes>, ray_kinds> modes_;
};

void fill_kinds(const RayRecording& recording,
                const Replays& replays,
                const StageSeconds& stages,
                ViewFigures& out) {
    const double stage_s[ray_kinds] = {
        stages.intersect_camera, stages.intersect_bounce, stages.shadow};
    for (size_t k = 0; k < ray_kinds; ++k) {
        const auto kind = static_cast<RayKind>(k);
        KindFigures& figures = out.kinds[k];
        figures.rays = recording.count(kind);
        figures.hits = recording.hits(kind);
        figures.spared = recording.spared(kind);
        figures.render_s = stage_s[k] / std::max(out.threads, 1);
        const ModeTimes* mode = replays.best(kind);
        if (mode == nullptr) continue;
        figures.mode = mode->mode;
        figures.bare_s = spread_of(mode->seconds);
        figures.bare_hits = mode->hits;
    }
}

/// Renderings one after the other.
struct Renders {
    std::vector<double> seconds;
    std::array<std::vector<double>, 5> stage_s;
    RenderCounters counters;  ///< of the latest

    void add(const RenderResult& result) {
        seconds.push_back(result.render_seconds);
        counters = result.counters;
        const auto stages = by_stage(result.counters.stages);
        for (size_t i = 0; i < stages.size(); ++i)
            stage_s[i].push_back(stages[i].seconds);
    }
};

/// NaN never equals itself, so bits are compared.
bool same_bits(std::span<const float> a, std::span<const float> b) {
    const auto bytes_a = std::as_bytes(std::span(a));
    const auto bytes_b = std::as_bytes(std::span(b));
    return std::equal(bytes_a.begin(), bytes_a.end(), bytes_b.begin(), bytes_b.end());
}

}  // namespace

Result<ViewFigures> measure_view(const ViewTask& task, const std::atomic<bool>& stop) {
    UnsetArray<float> film_memory;
    const auto render_once = [&](RayRecording* recording) {
        RenderOptions options = task.options;
        options.recording = recording;
        options.film_memory = &film_memory;
        return render(*task.scene, task.camera, options, {}, stop);
    };
    const Result<RenderResult> first = render_once(nullptr);
    if (!first) return fail(first.error());
    if (task.after_first) task.after_first();
    RayRecording recording;
    const Result<RenderResult> recorded = render_once(&recording);
    if (!recorded) return fail(recorded.error());

    Replays replays(task.scene->accel(), recording);
    Renders renders;
    for (int i = 0; i < task.repeat; ++i) {
        Result<RenderResult> result = render_once(nullptr);
        if (!result) return fail(result.error());
        renders.add(*result);
        film_memory = std::move(result->film.pixels);
        replays.run_once();
    }

    ViewFigures out;
    out.isa = task.scene->isa_name();
    out.threads = task.threads;
    out.film_bytes = first->film.pixels.size() * sizeof(float);
    out.recording_changed_image = !same_bits(first->film.pixels, recorded->film.pixels);
    std::vector<double> replay_s;
    std::vector<double> of_bare;
    for (size_t i = 0; i < renders.seconds.size(); ++i) {
        replay_s.push_back(replays.seconds_of_run(i));
        of_bare.push_back(replay_s.back() / std::max(renders.seconds[i], 1e-12));
    }
    out.render_s = spread_of(renders.seconds);
    out.replay_s = spread_of(replay_s);
    out.of_bare = spread_of(of_bare);
    for (size_t i = 0; i < out.stage_s.size(); ++i)
        out.stage_s[i] = spread_of(renders.stage_s[i]);
    out.counters = renders.counters;
    fill_kinds(recording, replays, renders.counters.stages, out);
    return out;
}

std::vector<std::string> doubts_about(const ViewFigures& view) {
    std::vector<std::string> doubts;
    // Beside starting and ending the threads, a shorter rendering has too few rays to measure.
    constexpr double min_render_s = 0.05;
    if (view.render_s.count > 0 && view.render_s.median < min_render_s) {
        doubts.push_back(
            fmt::format("a rendering takes {:.0f} ms, too little to measure well; more "
                        "--spp or a larger --size help",
                        1000 * view.render_s.median));
    }
    if (view.recording_changed_image) doubts.push_back("recording the rays changed the picture");
    for (size_t k = 0; k < ray_kinds; ++k) {
        const KindFigures& kind = view.kinds[k];
        if (kind.rays == 0) continue;
        // Edges that two triangles share may go either way in packets. Rays that the renderer lets
        // pass a face hit it here, so more hits are expected.
        const uint64_t tolerance = 2 + kind.rays / 10000;
        const bool lost = kind.bare_hits + tolerance < kind.hits;
        const bool too_many = static_cast<RayKind>(k) == RayKind::shadow &&
                              kind.bare_hits > kind.hits + kind.spared + tolerance;
        if (!lost && !too_many) continue;
        doubts.push_back("the replay of the " + std::string(ray_kind_names[k]) + " rays found " +
                         std::to_string(kind.bare_hits) + " hits, the rendering " +
                         std::to_string(kind.hits) +
                         ": they are not the same rays, do not trust 'of bare Embree'");
    }
    return doubts;
}

}  // namespace obscura::bench
