// crosscheck/leaks.h - rays from inside of closed parts that find no wall.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "crosscheck/closed_parts.h"
#include "crosscheck/truth.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

enum class LeakAim : int { anywhere, edges, vertices };
inline constexpr size_t leak_aims = 3;
inline constexpr std::array<const char*, leak_aims> leak_aim_names{"anywhere", "edges", "vertices"};

struct LeakCount {
    uint64_t rays = 0;
    uint64_t leaks = 0;
};

/// What one kernel let through.
struct LeakFigures {
    std::string kernel;
    bool in_budget = true;  ///< false: fast traversal, only published
    std::array<LeakCount, leak_aims> by_aim;
    std::optional<TrueRay> first;  ///< a ray that leaked, at random or at an edge before others
};

struct LeakReport {
    size_t parts_found = 0;
    size_t parts_used = 0;  ///< large enough for points inside
    std::vector<LeakFigures> kernels;
};

/// Shoots from points inside of each part, alone in its scene: whatever hits nothing has leaked.
/// Inside is where a ray in double precision crosses the part an odd number of times.
///
/// In      rays: for all parts together, to anywhere; a tenth as many each are aimed at edges and
///         vertices
/// Errors  those of Accel::build
Result<LeakReport> count_leaks(const ClosedParts& parts, uint64_t rays, uint64_t seed);

/// Up to `most` points inside of a closed part.
std::vector<Vec3d> points_inside(const TrueScene& part, size_t most, uint64_t seed);

}  // namespace obscura
