// bench/standard_mesh.h - builds the geometry of the standard's scenes, surface by surface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace obscura::bench {

/// Numbers in [0, 1) that are the same on every machine: a hash of what they are for.
float standard_random(uint32_t index, uint32_t purpose);

/// The unit vector of a place on a ball: u around it, v from the upper pole to the lower one, where
/// all u give the same bits.
Vec3f ball_direction(float u, float v);

/// A point of a parametric surface, and where a texture lies on it.
struct SurfacePoint {
    Vec3f position, normal;
};

/// Fills a scene: first what lies in the world, then meshes and where they stand.
class StandardMesh {
public:
    /// Returns the index of the material.
    int32_t add(const Material& material);
    /// The same with layers.
    int32_t add(Material material, const MaterialLayers& layers);
    /// A square image of so many pixels a side, with its mip chain; returns the texture's index.
    ///
    /// In      texel(u, v): R in the lowest byte
    int32_t add_texture(int side, bool srgb, const std::function<uint32_t(float, float)>& texel);

    /// A surface over [0, 1]^2 of columns x rows quads, with normals, tangents and texture
    /// coordinates; its front is where the normals point.
    void surface(int columns,
                 int rows,
                 int32_t material,
                 const std::function<SurfacePoint(float, float)>& at);
    /// A parallelogram p, p + a, p + a + b, p + b whose front is cross(a, b).
    void quad(const Vec3f& p, const Vec3f& a, const Vec3f& b, int32_t material);
    void sphere(const Vec3f& centre, float radius, int rings, int32_t material);
    /// Six quads that face outwards.
    void box(const Vec3f& low, const Vec3f& high, int32_t material);

    /// What is added from here on belongs to a mesh, which instances show; nothing in the world may
    /// follow. Returns the mesh's index.
    int32_t begin_mesh();
    void instance(int32_t mesh, const Affinef& world_from_object);

    /// The finished scene.
    Scene take();
    Scene& scene() { return scene_; }

private:
    void count_primitives();
    /// Returns the normals.
    std::vector<float> add_vertices(int columns,
                                    int rows,
                                    const std::function<SurfacePoint(float, float)>& at,
                                    Primitive& primitive);

    Scene scene_;
};

}  // namespace obscura::bench
