// stages/wavefront_slots.h - what rays of the wavefront loop take along by their sample index.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// Copies entry `from` of columns to entry `to` of others.
template <typename Columns>
void copy_entry(const Columns& columns, int from, const Columns& out, int to) {
    const auto column = [&](const auto* source, auto* target) { target[to] = source[from]; };
    Columns::for_each_column(column, columns, out);
}

/// The time of every sample, if something moves.
inline const float* slot_times(const WavefrontInput& in, const Workspace& work) {
    return moves(in.scene.motion) ? work.slot_time.data() : nullptr;
}

/// Where paths scattered last, if there is a light tree.
inline LitPointRecord* lit_points(const WavefrontInput& in, Workspace& work) {
    return in.scene.lights.tree.nodes != nullptr ? work.lit_points.data() : nullptr;
}

/// The times of rays, if something moves.
inline const float* times_of(const WavefrontInput& in,
                             const uint32_t* slot,
                             int count,
                             Workspace& work) {
    if (!moves(in.scene.motion)) return nullptr;
    for (int i = 0; i < count; ++i)
        work.ray_time[static_cast<size_t>(i)] = work.slot_time[slot[i]];
    return work.ray_time.data();
}

/// Adds one to the rays of each of these samples.
inline void count_rays(const WavefrontInput& in, const uint32_t* slot, int count, Workspace& work) {
    if (!in.counts_rays) return;
    for (int i = 0; i < count; ++i)
        ++work.rays_cast[slot[i]];
}

/// The back faces that are cut away for all rays of a path but the first; null: none for any path.
inline const Cutaway* cut_away(const uint32_t* slot, Workspace& work) {
    if (work.passed_backs.empty()) return nullptr;
    work.cutaway = {work.cut_faces.data(), slot};
    return &work.cutaway;
}

}  // namespace obscura
