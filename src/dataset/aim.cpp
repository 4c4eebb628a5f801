// dataset/aim.cpp - chooses views from inside a scene that show something.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/aim.h"

#include "session/framing.h"

#include "dataset/ray_labels.h"
#include <algorithm>
#include <set>

namespace obscura::dataset {

namespace {

constexpr int max_attempts = 64;
constexpr double enough = 1;

/// From 0, there is nothing to see, to 1, good enough.
double score(const PreparedScene& prepared, const Camera& camera, const RenderOptions& options) {
    constexpr int rays_across = 24;
    constexpr double wanted_share = 0.95;     // of the rays that meet something
    constexpr double wanted_distance = 0.03;  // of the nearest surface, in half diagonals
    constexpr double wanted_depth = 3;        // of the farthest surface, in nearest distances
    constexpr double wanted_objects = 6;
    RenderOptions few = options;
    few.width = rays_across;
    few.height = std::max(1, rays_across * options.height / options.width);
    const RayLabels rays = trace_labels(prepared, camera, few, Depth::nearest);
    const double radius = bounding_sphere(prepared.scene().bounds).radius_m;
    std::set<int32_t> nodes;
    size_t hits = 0;
    double nearest_m = radius;
    double farthest_m = 0;
    for (size_t i = 0; i < rays.node.size(); ++i) {
        if (rays.node[i] < 0) continue;
        ++hits;
        nodes.insert(rays.node[i]);
        nearest_m = std::min(nearest_m, static_cast<double>(rays.depth_m[i]));
        farthest_m = std::max(farthest_m, static_cast<double>(rays.depth_m[i]));
    }
    const double share = static_cast<double>(hits) / static_cast<double>(rays.node.size());
    const double objects = std::min(1.0, static_cast<double>(nodes.size()) / wanted_objects);
    const double room =
        std::min({1.0, share / wanted_share, nearest_m / (wanted_distance * radius)});
    // A wall straight ahead is all at one distance.
    const double depth = std::min(1.0, farthest_m / (wanted_depth * nearest_m));
    return room * depth * (0.5 + 0.5 * objects);  // there may be one object only
}

}  // namespace

Result<ChosenCamera> aim(AssetRenderer& renderer,
                         RenderRequest& request,
                         const ChosenCamera& camera,
                         Log& log) {
    if (!request.camera.inside) return camera;
    ChosenCamera best = camera;
    int best_attempt = 0;
    double best_score = score(renderer.prepared(), camera.camera, request.options);
    for (int attempt = 1; attempt < max_attempts && best_score < enough; ++attempt) {
        request.camera.inside->attempt = attempt;
        Result<ChosenCamera> other = renderer.look_again(request, log);
        if (!other) return other;
        const double reached = score(renderer.prepared(), other->camera, request.options);
        if (reached <= best_score) continue;
        best = std::move(*other);
        best_score = reached;
        best_attempt = attempt;
    }
    request.camera.inside->attempt = best_attempt;
    return best;
}

}  // namespace obscura::dataset
