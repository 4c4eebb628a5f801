// session/framed_geometry.h - the points that a view is to show, found fast along any direction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace obscura {

/// The vertices of a scene as it is posed, with every instance, and the surfaces of its round
/// things. Boxes around runs of triangles spare most of them in a search, so that one costs little
/// beside loading. Shapes other than spheres count by their boxes, splats by that of their group.
class FramedGeometry {
public:
    /// In      scene: outlives this object; nodes: 1 for each glTF node that counts; empty: all do
    explicit FramedGeometry(const Scene& scene, const std::vector<char>& nodes = {});

    /// The corners of a box; of an empty one none.
    explicit FramedGeometry(const Bounds& box);

    bool empty() const { return items_.empty() && corners_.empty(); }

    /// The scene has been moved to another place in memory.
    void follow(const Scene& scene) { scene_ = &scene; }

    /// The point that lies farthest along a direction; the origin where there is none.
    Vec3d farthest(const Vec3d& direction) const;

    /// Distance to the farthest point.
    double farthest_from(const Vec3d& centre) const;

    /// The box along the world's axes.
    const Bounds& box() const { return box_; }

private:
    /// Some triangles, shapes, spheres or segments of a primitive, with their box.
    struct Chunk {
        size_t primitive;
        int32_t first;
        int32_t count;
        std::array<Vec3f, 2> box;
    };
    struct Range {
        size_t first = 0;
        size_t count = 0;
    };
    /// A primitive in the world, or one of its instances.
    struct Item {
        Range chunks;
        std::array<Vec3f, 2> box;          ///< in its own space
        const Affinef* world_from_object;  ///< null: its space is the world
    };

    void add_chunks(size_t primitive);
    void add_item(size_t primitive, const Affinef* world_from_object);
    void add_corners(const Vec3f& low, const Vec3f& high);
    template <typename Visit>
    void each_point(const Chunk& chunk, const Visit& visit) const;
    template <typename Search>
    void run(Search& search) const;
    template <typename Search>
    void look_into(const Chunk& chunk, Search& search) const;
    Bounds find_box() const;

    const Scene* scene_ = nullptr;
    std::vector<Chunk> chunks_;
    std::vector<Range> chunks_of_primitive_;
    std::vector<Item> items_;
    std::vector<Vec3d> corners_;  ///< single points in the world
    Bounds box_;
};

/// The geometry of one pose for all views of it, made when the first one needs it.
class KeptGeometry {
public:
    /// In      scene: the pose, wherever it is now; nodes: as for FramedGeometry
    /// Out     valid until the next call
    const FramedGeometry& of(const Scene& scene, const std::vector<char>& nodes);

    /// Another pose follows.
    void forget() { geometry_.reset(); }

private:
    std::vector<char> nodes_;
    std::optional<FramedGeometry> geometry_;
};

/// A scene as it is posed, with what views of it have in common.
struct FramedScene {
    FramedScene(const Scene& posed, KeptGeometry* views = nullptr) : scene(posed), kept(views) {}

    const Scene& scene;
    KeptGeometry* kept;  ///< null: this is the only view
};

}  // namespace obscura
