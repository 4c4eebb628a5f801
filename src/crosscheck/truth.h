// crosscheck/truth.h - the nearest hit of a ray in double precision, without Embree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "crosscheck/crossings.h"
#include "scene/scene.h"
#include "shape/segment.h"

#include <functional>
#include <optional>
#include <vector>

namespace obscura::crosscheck {

inline constexpr double ulp_of_one = 1.0 / 8388608.0;  ///< spacing of floats above 1

/// How far from an edge answers may differ, and how far hits may lie from the surface; units of
/// TrueScene::rounding_m.
inline constexpr double edge_ulps = 4;
inline constexpr double depth_ulps = 4;
/// Absolute values: bounds what passes through the matrix.
Affined absolute(const Affined& a);

/// A triangle or shape of the scene, identified as in HitColumns.
struct Item {
    int32_t instance = -1;
    int32_t primitive = -1;  ///< -1: none
    int32_t element = -1;    ///< triangle or shape within the primitive

    bool operator==(const Item&) const = default;
};

struct TrueHit {
    double t = INFINITY;
    Item item;

    bool found() const { return item.primitive >= 0; }
};

/// A scene for searches in double: all single precision numbers of the scene (corners, shapes,
/// matrices) are taken as exact. Alpha is ignored, and every surface is double-sided.
class TrueScene {
public:
    /// In   scene: outlives this object; slack_m: distance from it, beyond rounding, at which the
    ///      other side of a comparison may lie
    explicit TrueScene(const Scene& scene, double slack_m = 0);

    /// The nearest hit with t > 0, up to the ray's end.
    TrueHit nearest(const TrueRay& ray) const;

    /// The same without boxes: every triangle and every shape is tested.
    TrueHit nearest_of_all(const TrueRay& ray) const;

    /// Calls take(t, item) for every hit of the ray, in no order.
    void all_hits(const TrueRay& ray, const std::function<void(double, Item)>& take) const;

    /// Calls take(item) for every finite item whose box the ray passes within room_m, and possibly
    /// for more, in no order.
    void near_items(const TrueRay& ray,
                    double room_m,
                    const std::function<void(const Item&)>& take) const;

    /// Hits of the ray's line with this item, hidden or not: none, one or two.
    std::vector<double> meetings(const TrueRay& ray, const Item& item) const;

    /// How far rounding in single precision moves the point at t: one unit in the last place of the
    /// largest number on the way to it, into the object's space and back, corners included; with
    /// slack, twice that and at least the slack. Metres.
    double rounding_m(const TrueRay& ray, const Item& item, double t) const;

    /// Centre of the item's box in the world; of an infinite plane any point on it.
    Vec3d middle(const Item& item) const;

    /// Unit normal of the item near a point, in the world.
    Vec3d normal(const Item& item, const Vec3d& place) const;

    /// Whether there is such an item.
    bool has(const Item& item) const;

    /// Items in the world; each instance's count.
    size_t item_count() const { return item_ends_.empty() ? 0 : item_ends_.back(); }
    Item item(size_t number) const;

    /// Corners of a mesh's item, in the world.
    Triangle<double> triangle(const Item& item) const;
    bool is_triangle(const Item& item) const;
    /// The shape of an item that is no triangle, in its own space; of a line segment the capsule.
    ShapeRecord shape(const Item& item) const;
    Affined world_from_object(const Item& item) const;
    Affined object_from_world(const Item& item) const;
    bool is_infinite(const Item& item) const;
    /// A line segment with Embree's numbers, even where one sphere holds the other.
    bool is_segment(const Item& item) const;
    Segment<double> segment(const Item& item) const;
    /// Metres from a segment's surface, negative inside.
    double side_of_segment(const Item& item, const Vec3d& place) const;
    /// The previous (-1) or next (1) segment of the same line.
    std::optional<Item> next_segment(const Item& item, int32_t step) const;

    /// Box of all finite items.
    TrueBox bounds() const { return objects_tree_->bounds(); }
    const Scene& scene() const { return scene_; }

private:
    /// Primitives that share a space: those of the world, or one mesh.
    struct Group {
        std::vector<Item> items;               ///< instance -1
        std::vector<Triangle<float>> corners;  ///< of each item that is a triangle
        std::vector<Item> infinite;
        std::optional<BoxTree> tree;
    };
    struct Object {
        size_t group;
        int32_t instance;  ///< -1: the world itself
        Affined world_from_object, object_from_world;
    };

    Group make_group(int32_t first_primitive, int32_t count) const;
    void add_object(size_t group, int32_t instance);
    const Object& object_of(const Item& item) const;
    Triangle<double> own_triangle(const Item& item) const;
    /// Index of the first of a line segment's two points.
    int64_t curve_point(const Item& item) const;
    SegmentFrame<double> curve_frame(const Item& item) const;
    /// Crossings of a line segment, without those inside its neighbours: a line is one solid.
    Crossings cross_segment(const Item& item, const TrueRay& ray) const;
    TrueBox box_of(const Item& item) const;
    /// Crossings of one item in its own space, wherever the ray begins and ends.
    Crossings crossings(const Item& item, const TrueRay& ray) const;
    /// Item k of a group; its corners lie beside it.
    Crossings crossings(const Group& group, size_t k, const TrueRay& ray) const;
    template <typename Take>
    void visit_hits(const TrueRay& ray, const double& limit, const Take& take) const;

    const Scene& scene_;
    double slack_m_;
    std::vector<Group> groups_;
    std::vector<Object> objects_;    ///< instance i is objects_[i + 1]
    std::vector<size_t> item_ends_;  ///< by object
    std::optional<BoxTree> objects_tree_;
    std::vector<size_t> boxed_objects_;  ///< those in the hierarchy
    std::vector<size_t> infinite_objects_;
};

}  // namespace obscura::crosscheck
