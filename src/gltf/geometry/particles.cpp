// gltf/geometry/particles.cpp - accessors of positions and radii become blocks of spheres.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/particles.h"

#include "base/parallel.h"
#include "gltf/geometry/farthest_position.h"
#include "shape/sphere_cluster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace obscura::gltf {

namespace {

/// Splits spheres along the longest edge of their box into two parts of whole clusters, or of whole
/// blocks where there is one cluster at most. Returns how many the first one gets.
size_t split_in_two(const std::vector<float>& positions, std::span<uint32_t> order) {
    float low[3] = {INFINITY, INFINITY, INFINITY};
    float high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (const uint32_t sphere : order) {
        for (size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], positions[3 * size_t{sphere} + c]);
            high[c] = std::max(high[c], positions[3 * size_t{sphere} + c]);
        }
    }
    size_t axis = 0;
    for (size_t c = 1; c < 3; ++c) {
        if (high[c] - low[c] > high[axis] - low[axis]) axis = c;
    }
    const size_t part = order.size() > cluster_spheres ? cluster_spheres : sphere_block;
    const size_t parts = (order.size() + part - 1) / part;
    const size_t half = parts / 2 * part;
    const auto place = [&](uint32_t sphere) { return positions[3 * size_t{sphere} + axis]; };
    std::nth_element(
        order.begin(),
        order.begin() + static_cast<std::ptrdiff_t>(half),
        order.end(),
        [&](uint32_t a, uint32_t b) { return place(a) != place(b) ? place(a) < place(b) : a < b; });
    return half;
}

/// Splits until each half fills one block: their boxes are smaller than along any space-filling
/// curve. Ranges of one size are split in parallel.
std::vector<uint32_t> block_order(const std::vector<float>& positions) {
    std::vector<uint32_t> order(positions.size() / 3);
    std::iota(order.begin(), order.end(), 0U);
    std::vector<std::span<uint32_t>> parts = {order};
    while (!parts.empty()) {
        std::erase_if(parts, [](const auto& part) { return part.size() <= sphere_block; });
        std::vector<std::span<uint32_t>> halves(2 * parts.size());
        parallel_for(parts.size(), [&](size_t i) {
            const size_t half = split_in_two(positions, parts[i]);
            halves[2 * i] = parts[i].first(half);
            halves[2 * i + 1] = parts[i].subspan(half);
        });
        parts = std::move(halves);
    }
    return order;
}

std::string find_problem(const std::vector<float>& positions, const std::vector<float>& radii) {
    for (size_t i = 0; i < positions.size(); ++i) {
        if (std::abs(static_cast<double>(positions[i])) <= farthest_position) continue;
        return "sphere " + std::to_string(i / 3) + " is not within 1e18 of the origin";
    }
    for (size_t i = 0; i < radii.size(); ++i) {
        if (radii[i] > 0 && static_cast<double>(radii[i]) <= farthest_position) continue;
        return "sphere " + std::to_string(i) + " has the radius " + std::to_string(radii[i]) +
               "; above 0 is wanted";
    }
    return {};
}

}  // namespace

void SphereOrders::begin_pose() {
    known_ = std::move(asked_);
    asked_.clear();
}

const std::vector<uint32_t>& SphereOrders::order_of(const std::vector<float>& positions) {
    const auto is_it = [&](const Entry& entry) { return entry.positions == positions; };
    const auto known = std::find_if(known_.begin(), known_.end(), is_it);
    if (known == known_.end()) {
        asked_.push_back({positions, block_order(positions)});
    } else {
        asked_.push_back(std::move(*known));
        known_.erase(known);
    }
    return asked_.back().order;
}

ParticleRange append_spheres(const std::vector<float>& positions,
                             const std::vector<float>& radii,
                             Scene& scene,
                             SphereOrders* orders) {
    const size_t count = positions.size() / 3;
    ParticleRange range{static_cast<int32_t>(scene.spheres.size() / 4),
                        static_cast<int32_t>(count),
                        orders != nullptr ? orders->order_of(positions) : block_order(positions)};
    const size_t blocks = (count + sphere_block - 1) / sphere_block;
    const size_t base = scene.spheres.size();
    scene.spheres.resize(base + blocks * sphere_block_floats,
                         std::numeric_limits<float>::quiet_NaN());
    const std::vector<uint32_t>& order = range.order;
    for (size_t i = 0; i < count; ++i) {
        float* at = &scene.spheres[base + sphere_word(i)];
        for (size_t c = 0; c < 3; ++c)
            at[c * sphere_block] = positions[3 * order[i] + c];
        at[3 * sphere_block] = radii[radii.size() > 1 ? order[i] : 0];
    }
    return range;
}

Result<ParticleRange> append_particles(const ParticleSources& sources,
                                       const GltfShape& shape,
                                       int shape_index,
                                       Scene& scene) {
    const Document& document = sources.document;
    const std::string where =
        document.at("/extensions/OBSCURA_shape/shapes/" + std::to_string(shape_index));
    const auto& accessors = document.accessors;
    const size_t count = accessors[static_cast<size_t>(shape.positions)].count;
    if (shape.radii >= 0 && accessors[static_cast<size_t>(shape.radii)].count != count) {
        return fail(ExitCode::bad_data,
                    "E-SHAPE-SPHERES",
                    where,
                    "positions and radii must have the same count");
    }
    if (count == 0) {
        return fail(ExitCode::bad_data,
                    "E-SHAPE-SPHERES",
                    where,
                    "there are no spheres; 1 or more are expected");
    }
    if (count > max_spheres - scene.spheres.size() / 4) {
        return fail(
            ExitCode::refused, "E-LIMIT-SPHERES", where, "at most 2^29 spheres are accepted");
    }
    Result<std::vector<float>> positions =
        read_floats(document, sources.buffers, shape.positions, {});
    if (!positions) return fail(std::move(positions.error()));
    Result<std::vector<float>> radii = std::vector<float>(1, shape.record.size[0]);
    if (shape.radii >= 0) radii = read_floats(document, sources.buffers, shape.radii, {});
    if (!radii) return fail(std::move(radii.error()));
    const std::string problem = find_problem(*positions, *radii);
    if (!problem.empty()) return fail(ExitCode::bad_data, "E-SHAPE-SPHERES", where, problem);

    return append_spheres(*positions, *radii, scene, sources.orders);
}

ShapeBox primitive_box(const Scene& scene, const Primitive& primitive) {
    const auto first = static_cast<size_t>(primitive.first_triangle);
    if (primitive.geometry == static_cast<int32_t>(GeometryKind::shapes)) {
        return shape_bounds(scene.shapes[first]);
    }
    ShapeBox all{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    const size_t end = first + static_cast<size_t>(primitive.triangle_count);
    for (size_t i = first; i < end; i += sphere_block) {
        const ShapeBox box = sphere_block_bounds(&scene.spheres[i * 4]);
        all.low = {std::min(all.low.x, box.low.x),
                   std::min(all.low.y, box.low.y),
                   std::min(all.low.z, box.low.z)};
        all.high = max3(all.high, box.high);
    }
    return all;
}

}  // namespace obscura::gltf
