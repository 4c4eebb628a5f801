// crosscheck/spawned.h - checks rays that shading starts: self-hits, and leaks at walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/ray_set.h"
#include "render/render.h"

#include <optional>

namespace obscura::crosscheck {

/// Figures of rays that the stage for ambient occlusion starts at the hits of other rays.
struct SpawnedReport {
    uint64_t rays = 0;        ///< at hits of rays aimed at nothing
    uint64_t self_hits = 0;   ///< hits on the very triangle or shape where they started
    uint64_t aimed_rays = 0;  ///< likewise, of rays aimed at edges, along surfaces, from afar
    uint64_t aimed_self_hits = 0;
    std::optional<TrueRay> first_self_hit;
    uint64_t wall_rays = 0;   ///< started below a wall a ten-thousandth of the scene's size away
    uint64_t wall_leaks = 0;  ///< of these, not occluded by it
    std::optional<TrueRay> first_wall_leak;
};

/// Spawns as many rays as `rays` has, if enough of those hit, and as many again below walls.
///
/// In      scene: without cut-outs; truth: of the same scene; isa: for the walls
/// Errors  those of PreparedScene::create
Result<SpawnedReport> check_spawned(const PreparedScene& scene,
                                    const TrueScene& truth,
                                    const RaySet& rays,
                                    Isa isa);

}  // namespace obscura::crosscheck
