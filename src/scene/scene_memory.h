// scene/scene_memory.h - how many bytes the tables of a scene take.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstddef>

namespace obscura {

/// Vertices, attributes and indices: the minimum for any renderer of the same triangles.
size_t vertex_bytes(const Scene& scene);

/// All tables but the texels: vertices, shapes, primitives, instances, materials.
size_t geometry_bytes(const Scene& scene);

/// Texels with their mip chains.
size_t texture_bytes(const Scene& scene);

/// Texels of the images alone, without mip chains.
size_t base_texel_bytes(const Scene& scene);

/// Triangles as they are stored: those of an instanced mesh count once.
size_t stored_triangles(const Scene& scene);

}  // namespace obscura
