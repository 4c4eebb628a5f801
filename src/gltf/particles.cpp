// gltf/particles.cpp - accessors of positions and radii become blocks of spheres.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/particles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {

namespace {

constexpr double farthest_position = 1e18;
constexpr size_t most_spheres = size_t{1} << 29;  // their words have 31-bit numbers

/// Puts two zeros before each of 21 bits.
uint64_t spread_bits(uint64_t x) {
    x &= 0x1FFFFFU;
    x = (x | x << 32) & 0x001F00000000FFFFU;
    x = (x | x << 16) & 0x001F0000FF0000FFU;
    x = (x | x << 8) & 0x100F00F00F00F00FU;
    x = (x | x << 4) & 0x10C30C30C30C30C3U;
    return (x | x << 2) & 0x1249249249249249U;
}

/// Order of the spheres along Morton's curve through their bounding cube.
std::vector<uint32_t> curve_order(const std::vector<float>& positions) {
    const size_t count = positions.size() / 3;
    float low[3] = {INFINITY, INFINITY, INFINITY};
    float high = 0;
    for (size_t i = 0; i < positions.size(); ++i)
        low[i % 3] = std::min(low[i % 3], positions[i]);
    for (size_t i = 0; i < positions.size(); ++i)
        high = std::max(high, positions[i] - low[i % 3]);
    const double scale = high > 0 ? 2097151.0 / static_cast<double>(high) : 0;
    std::vector<std::pair<uint64_t, uint32_t>> keys(count);
    for (size_t i = 0; i < count; ++i) {
        uint64_t key = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double offset = static_cast<double>(positions[3 * i + c] - low[c]);
            key |= spread_bits(static_cast<uint64_t>(offset * scale)) << c;
        }
        keys[i] = {key, static_cast<uint32_t>(i)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<uint32_t> order(count);
    for (size_t i = 0; i < count; ++i)
        order[i] = keys[i].second;
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

ParticleRange append_spheres(const std::vector<float>& positions,
                             const std::vector<float>& radii,
                             Scene& scene) {
    const size_t count = positions.size() / 3;
    const ParticleRange range{static_cast<int32_t>(scene.spheres.size() / 4),
                              static_cast<int32_t>(count)};
    const size_t blocks = (count + sphere_block - 1) / sphere_block;
    const size_t base = scene.spheres.size();
    scene.spheres.resize(base + blocks * sphere_block_floats,
                         std::numeric_limits<float>::quiet_NaN());
    const std::vector<uint32_t> order = curve_order(positions);
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
    if (count > most_spheres - scene.spheres.size() / 4) {
        return fail(
            ExitCode::refused, "E-LIMIT-SPHERES", where, "at most 2^29 spheres are accepted");
    }
    Result<std::vector<float>> positions =
        read_floats(document, sources.buffers, shape.positions, {});
    if (!positions) return fail(std::move(positions.error()));
    Result<std::vector<float>> radii = std::vector<float>(1, shape.row.size[0]);
    if (shape.radii >= 0) radii = read_floats(document, sources.buffers, shape.radii, {});
    if (!radii) return fail(std::move(radii.error()));
    const std::string problem = find_problem(*positions, *radii);
    if (!problem.empty()) return fail(ExitCode::bad_data, "E-SHAPE-SPHERES", where, problem);

    return append_spheres(*positions, *radii, scene);
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

}  // namespace obscura
