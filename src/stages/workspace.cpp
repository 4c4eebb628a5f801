// stages/workspace.cpp - the columns of one batch in one block of memory.
// SPDX-License-Identifier: Apache-2.0
#include "stages/walk.h"

#include <memory>

namespace obscura {

namespace {

constexpr size_t alignment = 64;

/// Hands out aligned columns from one block of memory.
class Carver {
public:
    explicit Carver(std::byte* memory) : next_(memory) {}

    template <typename T>
    void operator()(T*& column) {
        column = reinterpret_cast<T*>(next_);
        next_ += (padded_rows * sizeof(T) + alignment - 1) / alignment * alignment;
    }
    template <typename... T>
    void all(T*&... columns) {
        ((*this)(columns), ...);
    }

private:
    std::byte* next_;
};

void carve_paths(Carver& carve, PathRows& p) {
    carve.all(p.ox, p.oy, p.oz, p.dx, p.dy, p.dz, p.tr, p.tg, p.tb);
    carve.all(p.pdf, p.cone_width, p.cone_spread, p.slot, p.key, p.sample, p.path_key, p.bodies);
}

}  // namespace

Workspace::Workspace() {
    constexpr size_t words = 2 * words_per_path + 2 * words_per_hit + words_per_miss +
                             words_per_shadow + words_per_sample;
    memory_.resize(words * (padded_rows * 4 + alignment) + alignment);
    void* start = memory_.data();
    size_t space = memory_.size();
    Carver carve(
        static_cast<std::byte*>(std::align(alignment, memory_.size() - alignment, start, space)));
    for (PathRows& p : paths)
        carve_paths(carve, p);
    carve.all(hits.t, hits.u, hits.v, hits.instance, hits.primitive, hits.triangle);
    carve.all(walker_hits.t, walker_hits.u, walker_hits.v);
    carve.all(walker_hits.instance, walker_hits.primitive, walker_hits.triangle);
    carve.all(misses.dx, misses.dy, misses.dz, misses.tr, misses.tg, misses.tb);
    carve.all(misses.pdf, misses.slot, misses.path_key);
    carve.all(shadows.ox, shadows.oy, shadows.oz, shadows.dx, shadows.dy, shadows.dz);
    carve.all(shadows.tfar, shadows.r, shadows.g, shadows.b, shadows.slot, shadows.path_key);
    carve.all(samples.r, samples.g, samples.b, samples.a);
    walker_row.resize(padded_rows);
    occluded.resize(padded_rows);
    camera_length_m.resize(padded_rows);
    slot_time.resize(padded_rows);
    ray_time.resize(padded_rows);
    cut_faces.resize(padded_rows);
    ray_end.resize(padded_rows);
    for (std::vector<float>& column : splats)
        column.resize(padded_rows);
}

}  // namespace obscura
