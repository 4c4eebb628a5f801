// gltf/geometry/block_reader.h - reads the primitives of a block behind the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/geometry_store.h"
#include "gltf/geometry/mesh_plan.h"
#include "gltf/geometry/meshes.h"
#include "gltf/parse/list_text.h"

#include <map>
#include <vector>

namespace obscura {

/// What blocks are read with, besides what meshes are read from.
struct BlockSources {
    const MeshSources& meshes;
    const std::vector<std::vector<Affined>>& skins;  ///< matrices; empty: no mesh drawn has it
    const std::vector<Affined>& mover_from_node;
};

/// Reads blocks, chooses their materials and collects what is odd about them.
class BlockReader {
public:
    BlockReader(const BlockSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log)
        : sources_(sources), materials_(materials), problems_(problems), scene_(scene), log_(log) {}

    /// Errors  77 E-LIMIT-*
    Result<GeometryBlock> read(const MeshBlock& block);

    /// True when a block that an earlier pose has read is what read() would give.
    bool is_same(const GeometryBlock& kept, const MeshBlock& block) const;

    /// Chooses the materials again and tells again what is odd.
    void use_again(GeometryBlock& kept);

    /// Names of meshes by what is odd about them.
    const std::map<MeshIssue, NameList>& issues() const { return issues_; }

private:
    const Document& document() const { return sources_.meshes.document; }
    const PlacedNode& placed(int index) const {
        return sources_.meshes.placed[static_cast<size_t>(index)];
    }
    const GltfPrimitive& primitive(const PartName& name) const {
        return document()
            .meshes[static_cast<size_t>(name.mesh)]
            .primitives[static_cast<size_t>(name.primitive)];
    }
    int node_of(const PartJob& job) const { return job.placed < 0 ? -1 : placed(job.placed).node; }
    std::string place(const PartName& name) const;
    Affined block_from_mesh(BlockSpace space, const PlacedNode& from) const;
    size_t batch_end(const std::vector<PartJob>& jobs, size_t begin) const;
    Result<MeshPart> read_job(BlockSpace space, const PartJob& job) const;
    Result<void> append(const PartJob& job, MeshPart& part, GeometryBlock& to);
    void use_material(const PartName& name);
    int choose_material(const PartNote& note);
    void note_issues(const PartNote& note);
    void note_faults(const MeshPart& part);

    const BlockSources& sources_;
    MaterialTable& materials_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    std::map<MeshIssue, NameList> issues_;
};

}  // namespace obscura
