// bench/report.h - all figures of a bench, as plain data.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/ray_recording.h"
#include "bench/spread.h"
#include "math/vec.h"
#include "render/render.h"

#include <array>
#include <string>
#include <vector>

namespace obscura::bench {

/// A cache of the first core. Source: Linux, /sys/devices/system/cpu/cpu0/cache.
struct CpuCache {
    int level = 0;
    std::string type;  ///< "Data", "Instruction" or "Unified"
    std::string size;  ///< as Linux says it: "512K"
};

struct Machine {
    std::string cpu;
    int cores = 0;         ///< that this process may use
    double clock_mhz = 0;  ///< the greatest that the system tells; 0: it tells none
    std::vector<CpuCache> caches;
    int numa_nodes = 0;  ///< 0: not known
    double load = 0;     ///< mean number of running threads in the minute before; -1: not known
    std::string embree;
    std::string compiler;
    std::string build_type;
    std::string version;  ///< of this program
};

struct BenchSettings {
    int width = 0;
    int height = 0;
    int samples_per_pixel = 0;
    int max_bounces = 0;
    uint64_t seed = 0;
    std::string integrator;
    std::string environment;  ///< file; empty: the scene's own light or the studio
    int repeat = 0;
};

/// A view in terms that any renderer understands.
struct ViewCamera {
    Vec3d eye_m = {0, 0, 0};
    Vec3d target_m = {0, 0, -1};
    Vec3d up = {0, 1, 0};
    double yfov_deg = 0;  ///< vertical
};

/// Times of reading and preparing the file, beside its bytes and bare Embree.
struct LoadFigures {
    Spread load_s;  ///< from the file to a scene, with parse_s and decode_s
    Spread parse_s;
    Spread decode_s;   ///< images
    Spread prepare_s;  ///< light tables and BVH, with bvh_s
    Spread bvh_s;
    Spread read_s;      ///< the bytes of all its files, nothing else
    Spread bare_bvh_s;  ///< bare Embree's for the same triangles
    Spread of_bare;     ///< (read + bare BVH) / (load + prepare)
    size_t file_bytes = 0;
    size_t triangles = 0;           ///< as stored
    size_t triangles_in_world = 0;  ///< with every instance
};

struct MemoryFigures {
    size_t bvh = 0;
    size_t geometry = 0;
    size_t textures = 0;
    size_t film = 0;
    size_t peak = 0;  ///< of the process, while this scene was loaded and rendered
    size_t bare_bvh = 0;
    size_t bare_vertices = 0;
    size_t bare_texels = 0;

    size_t scene() const { return bvh + geometry + textures; }
    size_t bare() const { return bare_bvh + bare_vertices + bare_texels; }
};

/// The rays of one kind, traced by the renderer and by bare Embree.
struct KindFigures {
    uint64_t rays = 0;
    uint64_t hits = 0;                     ///< or occluded rays, in the rendering
    uint64_t bare_hits = 0;                ///< likewise, in the replay
    uint64_t spared = 0;                   ///< rays that only the replay may find occluded
    ReplayMode mode = ReplayMode::single;  ///< the fastest
    Spread bare_s;                         ///< time of the replay in that mode
    double render_s = 0;                   ///< wall-clock time of the stage that traces them
};

/// One scene seen by one camera, on some threads and with some instruction set.
struct ViewFigures {
    std::string name;         ///< "whole", "close", "own"
    std::string description;  ///< of the camera
    ViewCamera camera;
    double coverage = 0;  ///< fraction of the frame that the asset covers
    std::string isa;
    int threads = 0;
    Spread render_s;
    Spread replay_s;
    Spread of_bare;                 ///< replay / render of the very same samples
    std::array<Spread, 5> stage_s;  ///< summed over threads, in the order of by_stage()
    RenderCounters counters;        ///< of one rendering
    std::array<KindFigures, ray_kinds> kinds;
    size_t film_bytes = 0;
    bool recording_changed_image = false;
};

struct SceneFigures {
    std::string file;
    std::string name;  ///< without folder and extension
    LoadFigures load;
    MemoryFigures memory;
    std::vector<ViewFigures> views;
    std::vector<ViewFigures> by_threads;  ///< --threads: every view with every count
    std::vector<ViewFigures> by_isa;      ///< --isa: every view with every set
};

struct BenchReport {
    Machine machine;
    BenchSettings settings;
    std::vector<SceneFigures> scenes;
    std::vector<std::string> warnings;
};

inline constexpr std::array<const char*, ray_kinds> ray_kind_names = {"camera", "bounce", "shadow"};

/// Names of the stages, in the order of ViewFigures::stage_s.
std::array<const char*, 5> stage_names();

/// "single", "packets of 16", "coherent packets of 16".
const char* replay_mode_name(ReplayMode mode);

/// Fraction of the total time in each stage; zero when no time was spent.
std::array<double, 5> stage_fractions(const ViewFigures& view);

/// Fraction of the threads' time outside all stages in the median rendering: tiles, waiting.
double outside_stages(const ViewFigures& view);

/// Count per second of the median rendering.
double per_second(const ViewFigures& view, uint64_t count);

/// Speed-up of `row` over `base`, and that divided by the ratio of their thread counts.
double speedup_over(const ViewFigures& base, const ViewFigures& row);
double parallel_efficiency(const ViewFigures& base, const ViewFigures& row);

/// How many times faster the shading stage of `row` is.
double shading_speedup(const ViewFigures& base, const ViewFigures& row);

/// The entry of by_threads with the same view and the fewest threads.
const ViewFigures& fewest_threads(const SceneFigures& scene, const ViewFigures& row);

/// The entry of by_isa with the same view and "baseline"; null when that was not measured.
const ViewFigures* baseline_row(const SceneFigures& scene, const ViewFigures& row);

/// The figures as a table for people.
std::string bench_table(const BenchReport& report);

}  // namespace obscura::bench
