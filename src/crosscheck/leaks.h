// crosscheck/leaks.h - shoots rays from inside closed meshes and shapes and counts leaks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "crosscheck/closed_components.h"
#include "crosscheck/truth.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace obscura::crosscheck {

enum class LeakAim : int { anywhere, edges, vertices };
inline constexpr size_t leak_aims = 3;
inline constexpr std::array<const char*, leak_aims> leak_aim_names{"anywhere", "edges", "vertices"};

struct LeakCount {
    uint64_t rays = 0;
    uint64_t leaks = 0;
};

/// Leaks of one kernel.
struct LeakFigures {
    std::string kernel;
    bool in_budget = true;  ///< false: fast traversal, only published
    std::array<LeakCount, leak_aims> by_aim;
    std::optional<TrueRay> first;  ///< a ray that leaked, unaimed ones before those at edges
};

struct LeakReport {
    size_t components_found = 0;
    size_t components_used = 0;  ///< large enough for points inside
    std::vector<LeakFigures> kernels;
};

/// Shoots from points inside of each component, alone in its scene: whatever hits nothing has
/// leaked. Inside is where a ray in double precision crosses the component an odd number of times.
///
/// In      rays: for all components together, to anywhere; a tenth as many each are aimed at
///         edges and vertices
/// Errors  those of Accel::build
Result<LeakReport> count_leaks(const ClosedComponents& closed, uint64_t rays, uint64_t seed);

/// Up to `most` points inside of a closed component.
std::vector<Vec3d> points_inside(const TrueScene& component, size_t most, uint64_t seed);

}  // namespace obscura::crosscheck
