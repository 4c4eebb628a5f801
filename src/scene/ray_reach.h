// scene/ray_reach.h - which rays stay within single precision in the space of every instance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <vector>

namespace obscura {

/// Embree's assertions refuse components beyond 1.844e18, also of rays in an instance's own space.
inline constexpr float largest_component = 1.8e18f;

/// What rays may be for all their components to stay finite. Sizes are sums of three magnitudes.
struct RayReach {
    float origin = largest_component;
    float direction = largest_component;
};

/// The rays that an instance can take at every moment, by a bound on the inverse of its matrix; of
/// no size where that inverse is lost in single precision, or where the matrix becomes singular
/// between two times.
RayReach instance_reach(const Scene& scene, const Instance& instance);

/// The rays that all instances can take.
RayReach scene_reach(const Scene& scene);

/// Rows of Scene::meshes whose instances could not do what the file asks for, once for each.
struct UnreachedInstances {
    std::vector<Instance> left_out;
    std::vector<Instance> halted;  ///< drawn, but as at the shutter's opening all the time
};

/// Removes the instances that rays of a picture cannot enter: such as begin within the scene's
/// bounds, at its cameras, or not much further away.
UnreachedInstances leave_out_unreached(Scene& scene);

}  // namespace obscura
