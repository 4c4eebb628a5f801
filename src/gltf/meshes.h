// gltf/meshes.h - the meshes of the chosen scene become arrays, baked to the world or instanced.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/buffers.h"
#include "gltf/geometry_store.h"
#include "gltf/materials.h"
#include "gltf/mesh_part.h"
#include "gltf/node_graph.h"
#include "scene/scene.h"

#include <vector>

namespace obscura {

/// What add_meshes reads.
struct MeshSources {
    const Document& document;
    const BufferStore& buffers;
    const std::vector<PlacedNode>& placed;
    GeometryStore* store = nullptr;  ///< of an animated asset: what its poses have in common
    /// World transforms of all nodes when a shutter opens; null: there is no shutter. Points and
    /// lines on animated nodes then become instances that move from where they were.
    const std::vector<Affined>* anchors = nullptr;
};

/// Fills the scene's geometry: positions, indices, attributes, primitives, meshes, instances and
/// bounds; counts what is skipped in Scene::info. A mesh that one node places lies in world space,
/// one that several place becomes a Mesh with Instances. In an animated asset all that an animated
/// node moves becomes one Mesh in that node's space, and what stands still comes first.
///
/// Out     problems: for each primitive what read_mesh_part finds, E-MESH-TEXCOORD (its material
///         reads texture coordinates that it lacks), E-NODE-RANGE a node moves vertices beyond
///         1e18; E-SKIN-MATRICES. What cannot be drawn is left out
/// Errors  77 E-LIMIT-VERTICES, E-LIMIT-TRIANGLES, E-LIMIT-ATTRIBUTES
Result<void> add_meshes(const MeshSources& sources,
                        MaterialTable& materials,
                        Problems& problems,
                        Scene& scene,
                        Log& log);

/// Moves a part to another space: positions by the matrix, normals by its inverse transpose,
/// tangents along; a mirror turns triangles round. False: a position is no longer in range.
bool bake_part(MeshPart& part, const Affined& world_from_mesh);

/// Sizes of a scene's arrays, in elements.
struct ArraySizes {
    size_t vertices = 0;
    size_t corners = 0;  ///< three a triangle
    size_t attribute_floats = 0;
};

/// The limit of 32-bit numbers that such arrays break ("E-LIMIT-VERTICES"); nullptr: none.
const char* broken_limit(const ArraySizes& sizes);

/// Adds a part behind the scene's arrays as a Primitive; material and node are the caller's.
///
/// Errors  77 E-LIMIT-*
Result<Primitive> append_part(Scene& scene, const MeshPart& part, const std::string& where);

}  // namespace obscura
