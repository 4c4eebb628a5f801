// stages/wavefront_light_paths.cpp - light layers between the stages: shadow rays, media, walls.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_light_paths.h"

#include "surface/lobe_shares.h"

namespace obscura {

namespace {

Vec3f shadow_radiance(const Workspace& work, int i) {
    return {work.shadows.r[i], work.shadows.g[i], work.shadows.b[i]};
}

/// A catcher's gloss is a rough reflection.
constexpr size_t gloss_event() {
    size_t event = 0;
    while (scatter_events[event].lobe != "specular")
        ++event;
    return event;
}
static_assert(scatter_events[gloss_event()].mode == 'G');

/// Calls use(slot) for the paths that have just gone straight through a thin wall.
template <typename Use>
void for_straight_paths(const WavefrontInput& in, int count, Workspace& work, const Use& use) {
    if (in.light_paths == nullptr || !in.scene.thin_walls) return;
    for (int i = 0; i < count; ++i) {
        const uint32_t slot = work.paths[1].slot[i];
        if (work.distance_since_scattering[slot] > 0) use(slot);
    }
}

}  // namespace

void begin_light_paths(const WavefrontInput& in, int count, Workspace& work) {
    if (in.light_paths == nullptr) return;
    work.light_paths.begin(*in.light_paths, count, in.scene.thin_walls, in.catchers.any());
}

void finish_light_paths(const WavefrontInput& in, Workspace& work) {
    if (in.light_paths != nullptr) work.light_paths.finish(work.samples);
}

void release_catchers(const WavefrontInput& in, Workspace& work) {
    if (in.light_paths == nullptr) return;
    work.light_paths.release(gloss_event());
}

void begin_shadow_light(const WavefrontInput& in, int count, int bounce, Workspace& work) {
    if (in.light_paths == nullptr || !in.light_paths->shadow) return;
    work.light_paths.note_shadows(bounce == 0);
    if (bounce > 0) return;
    for (int i = 0; i < count; ++i)
        work.light_paths.add_unshadowed(work.shadows.slot[i], shadow_radiance(work, i));
}

void begin_walk_shadow_light(const WavefrontInput& in,
                             int count,
                             const Flight& flight,
                             Workspace& work) {
    if (in.light_paths == nullptr) return;
    work.light_paths.begin_flight();
    for (int i = 0; i < count; ++i) {
        // Of a bounce's flights the first moves the path.
        if (flight.number == 0) {
            work.light_paths.split_shadow_after(work.shadows.slot[i], volume_event);
        } else {
            work.light_paths.split_moved_shadow(work.shadows.slot[i]);
        }
    }
}

void add_shadow_light_paths(const WavefrontInput& in, int count, Workspace& work) {
    if (in.light_paths == nullptr) return;
    in.stages->add_shadow_layers(
        work.light_paths.columns(), count, work.shadows, work.occluded.data());
    if (!work.light_paths.notes_shadows()) return;
    for (int i = 0; i < count; ++i) {
        if (work.occluded[static_cast<size_t>(i)] != 0) continue;
        work.light_paths.note_shadow_light(work.shadows.slot[i], shadow_radiance(work, i));
    }
}

void add_crossed_light_paths(const WavefrontInput& in, int count, Workspace& work) {
    if (in.light_paths == nullptr) return;
    for (int i = 0; i < count; ++i) {
        if (work.random_walk_hits.primitive[i] >= 0) continue;
        work.light_paths.add_shadow_light(work.shadows.slot[i], shadow_radiance(work, i));
    }
}

void move_crossing_shadows(const WavefrontInput& in, int count, Workspace& work) {
    if (in.light_paths == nullptr) return;
    for (int i = 0; i < count; ++i)
        work.light_paths.move_shadow(work.shadows.slot[i], straight_event);
}

void move_random_walks(const WavefrontInput& in, int count, Workspace& work) {
    if (in.light_paths == nullptr) return;
    for (int i = 0; i < count; ++i)
        work.light_paths.move_path(work.paths[1].slot[i], volume_event);
}

void split_straight_shadows(const WavefrontInput& in, int count, Workspace& work) {
    for_straight_paths(
        in, count, work, [&](uint32_t slot) { work.light_paths.split_straight_shadow(slot); });
}

void move_straight_paths(const WavefrontInput& in, int count, Workspace& work) {
    for_straight_paths(
        in, count, work, [&](uint32_t slot) { work.light_paths.move_path(slot, straight_event); });
}

}  // namespace obscura
