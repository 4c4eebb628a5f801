// gltf/geometry/batch_reader.h - appends the primitives of a batch to the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/geometry_store.h"
#include "gltf/geometry/mesh_plan.h"
#include "gltf/geometry/meshes.h"
#include "gltf/parse/list_text.h"

#include <map>
#include <vector>

namespace obscura::gltf {

/// Inputs of reading a batch beside MeshSources.
struct BatchSources {
    const MeshSources& meshes;
    const std::vector<std::vector<Affined>>& skins;  ///< matrices; empty: no drawn mesh uses it
    const std::vector<Affined>& group_from_node;
};

/// Reads batches, chooses their materials and collects their oddities.
class BatchReader {
public:
    BatchReader(const BatchSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log)
        : sources_(sources), materials_(materials), problems_(problems), scene_(scene), log_(log) {}

    /// Errors  77 E-LIMIT-*
    Result<GeometryBatch> read(const MeshBatch& batch);

    /// True when read() would give the same batch as an earlier pose did.
    bool is_same(const GeometryBatch& kept, const MeshBatch& batch) const;

    /// Chooses the materials again and reports the oddities again.
    void use_again(GeometryBatch& kept);

    /// Names of meshes by oddity.
    const std::map<MeshIssue, NameList>& issues() const { return issues_; }

private:
    const Document& document() const { return sources_.meshes.document; }
    const PlacedNode& placed(int index) const {
        return sources_.meshes.placed[static_cast<size_t>(index)];
    }
    const GltfPrimitive& gltf_primitive(const PrimitiveName& name) const {
        return document()
            .meshes[static_cast<size_t>(name.mesh)]
            .primitives[static_cast<size_t>(name.primitive)];
    }
    int node_of(const PrimitiveTask& task) const {
        return task.placed < 0 ? -1 : placed(task.placed).node;
    }
    std::string place(const PrimitiveName& name) const;
    Affined batch_from_mesh(BatchSpace space, const PlacedNode& from) const;
    size_t chunk_end(const std::vector<PrimitiveTask>& tasks, size_t begin) const;
    Result<MeshPrimitive> read_task(BatchSpace space, const PrimitiveTask& task) const;
    Result<void> append(const PrimitiveTask& task, MeshPrimitive& primitive, GeometryBatch& to);
    void use_material(const PrimitiveName& name);
    int choose_material(const PrimitiveNote& note);
    void note_issues(const PrimitiveNote& note);
    void note_faults(const MeshPrimitive& primitive);

    const BatchSources& sources_;
    MaterialTable& materials_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    std::map<MeshIssue, NameList> issues_;
};

}  // namespace obscura::gltf
