// gltf/geometry/splats.cpp - the scene's Gaussian splats become one field.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/splats.h"

#include "base/parallel.h"
#include "gltf/geometry/farthest_position.h"
#include "gltf/geometry/particles.h"
#include "gltf/geometry/primitive_modes.h"
#include "gltf/geometry/splat_primitive.h"
#include "gltf/parse/list_text.h"
#include "gltf/parse/trs.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace obscura::gltf {

namespace {

constexpr size_t max_splats = size_t{1} << 29;
/// Least ratio of axes: it looks like a disc, and single precision still resolves it.
constexpr double min_flatness = 1e-5;

using PlacedNodes = std::vector<const PlacedNode*>;

/// The nodes that show each primitive of splats, in the order of the scene.
std::map<std::pair<int, int>, PlacedNodes> find_placed_nodes(const MeshSources& sources) {
    std::map<std::pair<int, int>, PlacedNodes> out;
    for (const PlacedNode& placed_node : sources.placed) {
        const int mesh = sources.document.nodes[static_cast<size_t>(placed_node.node)].mesh;
        if (mesh < 0 || !placed_node.visible) continue;
        const auto& primitives = sources.document.meshes[static_cast<size_t>(mesh)].primitives;
        for (size_t i = 0; i < primitives.size(); ++i) {
            if (!primitives[i].is_splats || primitives[i].mode == hidden_mode) continue;
            out[{mesh, static_cast<int>(i)}].push_back(&placed_node);
        }
    }
    return out;
}

Affined mesh_from_ball(const SplatPrimitive& primitive, uint32_t splat) {
    const auto three = [&](const std::vector<float>& values) {
        const float* at = &values[3 * size_t{splat}];
        return std::array<double, 3>{at[0], at[1], at[2]};
    };
    const float* at = &primitive.rotations[4 * size_t{splat}];
    std::array<double, 4> rotation = {at[0], at[1], at[2], at[3]};
    normalize_quaternion(rotation);
    std::array<double, 3> scale = three(primitive.scales);
    const double least = min_flatness * std::max({scale[0], scale[1], scale[2]});
    for (double& s : scale)
        s = std::max(s, least);
    return affine_from_trs(three(primitive.positions), rotation, scale);
}

/// Adds primitives of splats one after the other.
class SplatBuilder {
public:
    SplatBuilder(const MeshSources& sources, Problems& problems, Scene& scene, Log& log)
        : sources_(sources), problems_(problems), scene_(scene), log_(log) {}

    Result<void> add(PrimitiveName name, const PlacedNodes& placed_nodes);
    void warn();

private:
    std::string where(PrimitiveName name) const {
        return sources_.document.at("meshes", static_cast<size_t>(name.mesh)) + "/primitives/" +
               std::to_string(name.primitive);
    }
    void add_colors(const SplatPrimitive& primitive,
                    const std::vector<uint32_t>& order,
                    bool linear);
    bool add_placed_node(const SplatPrimitive& primitive,
                         const std::vector<uint32_t>& order,
                         const PlacedNode& placed_node);
    bool grow_bounds(const SplatPrimitive& primitive, const Affined& world);

    const MeshSources& sources_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    SplatGroup group_;  ///< shared by all placements of a primitive
    NameList shrunk_, logarithms_;
};

/// The colours of a primitive, in the order of its splats in their blocks.
void SplatBuilder::add_colors(const SplatPrimitive& primitive,
                              const std::vector<uint32_t>& order,
                              bool linear) {
    SplatField& field = scene_.splats;
    group_ = {};
    group_.degree = primitive.degree;
    group_.linear = linear;
    group_.first_color = field.colors.size();
    group_.first_harmonic = field.harmonics.size();
    constexpr float harmonic_0 = 0.2820947917738781f;
    constexpr float middle = 0.5f;
    for (const uint32_t splat : order) {
        for (size_t c = 0; c < 3; ++c)
            field.colors.push_back(primitive.harmonics[0][3 * size_t{splat} + c] * harmonic_0 +
                                   middle);
    }
    const auto count = static_cast<size_t>(directional_harmonics(primitive.degree));
    float largest = 0;
    for (size_t i = 1; i <= count; ++i) {
        for (const uint32_t splat : order) {
            const float* at = &primitive.harmonics[i][3 * size_t{splat}];
            largest = std::max({largest, std::abs(at[0]), std::abs(at[1]), std::abs(at[2])});
        }
    }
    if (largest == 0) {
        group_.degree = 0;
        return;
    }
    constexpr float most = 32767;
    group_.harmonic_step = largest / most;
    field.harmonics.resize(group_.first_harmonic + 3 * count * order.size());
    parallel_for(order.size(), [&](size_t index) {
        int16_t* to = &field.harmonics[group_.first_harmonic + 3 * count * index];
        for (size_t i = 1; i <= count; ++i) {
            const float* at = &primitive.harmonics[i][3 * size_t{order[index]}];
            for (size_t c = 0; c < 3; ++c)
                *to++ = static_cast<int16_t>(std::lround(at[c] / largest * most));
        }
    });
}

/// Extends the scene's bounds by the splats up to one standard deviation; false: out of range.
bool SplatBuilder::grow_bounds(const SplatPrimitive& primitive, const Affined& world) {
    Bounds all = scene_.bounds;
    for (const uint32_t splat : primitive.good) {
        const Affined map = compose(world, mesh_from_ball(primitive, splat));
        float low[3];
        float high[3];
        for (int r = 0; r < 3; ++r) {
            const double* row = map.m[r];
            const double half = std::hypot(row[0], row[1], row[2]);
            if (!(std::abs(row[3]) + half <= farthest_position)) return false;
            low[r] = static_cast<float>(row[3] - half);
            high[r] = static_cast<float>(row[3] + half);
        }
        all.low = -max3(-all.low, Vec3f{-low[0], -low[1], -low[2]});
        all.high = max3(all.high, Vec3f{high[0], high[1], high[2]});
    }
    scene_.bounds = all;
    return true;
}

/// False: the node moves splats too far.
bool SplatBuilder::add_placed_node(const SplatPrimitive& primitive,
                                   const std::vector<uint32_t>& order,
                                   const PlacedNode& placed_node) {
    const Affined& world = placed_node.world_from_node;
    if (!grow_bounds(primitive, world)) return false;
    SplatField& field = scene_.splats;
    SplatGroup group = group_;
    group.node = placed_node.node;
    group.count = static_cast<int32_t>(order.size());
    group.first = static_cast<int32_t>(field.boxes.size() * splat_block);
    group.object_from_world = affine_cast<float>(inverse(world));
    const size_t first_block = field.boxes.size();
    const size_t blocks = (order.size() + splat_block - 1) / splat_block;
    field.blocks.resize((first_block + blocks) * splat_block_floats);
    field.boxes.resize(first_block + blocks, {splat3(INFINITY), splat3(-INFINITY)});
    field.group_of_block.resize(first_block + blocks, static_cast<int32_t>(field.groups.size()));
    field.groups.push_back(group);
    parallel_for(blocks, [&](size_t block) {
        const size_t end = std::min(order.size(), (block + 1) * splat_block);
        for (size_t i = block * splat_block; i < end; ++i) {
            store_splat(compose(world, mesh_from_ball(primitive, order[i])),
                        primitive.opacities[order[i]],
                        first_block * splat_block + i,
                        field);
        }
    });
    scene_.info.splats_in_world += order.size();
    return true;
}

Result<void> SplatBuilder::add(PrimitiveName name, const PlacedNodes& placed_nodes) {
    const Document& document = sources_.document;
    const Result<SplatPrimitive> primitive = read_splat_primitive(document, sources_.buffers, name);
    if (!primitive) {
        problems_.add(primitive.error(), {Loss::primitive, "the primitive is not drawn"});
        return {};
    }
    if (primitive->fault) {
        const size_t dropped = primitive->fault->dropped;
        problems_.add(primitive->fault->error,
                      {Loss::triangle, std::to_string(dropped) + " splats are left out", dropped});
    }
    const size_t count = primitive->good.size();
    if (count * placed_nodes.size() > max_splats - scene_.splats.boxes.size() * splat_block) {
        return fail(
            ExitCode::refused, "E-LIMIT-SPLATS", where(name), "at most 2^29 splats are accepted");
    }
    if (count == 0) return {};
    if (primitive->scales_were_logarithms) {
        logarithms_.add(document.meshes[static_cast<size_t>(name.mesh)].name);
    }
    std::vector<float> positions;
    positions.reserve(3 * count);
    for (const uint32_t splat : primitive->good) {
        const float* at = &primitive->positions[3 * size_t{splat}];
        positions.insert(positions.end(), at, at + 3);
    }
    SphereOrders own;
    GeometryStore* store = sources_.store;
    std::vector<uint32_t> order =
        (store != nullptr ? store->sphere_orders : own).order_of(positions);
    for (uint32_t& splat : order)
        splat = primitive->good[splat];
    const GltfPrimitive& source = document.meshes[static_cast<size_t>(name.mesh)]
                                      .primitives[static_cast<size_t>(name.primitive)];
    add_colors(*primitive, order, source.splats_are_linear);
    for (const PlacedNode* placed_node : placed_nodes) {
        if (is_singular(placed_node->world_from_node)) {
            shrunk_.add(node_label(document, placed_node->node));
        } else if (!add_placed_node(*primitive, order, *placed_node)) {
            problems_.add({ExitCode::bad_data,
                           "E-NODE-RANGE",
                           document.at("nodes", static_cast<size_t>(placed_node->node)),
                           "the node moves Gaussian splats of its mesh beyond 1e18"},
                          {Loss::primitive, "they are not drawn there"});
        }
    }
    return {};
}

void SplatBuilder::warn() {
    if (!shrunk_.empty()) {
        log_.warn(sources_.document.file,
                  "nodes whose scale is zero along some axis, or whose matrix is singular, do not "
                  "draw their Gaussian splats: " +
                      shrunk_.text());
    }
    if (!logarithms_.empty()) {
        log_.warn(sources_.document.file,
                  "scales of Gaussian splats are negative and taken as logarithms, as drafts of "
                  "KHR_gaussian_splatting asked; meshes: " +
                      logarithms_.text());
    }
}

}  // namespace

Result<void> add_splats(const MeshSources& sources, Problems& problems, Scene& scene, Log& log) {
    SplatBuilder builder(sources, problems, scene, log);
    for (const auto& [primitive, placed_nodes] : find_placed_nodes(sources)) {
        const Result<void> done = builder.add({primitive.first, primitive.second}, placed_nodes);
        if (!done) return done;
    }
    builder.warn();
    return {};
}

}  // namespace obscura::gltf
