// gltf/geometry/geometry_store.h - what a pose leaves to the next one: meshes that no time changes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_part.h"
#include "gltf/geometry/particles.h"
#include "gltf/materials/materials.h"
#include "scene/motion.h"
#include "scene/scene.h"

#include <vector>

namespace obscura {

/// What was found out about a primitive while it was read.
struct PartNote {
    PartName name;
    int node = -1;        ///< as Primitive::node
    MaterialNeeds needs;  ///< at that time
    size_t corners = 3;
    StrokeLook look;       ///< of points and lines
    uint32_t uv_sets = 0;  ///< bit n: it has TEXCOORD_n
    uint32_t issues = 0;   ///< issue_bit
    bool drawn = false;
};

/// Primitives that share one space and lie behind each other in the scene's arrays.
struct GeometryBlock {
    std::vector<PartNote> notes;
    std::vector<Primitive> primitives;  ///< of those that are drawn, in that order
    StillSizes end;                     ///< of the scene's arrays, with this block
    Bounds box;                         ///< in the block's space
    size_t triangles = 0;
    bool faulty = false;  ///< something is left out, or would be refused
    GeometryStamp stamp = 0;
};

/// Blocks at the start of a scene's arrays.
struct GeometryStore {
    LargeArray<float> positions;  ///< of the latest scene; empty: it has not been given back
    LargeArray<uint32_t> indices;
    LargeArray<float> attributes;
    std::vector<GeometryBlock> blocks;
    std::vector<Affined> mover_from_node;  ///< of all nodes, which no time changes
    SphereOrders sphere_orders;

    StillSizes still() const { return blocks.empty() ? StillSizes{} : blocks.back().end; }
    void take_back(Scene& scene) {
        positions = std::move(scene.positions);
        indices = std::move(scene.indices);
        attributes = std::move(scene.attributes);
    }
};

}  // namespace obscura
