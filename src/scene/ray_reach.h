// scene/ray_reach.h - limits of ray coordinates within which Embree's single precision suffices.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <vector>

namespace obscura {

/// Embree's assertions refuse components beyond 1.844e18, also of rays in an instance's own space.
inline constexpr float largest_component = 1.8e18f;

/// Bounds on rays for which all components stay finite; each bounds a sum of three magnitudes.
struct RayReach {
    float origin = largest_component;
    float direction = largest_component;
};

/// The rays that an instance can take at any time, by a bound on the inverse of its matrix. Zero
/// where single precision loses that inverse, or where the matrix is singular between two times.
RayReach instance_reach(const Scene& scene, const Instance& instance);

/// The rays that all instances can take.
RayReach scene_reach(const Scene& scene);

/// Instances that cannot be rendered as the file asks for.
struct UnreachedInstances {
    std::vector<Instance> left_out;
    std::vector<Instance> halted;  ///< drawn without motion, as at the shutter's opening
};

/// Removes the instances that the rays of an image cannot enter. Such rays start within the scene's
/// bounds, at its cameras, or not much further away.
UnreachedInstances leave_out_unreached(Scene& scene);

}  // namespace obscura
