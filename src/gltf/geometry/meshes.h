// gltf/geometry/meshes.h - the scene's meshes become arrays, baked or instanced.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/buffers.h"
#include "gltf/geometry/geometry_store.h"
#include "gltf/geometry/mesh_primitive.h"
#include "gltf/materials/materials.h"
#include "gltf/parse/node_graph.h"
#include "scene/scene.h"

#include <vector>

namespace obscura::gltf {

/// What add_meshes reads.
struct MeshSources {
    const Document& document;
    const BufferStore& buffers;
    const std::vector<PlacedNode>& placed;
    GeometryStore* store = nullptr;  ///< of an animated asset: geometry that its poses share
    /// World transforms of all nodes when a shutter opens; null: there is no shutter. Points and
    /// lines on animated nodes then become instances that move from where they were.
    const std::vector<Affined>* anchors = nullptr;
};

/// Fills the scene's geometry: positions, indices, attributes, primitives, meshes, instances and
/// bounds; counts what is skipped in Scene::info. A mesh that one node places lies in world space,
/// one that several place becomes a Mesh with Instances. In an animated asset each dynamic group
/// becomes one Mesh in its node's space, and static geometry comes first.
///
/// Out     problems: for each primitive what read_mesh_primitive finds, E-MESH-TEXCOORD (its
///         material reads texture coordinates that it lacks), E-NODE-RANGE a node moves
///         vertices beyond 1e18; E-SKIN-MATRICES. What cannot be drawn is left out
/// Errors  77 E-LIMIT-VERTICES, E-LIMIT-TRIANGLES, E-LIMIT-ATTRIBUTES
Result<void> add_meshes(const MeshSources& sources,
                        MaterialTable& materials,
                        Problems& problems,
                        Scene& scene,
                        Log& log);

}  // namespace obscura::gltf
