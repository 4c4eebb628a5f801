// stages/wavefront_light_paths.h - light layers between the stages: shadow rays, media, thin walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

// All do nothing where no light layers are asked for.

/// Before and after all bounces of a batch.
void begin_light_paths(const WavefrontInput& in, int count, Workspace& work);
void finish_light_paths(const WavefrontInput& in, Workspace& work);

/// Paths that met shadow catchers have left them by their gloss.
void release_catchers(const WavefrontInput& in, Workspace& work);

/// Notes the shadow rays of first hits, which are to be traced.
void begin_shadow_light(const WavefrontInput& in, int count, int bounce, Workspace& work);

/// Gives the shadow rays of a flight inside a medium the weights of their paths as they scatter;
/// comes before move_random_walks.
void begin_walk_shadow_light(const WavefrontInput& in,
                             int count,
                             const Flight& flight,
                             Workspace& work);

/// Adds what unoccluded shadow rays bring.
void add_shadow_light_paths(const WavefrontInput& in, int count, Workspace& work);

/// Adds what shadow rays bring that meet no thin wall any more, before stage 4 takes them.
void add_crossed_light_paths(const WavefrontInput& in, int count, Workspace& work);

/// Moves the shadow rays that have passed a thin wall.
void move_crossing_shadows(const WavefrontInput& in, int count, Workspace& work);

/// Moves the paths that have begun a random walk in a medium.
void move_random_walks(const WavefrontInput& in, int count, Workspace& work);

/// Gives the shadow rays of a bounce weights of their own where their paths go straight through a
/// thin wall; before they are traced.
///
/// In      work.paths[1]: as move_straight_paths
void split_straight_shadows(const WavefrontInput& in, int count, Workspace& work);

/// Moves the paths that have just gone straight through a thin wall, of those that go on.
///
/// In      work.paths[1]: `count` paths
void move_straight_paths(const WavefrontInput& in, int count, Workspace& work);

}  // namespace obscura
