// gltf/geometry/geometry_store.h - static batches of geometry, kept from pose to pose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_primitive.h"
#include "gltf/geometry/particles.h"
#include "gltf/materials/materials.h"
#include "scene/motion.h"
#include "scene/scene.h"

#include <vector>

namespace obscura::gltf {

/// Facts noted about a primitive while it was read.
struct PrimitiveNote {
    PrimitiveName name;
    int node = -1;        ///< as Primitive::node
    MaterialNeeds needs;  ///< at that time
    size_t corners = 3;
    PointsLinesShading shading;  ///< of points and lines
    uint32_t uv_sets = 0;        ///< bit n: it has TEXCOORD_n
    uint32_t issues = 0;         ///< issue_bit
    bool drawn = false;
};

/// Primitives that share one space and are consecutive in the scene's arrays.
struct GeometryBatch {
    std::vector<PrimitiveNote> notes;
    std::vector<Primitive> primitives;  ///< of those that are drawn, in that order
    StaticSizes end;                    ///< of the scene's arrays, with this batch
    Bounds box;                         ///< in the batch's space
    size_t triangles = 0;
    bool faulty = false;  ///< something is left out, or would be refused
    GeometryStamp stamp = 0;
};

/// Batches at the start of a scene's arrays.
struct GeometryStore {
    LargeArray<float> positions;  ///< of the latest scene; empty: it has not been given back
    LargeArray<uint32_t> indices;
    LargeArray<float> attributes;
    std::vector<GeometryBatch> batches;
    std::vector<Affined> group_from_node;  ///< of all nodes; constant over time
    SphereOrders sphere_orders;

    StaticSizes static_sizes() const {
        return batches.empty() ? StaticSizes{} : batches.back().end;
    }
    void take_back(Scene& scene) {
        positions = std::move(scene.positions);
        indices = std::move(scene.indices);
        attributes = std::move(scene.attributes);
    }
};

}  // namespace obscura::gltf
