// scene/scene_memory.cpp - how many bytes the tables of a scene take.
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_memory.h"

#include <set>

namespace obscura {

size_t vertex_bytes(const Scene& scene) {
    return scene.positions.size() * sizeof(float) + scene.attributes.size() * sizeof(float) +
           scene.indices.size() * sizeof(uint32_t) +
           (scene.motion.positions.size() + scene.motion.normals.size()) * sizeof(float);
}

size_t geometry_bytes(const Scene& scene) {
    return vertex_bytes(scene) + scene.primitives.size() * sizeof(Primitive) +
           scene.shapes.size() * sizeof(ShapeRecord) + scene.spheres.size() * sizeof(float) +
           scene.curve_points.size() * sizeof(float) +
           scene.curve_segments.size() * sizeof(uint32_t) +
           scene.instances.size() * sizeof(Instance) + scene.materials.size() * sizeof(Material) +
           scene.layers.size() * sizeof(MaterialLayers) + scene.media.size() * sizeof(Medium) +
           splat_bytes(scene.splats);
}

size_t texture_bytes(const Scene& scene) {
    return texels_of(scene.textures).size_bytes();
}

size_t base_texel_bytes(const Scene& scene) {
    size_t texels = 0;
    std::set<int32_t> seen;  // textures that differ only in their sampler share their texels
    for (const TextureRecord& record : scene.textures.records) {
        if (!seen.insert(record.level_offset[0]).second) continue;
        const size_t planes = record.low_plane != 0 ? 2 : 1;
        texels += planes * static_cast<size_t>(record.width) * static_cast<size_t>(record.height);
    }
    return texels * sizeof(uint32_t);
}

size_t stored_triangles(const Scene& scene) {
    return scene.indices.size() / 3;
}

}  // namespace obscura
