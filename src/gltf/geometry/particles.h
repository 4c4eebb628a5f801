// gltf/geometry/particles.h - accessors of positions and radii become blocks of spheres.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/accessors.h"
#include "scene/scene.h"

namespace obscura::gltf {

/// Keeps the order of spheres from pose to pose: equal positions are sorted once.
class SphereOrders {
public:
    /// Forgets orders that were not asked for since the last call.
    void begin_pose();

    /// An order in which neighbouring spheres share blocks.
    ///
    /// In   positions: 3 numbers a sphere
    const std::vector<uint32_t>& order_of(const std::vector<float>& positions);

private:
    struct Entry {
        std::vector<float> positions;
        std::vector<uint32_t> order;
    };
    std::vector<Entry> known_, asked_;
};

struct ParticleSources {
    const Document& document;
    const BufferStore& buffers;
    SphereOrders* orders = nullptr;  ///< of an animated asset; null: there is one pose alone
};

/// Spheres as a primitive counts them; `first` is the first of a block.
struct ParticleRange {
    int32_t first = 0;
    int32_t count = 0;
    std::vector<uint32_t> order = {};  ///< index in the input of each sphere
};

inline constexpr size_t max_spheres = size_t{1} << 29;  ///< so that 31 bits index every float

/// Appends spheres to Scene::spheres in an order in which blocks are small boxes.
///
/// In      positions: 3 numbers a sphere; radii: one for all, or one a sphere
/// In/Out  orders: see ParticleSources
ParticleRange append_spheres(const std::vector<float>& positions,
                             const std::vector<float>& radii,
                             Scene& scene,
                             SphereOrders* orders = nullptr);

/// Appends a "spheres" shape.
///
/// In      shape_index: for messages
/// Errors  as add_shapes
Result<ParticleRange> append_particles(const ParticleSources& sources,
                                       const GltfShape& shape,
                                       int shape_index,
                                       Scene& scene);

/// The box around a primitive of shapes or particles, in its own space.
ShapeBox primitive_box(const Scene& scene, const Primitive& primitive);

}  // namespace obscura::gltf
